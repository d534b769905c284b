"""Why something cannot be done: a tree whose leaves are the roots of the matter."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field

from statehtn.model.formula import Fact

SEEN = "see above"
VALUES = "values"
"""The kind of a reason that only says with which objects a condition can be had."""


@dataclass(frozen=True, slots=True)
class Addition:
    """What could be added to a problem: a fact to the initial state, or an object of a type.

    Args:
        fact: the fact; None for an object.
        type: of the object; None for a fact.
    """

    fact: Fact | None = None
    type: str | None = None

    def __str__(self) -> str:
        if self.fact is not None:
            return f"({' '.join(self.fact)})"
        return f"an object '{self.new_name}' of type '{self.type}'"

    @property
    def new_name(self) -> str:
        """What the object is called: a name that is no other's, as it has a space."""
        return f"new {self.type}"


@dataclass(frozen=True, slots=True)
class Reason:
    """Something that cannot be done or be true, and why.

    Args:
        what: the task, method, action or condition.
        why: in a few words.
        children: the reasons of that, each of which is enough where `any_of` is false.
        additions: what would do away with this reason alone; any of them.
        kind: "task", "method", "action", "fact", "condition" or `VALUES`.
        name: of the task, method, action or predicate.
    """

    what: str
    why: str
    children: tuple[Reason, ...] = ()
    additions: tuple[Addition, ...] = field(default=(), repr=False)
    kind: str = "condition"
    name: str = ""

    def roots(self) -> Iterator[Reason]:
        """Yield the reasons that have no further ones, in their order, without repetitions of what stands above."""
        if all(child.kind == VALUES for child in self.children) and self.why != SEEN:
            yield self
            return
        for child in self.children:
            if child.kind != VALUES:
                yield from child.roots()

    def walk(self) -> Iterator[Reason]:
        """Yield this reason and all below it."""
        yield self
        for child in self.children:
            yield from child.walk()

    def to_dict(self) -> dict[str, object]:
        """Return the tree as JSON has it."""
        return {
            "what": self.what,
            "why": self.why,
            "kind": self.kind,
            "name": self.name,
            "because": [child.to_dict() for child in self.children],
        }

    def __str__(self) -> str:
        return f"{self.what}: {self.why}"
