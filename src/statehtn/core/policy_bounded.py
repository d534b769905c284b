"""Utilities that are Python functions, as policies are searched for by them: tabulated up to the largest total cost."""

from __future__ import annotations

from statehtn.core.law_grid import LawGrid
from statehtn.core.policy_disutility import Disutility
from statehtn.core.policy_space import most_cost
from statehtn.errors import UnsupportedError
from statehtn.expected import shown_number
from statehtn.limits import Limits, watched
from statehtn.model.fraction import fraction_of
from statehtn.risk import CallableUtility

MOST_AMOUNTS = 2**20
"""At which the function is called."""


def bounded_disutility(
    objective: CallableUtility, grid: LawGrid, failure_cost: float | None, limits: Limits
) -> Disutility:
    """Return the disutility of what is left of the largest amount that a run may cost.

    Nothing is known of such a function but what it says: so it is asked for every amount up to that one, and checked
    not to rise. Where it fails it is bounded; a policy that may cost that much has no value, which is an error. Where a
    loop costs something there is no largest amount, and no bound beyond any.

    Args:
        objective: the utility.
        grid: the laws of costs, exact.
        failure_cost: what giving up adds to what was spent; None where it is not allowed.
        limits: they hold.

    Raises:
        UnsupportedError: there is no largest amount, or there are too many.
        UsageError: the function rises, or fails for all amounts.
        LimitReached: a limit was reached.
    """
    step = grid.grid.step
    most = most_cost(grid.grounding, lambda law: grid.grid.steps(law.most), limits)
    if most is None:
        raise UnsupportedError(
            f"a policy by '{objective}' needs costs that are bounded, since nothing is known of the function beyond "
            "what is asked of it: here a loop that costs something may be run through again and again"
        )
    first = int(most) + (0 if failure_cost is None else int(fraction_of(failure_cost) / step))
    if first >= MOST_AMOUNTS:
        raise UnsupportedError(
            f"a policy by '{objective}' needs its values for all amounts that may be spent, and there are "
            f"{shown_number(first + 1)} of them, more than {MOST_AMOUNTS}; round the costs"
        )
    with watched(limits):
        utilities = objective.bounds(float(step * amount) for amount in range(first + 1))
    table = tuple(-utility for utility in reversed(utilities))
    return Disutility(first, table, beyond=table[0])
