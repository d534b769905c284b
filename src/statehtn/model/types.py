"""Types, typed parameters and the type hierarchy."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field

ROOT_TYPE = "object"


@dataclass(frozen=True, slots=True)
class Parameter:
    """A typed variable: its name with the question mark, and its type.

    Several types mean `either`: an object of any of them is allowed.
    """

    name: str
    types: tuple[str, ...] = (ROOT_TYPE,)

    def __str__(self) -> str:
        kind = self.types[0] if len(self.types) == 1 else f"(either {' '.join(self.types)})"
        return f"{self.name} - {kind}"


@dataclass(frozen=True)
class TypeHierarchy:
    """Types and their direct supertypes; `object` is above them all.

    A type may have several supertypes (`either`, or a type that is declared twice).
    """

    parents: Mapping[str, tuple[str, ...]] = field(default_factory=dict)

    def __contains__(self, name: object) -> bool:
        return name == ROOT_TYPE or name in self.parents

    def supertypes(self, name: str) -> frozenset[str]:
        """Return the type itself and everything above it."""
        found = {name, ROOT_TYPE}
        pending = [name]
        while pending:
            for parent in self.parents.get(pending.pop(), ()):
                if parent not in found:
                    found.add(parent)
                    pending.append(parent)
        return frozenset(found)

    def subtypes(self, names: Iterable[str]) -> frozenset[str]:
        """Return the types and everything below them, in time linear in the number of all types."""
        wanted = set(names)
        if ROOT_TYPE in wanted:
            return frozenset((ROOT_TYPE, *self.parents))
        below: dict[str, list[str]] = {}
        for name, above in self.parents.items():
            for parent in above:
                below.setdefault(parent, []).append(name)
        pending = list(wanted)
        while pending:
            for name in below.get(pending.pop(), ()):
                if name not in wanted:
                    wanted.add(name)
                    pending.append(name)
        return frozenset(wanted)

    def is_subtype(self, name: str, of: Iterable[str]) -> bool:
        """Tell whether the type is one of the given types or below one of them."""
        return not self.supertypes(name).isdisjoint(of)
