"""Plans with their decompositions; independent of how they were found."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from statehtn.model.decomposition_tree import DecompositionTree


@dataclass(frozen=True, slots=True)
class Step:
    """A ground primitive task in a plan."""

    action: str
    arguments: tuple[str, ...] = ()

    def __str__(self) -> str:
        return f"({' '.join((self.action, *self.arguments))})"


@dataclass(frozen=True, slots=True)
class Decomposition:
    """A ground compound task, the method that decomposed it, and what became of the method's subtasks.

    `children` has one entry for each subtask of the method, in the method's own order: the index of the step in the
    plan for a primitive task, a `Decomposition` for a compound one. `arguments` are the task's. `bindings` are the
    method's arguments (one object per method parameter) where they are known; a plan read from a file does not tell.
    """

    task: str
    arguments: tuple[str, ...]
    method: str
    children: tuple[int | Decomposition, ...] = ()
    bindings: tuple[str, ...] | None = None

    def walk(self) -> Iterator[Decomposition]:
        """Yield this node and all compound nodes below it, parents first."""
        pending = [self]
        while pending:
            node = pending.pop()
            yield node
            pending.extend(child for child in reversed(node.children) if isinstance(child, Decomposition))


@dataclass(frozen=True, slots=True)
class Plan:
    """A sequence of actions and the decomposition of the initial network that it comes from.

    `roots` has one entry for each task of the initial network, in its order, as in `Decomposition.children`.
    `root_bindings` binds the initial network's parameters (empty where there are none, None where unknown).
    """

    steps: tuple[Step, ...] = ()
    roots: tuple[int | Decomposition, ...] = ()
    root_bindings: tuple[str, ...] | None = ()

    @property
    def decomposition(self) -> DecompositionTree:
        """The decomposition as a tree to print, to show in a notebook and to draw."""
        from statehtn.model.decomposition_tree import DecompositionTree  # which knows plans

        return DecompositionTree(self)

    def decompositions(self) -> Iterator[Decomposition]:
        """Yield all compound nodes, parents first."""
        for root in self.roots:
            if isinstance(root, Decomposition):
                yield from root.walk()
