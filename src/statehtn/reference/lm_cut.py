"""The landmark-cut heuristic: a sum of costs of landmarks, sets of operators one of which every plan needs.

Source: Helmert and Domshlak, "Landmarks, critical paths and abstractions: what's the difference anyway?" (2009).
Admissible. The paper names it for line 7 of Algorithm 5.
"""

from __future__ import annotations

import math
from dataclasses import replace

from statehtn.reference.hmax import hmax_of_facts
from statehtn.reference.relaxed_model import RelaxedFact, RelaxedOperator, RelaxedTask

Owner = tuple[int | None, int | None]
"""What is paid for once: an action, or a part of its cost; several operators may share it."""


def lm_cut(task: RelaxedTask) -> float:
    """Return the landmark-cut heuristic of the initial state, in the unit of costs; infinite for a dead end."""
    total = 0.0
    while True:
        values = hmax_of_facts(task)
        if not task.goals <= values.keys():
            return math.inf
        goal = max(task.goals, key=values.__getitem__, default=None)
        if goal is None or values[goal] == 0:
            return total
        cut = find_cut(task, values, goal)
        least = min(operator.cost for operator in cut)
        assert least > 0  # what leads into the goal zone for free has its supporter there
        total += least
        owners = {_owner(operator) for operator in cut}
        operators = (
            replace(one, cost=one.cost - least) if one.cost > 0 and _owner(one) in owners else one
            for one in task.operators
        )
        task = replace(task, operators=tuple(operators))


def find_cut(task: RelaxedTask, values: dict[RelaxedFact, float], goal: RelaxedFact) -> list[RelaxedOperator]:
    """Return operators that cost something, one of which is in every plan.

    An operator is reached through its supporter, its most expensive precondition. The goal zone is what leads to the
    goal for free; every plan enters it from outside, by one of the operators returned.

    Args:
        task: the relaxed task with what is left of the costs.
        values: the facts that can be reached, with their hmax.
        goal: the most expensive goal, which is not free.
    """
    supported: list[tuple[RelaxedFact | None, RelaxedOperator]] = [
        (max(operator.preconditions, key=lambda fact: (values[fact], fact), default=None), operator)
        for operator in task.operators
        if operator.preconditions <= values.keys()
    ]
    zone: set[RelaxedFact] = set()
    new = {goal}
    while new:
        zone |= new
        new = {fact for fact, operator in supported if fact and operator.cost == 0 and operator.add_effects & zone}
        new -= zone
    reached = set(task.initial_state)
    while True:
        entered = [operator for fact, operator in supported if fact is None or fact in reached]
        new = set().union(*(operator.add_effects for operator in entered)) - zone - reached
        if not new:
            return [operator for operator in entered if operator.add_effects & zone]
        reached |= new


def _owner(operator: RelaxedOperator) -> Owner:
    return operator.action, operator.part
