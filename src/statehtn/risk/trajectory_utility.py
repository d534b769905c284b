"""The expected utility of one trajectory of a plan or a policy."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable

from statehtn.errors import UsageError
from statehtn.expected import items, number, shown
from statehtn.model.cost.law import checked_function


def trajectory_utility(outcomes: Iterable[tuple[float, float]], utility: Callable[[float], float]) -> float:
    """Return the sum over the actions of a trajectory of the probability of what came, times the utility of its cost.

    Source: equation 9 of the paper, after Meneguzzi, Magnaguagno, Singh, Telang and Yorke-Smith, *GoCo: planning
    expressive commitment protocols*, 2018. It is no expected utility of the total cost, which is the sum over all
    trajectories that equation 4 defines.

    Args:
        outcomes: for each action the probability of the outcome that came, and what it has cost, as
            `[(step.probability, step.cost) for step in trajectory.steps]` for a run of a policy.
        utility: of the cost of an action, positive, in the domain's unit.

    Raises:
        UsageError: these are no pairs of numbers, or a probability is none.
    """
    worth = checked_function(utility, "the utility")
    parts: list[float] = []
    for pair in items(outcomes, "the outcomes"):
        try:
            first, second = pair
        except (TypeError, ValueError):
            raise UsageError(f"an outcome is a pair (probability, cost), found {shown(pair)}") from None
        probability = number(first, "a probability")
        if not 0 <= probability <= 1:
            raise UsageError(f"a probability must be between 0 and 1, found {probability:g}")
        parts.append(probability * worth(number(second, "a cost")))
    return math.fsum(parts)
