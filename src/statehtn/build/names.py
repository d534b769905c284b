"""Names that HDDL can write and read again."""

from __future__ import annotations

from collections import UserDict
from collections.abc import Iterable, Mapping
from typing import Any, TypeVar

from statehtn.errors import UsageError
from statehtn.hddl.diagnostics import unknown
from statehtn.hddl.spelling import Spellings, is_name
from statehtn.hddl.vocabulary import RESERVED

WORDS = RESERVED | {"=", "<", ">", "<=", ">=", "+", "-", "*", "/", "either", "when", "increase", "probabilistic"}
"""Words with a meaning of their own wherever a predicate, a function or a task could stand."""


T = TypeVar("T")


class Named(UserDict[str, T]):
    """Things by name, as they are spelt; names can be looked for in any case."""

    def __init__(self, things: Mapping[str, T] | None = None) -> None:
        self._spellings = Spellings()
        super().__init__(things or {})

    def __setitem__(self, name: str, thing: T) -> None:
        super().__setitem__(name, thing)
        self._spellings.add((name,))

    def spelling(self, name: str) -> str | None:
        """Return the spelling of a name, given in any case; None if there is no such name."""
        return self._spellings.find(name)


def new_name(name: object, kind: str, *taken: tuple[str, Named[Any]]) -> str:
    """Return a name that is new.

    Args:
        kind: what it names, for messages.
        taken: pairs of a kind and the things of that kind, from whose names it must differ by more than case, which
            HDDL does not distinguish.

    Raises:
        UsageError: it is no name, a word of HDDL, or taken.
    """
    article = _article(kind)
    if not isinstance(name, str):
        raise UsageError(f"the name of {article} {kind} must be a string, found {name!r}")
    if not is_name(name) or name.lower() in WORDS:
        raise UsageError(
            f"'{name}' cannot name {article} {kind}: a name has no spaces, parentheses, brackets, quotes and none of "
            f"; , ? \\, does not begin with ':' or '-' nor end with '-', and is no word of HDDL such as 'and'"
        )
    for what, things in taken:
        other = things.spelling(name)
        if other is not None:
            case = "" if other == name else f", and '{name}' differs in case only, which means nothing in HDDL"
            raise UsageError(f"there is {_article(what)} {what} '{other}' already{case}")
    return name


def _article(word: str) -> str:
    return "an" if word[0] in "aeiou" else "a"


def not_declared(kind: str, name: str, known: Iterable[str]) -> UsageError:
    """Return the error that a name is unknown, with the most similar one that is known."""
    return UsageError(unknown(kind, name, known))
