"""The ground problem as Python objects: what the reference implementation, graphs and tests read.

Facts, actions, compound tasks and methods are numbered from 0. A task is an `int`: action `a` is task `a`,
compound task `c` is task `len(actions) + c`. The order of facts inside sets carries no meaning.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property

from statehtn.model.cost.law import CostLaw
from statehtn.model.problem import Fact


@dataclass(frozen=True, slots=True)
class GroundEffect:
    """Facts that become true and false if the condition holds in the state before; adding wins over deleting."""

    added: frozenset[int]
    deleted: frozenset[int]
    condition: frozenset[int] = frozenset()
    negative_condition: frozenset[int] = frozenset()


@dataclass(frozen=True, slots=True)
class GroundCostPart:
    """A part of an action's cost that is due, once, if one of the alternatives holds in the state before the action.

    An alternative is facts that hold and facts that do not. Parts of an action's cost are independent.
    """

    alternatives: tuple[tuple[frozenset[int], frozenset[int]], ...]
    cost: CostLaw

    def is_due(self, state: frozenset[int]) -> bool:
        """Tell whether the part is due in a state."""
        return any(true <= state and false.isdisjoint(state) for true, false in self.alternatives)


@dataclass(frozen=True, slots=True)
class GroundAction:
    """A ground action. Those that stand for a method's precondition or the goal (`is_precondition`) cost 0.

    `cost` is what is due in every state; `cost_parts` come on top of it. An action whose precondition is a disjunction
    stands here several times, once for each case; a compound task of the same name then chooses between them. So does
    an action with several outcomes, once for each of them: nature chooses it with its `probability`, and the compound
    task is one of `GroundProblem.chance_tasks`.
    """

    name: str
    arguments: tuple[str, ...]
    precondition: frozenset[int]
    negative_precondition: frozenset[int]
    effects: tuple[GroundEffect, ...]
    cost: CostLaw
    is_precondition: bool = False
    cost_parts: tuple[GroundCostPart, ...] = ()
    probability: Fraction = Fraction(1)

    def is_applicable(self, state: frozenset[int]) -> bool:
        """Tell whether the action can be executed in a state."""
        return self.precondition <= state and self.negative_precondition.isdisjoint(state)

    def apply(self, state: frozenset[int]) -> frozenset[int]:
        """Return the state after the action."""
        added: set[int] = set()
        deleted: set[int] = set()
        for effect in self.effects:
            if effect.condition <= state and effect.negative_condition.isdisjoint(state):
                added |= effect.added
                deleted |= effect.deleted
        return (state - deleted) | added

    def costs_in(self, state: frozenset[int]) -> tuple[CostLaw, ...]:
        """Return the laws of the independent parts of the cost in a state before the action."""
        return (self.cost, *(part.cost for part in self.cost_parts if part.is_due(state)))


@dataclass(frozen=True, slots=True)
class GroundMethod:
    """A ground method: the compound task that it decomposes, its subtasks, and their order.

    `ordering` has pairs (i, j) of subtask indices, i before j.
    """

    name: str
    arguments: tuple[str, ...]
    task: int
    subtasks: tuple[int, ...]
    ordering: tuple[tuple[int, int], ...]


@dataclass(frozen=True)
class GroundProblem:
    """A ground cost-variable HTN problem with one initial task, whose only methods stand for the initial network.

    Where it is plain, every method is one of the domain's, or a case or an outcome of an action. Otherwise it may be a
    part of one, or several that were applied at once. `chance_tasks` are those whose method nature chooses; where the
    agent chooses it, this is the all-outcomes determinisation.
    """

    facts: tuple[Fact, ...]
    actions: tuple[GroundAction, ...]
    tasks: tuple[tuple[str, ...], ...]
    methods: tuple[GroundMethod, ...]
    initial_state: frozenset[int]
    initial_task: int
    is_plain: bool = True
    chance_tasks: frozenset[int] = frozenset()

    @cached_property
    def methods_of(self) -> dict[int, tuple[int, ...]]:
        """For every compound task the methods that decompose it."""
        found: dict[int, list[int]] = {len(self.actions) + c: [] for c in range(len(self.tasks))}
        for index, method in enumerate(self.methods):
            found[method.task].append(index)
        return {task: tuple(indices) for task, indices in found.items()}

    def is_primitive(self, task: int) -> bool:
        """Tell whether a task is an action."""
        return task < len(self.actions)
