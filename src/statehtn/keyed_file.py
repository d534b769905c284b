"""Files of tables with keys, in TOML or JSON, and complaints that name the file and the key."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NoReturn

from statehtn.errors import InputError
from statehtn.limits import Limits
from statehtn.read_file import read_whole


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
        tables = json.loads(text) if kind == "JSON" else tomllib.loads(text)
    except UnicodeDecodeError as error:
        raise InputError(f"{file}: this is no {kind}: byte {error.start} is not UTF-8") from None
    except ValueError as error:  # of either reader, or a number with thousands of digits
        raise InputError(f"{file}: this is no {kind}: {error}") from None
    except RecursionError:
        raise InputError(f"{file}: this is nested too deeply") from None
    if not isinstance(tables, dict):
        raise InputError(f"{file}: expected an object with keys, found {_shown(tables):.50}")
    return tables


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
