"""What is due of an action in a state: effects and parts of its cost, for all objects under which a condition holds."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from statehtn.model.cost.blocks import CostBlock
from statehtn.model.problem import Effect, Fact
from statehtn.semantics.condition import Condition
from statehtn.semantics.formulas import Bindings
from statehtn.semantics.history import State
from statehtn.semantics.world import substitute

DueParts = tuple[tuple[int, tuple[str, ...]], ...]
"""Parts of a cost that are due: (index of the block in `Action.all_costs`, objects of its variables)."""


def due_parts(
    costs: Iterable[tuple[int, CostBlock, Condition]], bindings: Bindings, state: State, front: tuple[str, ...] = ()
) -> DueParts:
    """Return the parts of a cost that are due in a state.

    Args:
        costs: blocks with their indices and their conditions, compiled.
        bindings: of the variables around them.
        state: before the action.
        front: objects of variables around the blocks that belong to them.
    """
    return tuple(
        (index, (*front, *objects))
        for index, block, condition in costs
        for objects in sorted(
            tuple(extended[parameter.name] for parameter in block.parameters)
            for extended in condition.solutions(block.parameters, bindings, state)
        )
    )


def changes_of(
    effects: Sequence[tuple[Effect, Condition]], bindings: Bindings, state: State
) -> tuple[frozenset[Fact], frozenset[Fact]]:
    """Return the facts that effects make true and false; conditions are those of the state before."""
    added: set[Fact] = set()
    deleted: set[Fact] = set()
    for effect, condition in effects:
        changed = added if effect.positive else deleted
        for extended in condition.solutions(effect.parameters, bindings, state):
            changed.add((effect.atom.predicate, *substitute(effect.atom.arguments, extended)))
    return frozenset(added), frozenset(deleted)
