"""Arguments of public functions that are of another kind than was expected: what to write instead."""

from __future__ import annotations

import os
import reprlib
from collections.abc import Callable, Collection, Iterable
from decimal import Decimal
from fractions import Fraction
from numbers import Integral, Real
from typing import Any, SupportsIndex, cast

from statehtn.errors import UsageError

MOST_CHARACTERS = 60


def expect(value: object, kind: type[Any], what: str, write: str = "") -> Any:
    """Return an argument that is an instance of a class.

    Args:
        what: what it is for, and what is expected, such as "the plan must be a Plan".
        write: how to come by one.

    Raises:
        UsageError: it is something else.
    """
    if isinstance(value, kind):
        return value
    raise UsageError(f"{what}, found {shown(value)}{f'; {write}' if write else ''}")


def number(value: object, what: str) -> float:
    """Return an argument that is a number; no text, and no truth value.

    Raises:
        UsageError: it is none, or too large for a float.
    """
    if isinstance(value, Real | Decimal) and not isinstance(value, bool):
        try:
            return float(value)
        except (OverflowError, ValueError):
            raise UsageError(f"{what} is too large, found {shown(value)}") from None
    raise UsageError(f"{what} must be a number, found {shown(value)}")


def whole_number(value: object, what: str) -> int:
    """Return an argument that is a whole number.

    Raises:
        UsageError: it is none.
    """
    if isinstance(value, Integral) and not isinstance(value, bool):
        return int(cast("SupportsIndex", value))
    raise UsageError(f"{what} must be a whole number, found {shown(value)}")


def items(value: object, what: str) -> list[Any]:
    """Return what an argument lists; a text is no list of its letters.

    Raises:
        UsageError: it lists nothing.
    """
    return list(each_of(value, what))


def each_of(value: object, what: str) -> Iterable[Any]:
    """Return an argument that lists something, or gives one thing after the other; as `items`, but not yet a list.

    Raises:
        UsageError: it lists nothing.
    """
    if isinstance(value, Iterable) and not isinstance(value, str | bytes):
        return value
    raise UsageError(f"{what} must be a list, found {shown(value)}")


def one_of(value: object, known: Collection[str], what: str) -> str:
    """Return an argument that is one of some names.

    Raises:
        UsageError: it is none of them; names the most similar one.
    """
    if isinstance(value, str) and value in known:
        return str(value)
    there_are = f"there are {', '.join(known)}"
    if not isinstance(value, str):
        raise UsageError(f"{what} must be a name, found {shown(value)}; {there_are}")
    raise UsageError(f"unknown {what} '{value}'{did_you_mean(value, known)}; {there_are}")


def function(value: Callable[..., Any] | None, what: str) -> None:
    """Check an argument that is called, or None.

    Raises:
        UsageError: it cannot be called.
    """
    if value is not None and not callable(value):
        raise UsageError(f"{what} must be a function, found {shown(value)}")


def did_you_mean(name: str, known: Iterable[str]) -> str:
    """Return a question after the most similar of some names, in whatever case; nothing if none is similar."""
    import difflib  # only for errors: it takes 5 ms

    in_lower_case = {one.lower(): one for one in known}
    close = difflib.get_close_matches(name.lower(), in_lower_case, n=1)
    return f" (did you mean '{in_lower_case[close[0]]}'?)" if close else ""


def shown(value: object) -> str:
    """Return what kind of thing a value is, and, in short, which."""
    if value is None:
        return "None"
    kind = type(value)
    try:
        text = reprlib.repr(value)
    except Exception:  # it cannot show itself
        text = "..."
    if len(text) > MOST_CHARACTERS:
        text = f"{text[: MOST_CHARACTERS - 3]}..."
    return f"{text} ({kind.__name__})"


def shown_number(value: Fraction | float) -> str:
    """Return a number of the input as people write it; in words where it is too large for that."""
    try:
        return f"{float(value):.12g}"
    except OverflowError:
        return "a number of more than 308 digits"


def file_name(value: object, what: str) -> str:
    """Return an argument that names a file.

    Raises:
        UsageError: it is none.
    """
    if isinstance(value, str | bytes | os.PathLike):
        return os.fsdecode(value)
    raise UsageError(f"{what} must be the name of a file, found {shown(value)}")
