"""The max heuristic: a set of facts costs as much as its most expensive one.

Source: Bonet and Geffner, "Planning as heuristic search" (2001). Admissible.
"""

from __future__ import annotations

import math

from statehtn.reference.relaxed_model import RelaxedFact, RelaxedTask


def hmax(task: RelaxedTask) -> float:
    """Return the max heuristic of the initial state, in the unit of the operators' costs; infinite for a dead end."""
    return max((hmax_of_facts(task).get(goal, math.inf) for goal in task.goals), default=0.0)


def hmax_of_facts(task: RelaxedTask) -> dict[RelaxedFact, float]:
    """Return the hmax value of every fact that can be reached."""
    values = dict.fromkeys(task.initial_state, 0.0)
    changed = True
    while changed:
        changed = False
        for operator in task.operators:
            if operator.preconditions <= values.keys():
                cost = operator.cost + max((values[fact] for fact in operator.preconditions), default=0.0)
                for fact in operator.add_effects:
                    if cost < values.get(fact, math.inf):
                        values[fact] = cost
                        changed = True
    return values
