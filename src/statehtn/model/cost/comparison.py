"""Two laws of costs compared: by stochastic orders, and by which of two independent costs is likely to be larger."""

from __future__ import annotations

import math
from bisect import bisect_right
from collections.abc import Callable
from itertools import accumulate

from statehtn.errors import UsageError
from statehtn.expected import shown
from statehtn.model.cost.distribution import CostDistribution
from statehtn.model.cost.law import CostLaw
from statehtn.model.cost.scenario_cost import ScenarioCost
from statehtn.model.cost.scipy_law import ScipyCost
from statehtn.model.cost.sum import CostSum

ROUNDING = 1e-12  # of probabilities, and of expected overruns relative to the largest cost
POINTS = 100  # quantiles of a continuous law at which it is compared
INTEGRATED = 1e-9  # what is lost to rounding and quadrature there


def dominates(law: CostLaw, other: CostLaw, order: int) -> bool:
    """Tell whether a law is at least as good as another in a stochastic order; see `CostLaw.dominates`."""
    if isinstance(order, bool) or order not in (1, 2):
        raise UsageError(f"the order of stochastic dominance is 1 or 2, found {shown(order)}")
    pair = _outcomes_of(law), _outcomes_of(other)
    costs = sorted({cost for given in pair for cost in _points(given)})
    best, worst = (_risen(given, costs) if order == 1 else _overruns(given, costs) for given in pair)
    is_listed = all(isinstance(given, CostDistribution) for given in pair)
    slack = (ROUNDING if is_listed else INTEGRATED) * (1.0 if order == 1 else max(costs[-1], 1e-300))
    return all(here <= there + slack for here, there in zip(best, worst, strict=True))


def probability_above(law: CostLaw, other: CostLaw) -> float:
    """Return the probability of a larger cost than an independent one; see `CostLaw.probability_above`."""
    law, other = _outcomes_of(law), _outcomes_of(other)
    if isinstance(other, CostDistribution) or (isinstance(other, ScipyCost) and other.is_discrete):
        return min(1.0, other.expectation(_exceedances(law)))
    if isinstance(other, ScipyCost) and isinstance(law, ScipyCost) and not law.is_discrete:
        from statehtn.model.cost.numerics.expectation import integrated

        return min(1.0, max(0.0, integrated(law, other.frozen.cdf)))
    return min(1.0, max(0.0, law.expectation(lambda cost: other.cdf(math.nextafter(cost, -math.inf)))))


def _outcomes_of(law: CostLaw) -> CostLaw:
    """Return the law as a list of outcomes where it has one."""
    if isinstance(law, ScenarioCost):
        return law.mixture or law
    return law.total if isinstance(law, CostSum) else law


def _points(law: CostLaw) -> list[float]:
    """Return the costs at which a law is looked at: all its outcomes, or quantiles."""
    if isinstance(law, CostDistribution):
        return [cost for _, cost in law.outcomes]
    ends = [10.0**-power for power in range(3, 13)]
    levels = [*ends, *(point / POINTS for point in range(1, POINTS)), *(1 - end for end in ends)]
    return [law.least, *map(law.quantile, levels), *([law.most] if math.isfinite(law.most) else [])]


def _risen(law: CostLaw, costs: list[float]) -> list[float]:
    """Return the probability of more than each of some ascending costs."""
    return list(map(_exceedances(law), costs))


def _exceedances(law: CostLaw) -> Callable[[float], float]:
    """Return the function that `exceedance` is, for many questions."""
    if not isinstance(law, CostDistribution):
        return law.exceedance
    costs = [cost for _, cost in law.outcomes]
    tails = [0.0, *accumulate(probability for probability, _ in reversed(law.outcomes))]
    return lambda cost: tails[len(costs) - bisect_right(costs, cost)]


def _overruns(law: CostLaw, costs: list[float]) -> list[float]:
    """Return the expected overrun of each of some ascending costs."""
    if isinstance(law, ScipyCost) and not law.is_discrete:
        from statehtn.model.cost.numerics.quadrature import excesses

        return excesses(law, costs)
    if not isinstance(law, CostDistribution):
        return [law.expected_overrun(cost) for cost in costs]
    found, tail, above, left = [], 0.0, 0.0, list(law.outcomes)
    for cost in reversed(costs):
        while left and left[-1][1] > cost:
            probability, outcome = left.pop()
            tail, above = tail + probability, above + probability * outcome
        found.append(above - tail * cost)
    return found[::-1]
