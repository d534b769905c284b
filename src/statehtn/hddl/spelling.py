"""Names without regard to case: whatever case a name is used in, its declaration says how it is written."""

from __future__ import annotations

from collections.abc import Iterable


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
