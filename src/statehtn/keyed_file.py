"""Files of tables with keys, in TOML or JSON, and complaints that name the file and the key."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NoReturn, TypeVar

from statehtn.errors import InputError
from statehtn.limits import Limits
from statehtn.read_file import read_whole

N = TypeVar("N", int, float)

NUMBERS = 1024
"""Of a file that are read between two looks at the limits."""


def read_tables(file: Path, limits: Limits = Limits()) -> Mapping[str, Any]:
    """Read a TOML file, or a JSON file if its name ends in `.json`.

    Raises:
        InputError: the file cannot be read, is malformed, or is no table of keys.
        LimitReached: a limit was reached.
    """
    import json  # here, since few runs read such files
    import tomllib

    kind = "JSON" if file.suffix.lower() == ".json" else "TOML"
    data = read_whole(file, limits)
    try:
        text = data.decode("utf-8-sig" if kind == "JSON" else "utf-8")
        number = limited(float, limits)
        if kind == "JSON":
            tables = json.loads(text, parse_float=number, parse_int=limited(int, limits))
        else:
            tables = tomllib.loads(text, parse_float=number)
    except UnicodeDecodeError as error:
        raise InputError(f"{file}: this is no {kind}: byte {error.start} is not UTF-8") from None
    except ValueError as error:  # of either reader, or a number with thousands of digits
        raise InputError(f"{file}: this is no {kind}: {error}") from None
    except RecursionError:
        raise InputError(f"{file}: this is nested too deeply") from None
    if not isinstance(tables, dict):
        raise InputError(f"{file}: expected an object with keys, found {_shown(tables):.50}")
    return tables


def limited(read: Callable[[str], N], limits: Limits) -> Callable[[str], N]:
    """Return a function that reads a number, and looks at the limits now and then: no reader of files does."""
    count = 0

    def look_and_read(text: str) -> N:
        nonlocal count
        if count % NUMBERS == 0:
            limits.check()
        count += 1
        return read(text)

    return look_and_read


def _shown(value: object) -> str:
    """Return a value in the words of the files, which have `true` and `null` where Python has `True` and `None`."""
    import json

    return repr(value) if isinstance(value, str) else json.dumps(value, default=str)


@dataclass(frozen=True, slots=True)
class KeyedTable:
    """A table of a file, and where it is; its readers raise an `InputError` for what makes no sense."""

    place: str
    values: Mapping[str, Any]

    def complain(self, key: str, expected: str, found: object) -> NoReturn:
        """Raise the error that a key has a wrong value."""
        raise InputError(f"{self.place}: '{key}': expected {expected}, found {_shown(found)}")

    def check_keys(self, known: Iterable[str]) -> None:
        """Raise an error for the first key that is not known."""
        for key in self.values:
            if key not in known:
                raise InputError(f"{self.place}: unknown key '{key}'; there are {', '.join(known)}")

    def text(self, key: str, default: str | None = None) -> str:
        """Return a key's text, which is not empty."""
        value = self.values.get(key, default)
        if value is None:
            raise InputError(f"{self.place}: '{key}' is missing")
        if not isinstance(value, str) or not value:
            self.complain(key, "text", value)
        return value
