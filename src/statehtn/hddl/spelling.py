"""How names are written: their characters, and their case, which a declaration fixes and which does not matter."""

from __future__ import annotations

import re
from collections.abc import Iterable

UNSEEN = "\0-\x08\x0e-\x1b\x7f-\x84\x86-\x9f\xad\u200b-\u200f\u202a-\u202e\u2060-\u206f\ufeff\ud800-\udfff"
"""Characters that are not seen, and are no spaces, as a class of regular expressions."""
ODD = re.compile(r"[\"'`{}\[\]\\]")
"""Characters that the reader takes as a part of names, with a warning, and no other program does."""
NOT_IN_NAMES = re.compile(rf"[\s();,?{ODD.pattern[1:-1]}{UNSEEN}]+")


def is_name(text: str) -> bool:
    """Tell whether a text can name anything in HDDL, but for words of the language."""
    return bool(text) and NOT_IN_NAMES.search(text) is None and text[0] not in ":-" and text[-1] != "-"


class Spellings:
    """Names of one kind as their declarations spell them, found in any case.

    Two names that differ in case only are one name, which is spelt as the first of them.
    """

    __slots__ = ("_declared",)

    def __init__(self, names: Iterable[str] = ()) -> None:
        self._declared: dict[str, str] = {}
        self.add(names)

    def add(self, names: Iterable[str]) -> None:
        """Add names; those that are known stay as they are spelt."""
        for name in names:
            self._declared.setdefault(name.lower(), name)

    def find(self, name: str) -> str | None:
        """Return the declared spelling of a name; None if there is no such name."""
        return self._declared.get(name.lower())

    def has_none_of(self, names: Iterable[str]) -> bool:
        """Tell whether none of the names is known."""
        return self._declared.keys().isdisjoint(map(str.lower, names))
