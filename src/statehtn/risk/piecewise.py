"""Piecewise linear utilities of the total cost."""

from __future__ import annotations

import math
from bisect import bisect_right
from collections.abc import Iterable
from dataclasses import dataclass
from itertools import pairwise

from statehtn.errors import UsageError
from statehtn.expected import items, shown
from statehtn.model.cost.distribution import CostDistribution
from statehtn.model.cost.law import CostLaw
from statehtn.model.expect import expect_law
from statehtn.risk.certain_cost import certain_cost
from statehtn.risk.checks import finite, text_of
from statehtn.risk.objective import ValueUnit
from statehtn.risk.total_utility import TotalUtility

LEAST_POINTS = 2
SMALLER = "state utilities in a larger unit"


@dataclass(frozen=True, slots=True)
class Piecewise(TotalUtility):
    """Minus the expected utility, `-E u(C)`, of a utility that is linear between given points; the unit is that of `u`.

    Below the first point and above the last one the first and the last piece go on.

    Source: von Neumann and Morgenstern, *Theory of Games and Economic Behavior*, 1944; utilities that were elicited
    point by point: Keeney and Raiffa, *Decisions with Multiple Objectives*, 1976.

    Args:
        points: pairs (cost, utility), at least two; costs rise, utilities do not.

    Raises:
        UsageError: there are fewer, they are out of order, the utility rises, or a number is not finite.
    """

    points: tuple[tuple[float, float], ...]

    unit = ValueUnit.UTILITY
    monotone = True

    def __post_init__(self) -> None:
        object.__setattr__(self, "points", _checked(self.points))

    @property
    def slopes(self) -> tuple[float, ...]:
        """The slope of each piece, utility per unit of cost, at most 0."""
        return tuple((v - u) / (d - c) for (c, u), (d, v) in pairwise(self.points))

    @property
    def concave(self) -> bool:
        """True if every piece falls at least as fast as the one before it."""
        return all(later <= earlier for earlier, later in pairwise(self.slopes))

    def utility(self, cost: float) -> float:
        """Return the utility of a certain cost."""
        costs = [point for point, _ in self.points]
        piece = min(max(bisect_right(costs, cost) - 1, 0), len(costs) - 2)
        (c, u), (d, v) = self.points[piece], self.points[piece + 1]
        share = (cost - c) / (d - c)
        return u + share * (v - u) if share < 0.5 else v + (share - 1) * (v - u)

    def value(self, law: CostLaw) -> float:
        """Return minus the expected utility of a law.

        Of a continuous law it is taken from the mean and from the expected overruns of the points, at which the slope
        changes.

        Raises:
            UsageError: it is too large for a float.
        """
        if isinstance(expect_law(law), CostDistribution):
            return 0.0 - law.expectation(self.finite_utility)
        (first, utility), slopes = self.points[0], self.slopes
        expected = utility + slopes[0] * (law.mean - first)
        for (cost, _), (before, after) in zip(self.points[1:-1], pairwise(slopes), strict=True):
            expected += (after - before) * law.expected_overrun(cost)
        if not math.isfinite(expected):
            raise UsageError(f"{law}: its expected utility is too large for a floating-point number; {SMALLER}")
        return 0.0 - expected

    def finite_utility(self, cost: float) -> float:
        """Return the utility of a certain cost.

        Raises:
            UsageError: it is too large for a float.
        """
        utility = self.utility(cost)
        if not math.isfinite(utility):
            raise UsageError(f"the utility of a cost of {cost:g} is too large for a floating-point number; {SMALLER}")
        return utility

    def certainty_equivalent(self, law: CostLaw) -> float | None:
        """Return the certain cost of the same utility; None where the utility does not fall strictly there."""
        return certain_cost(self.utility, -self.value(law), law.least, law.most)

    def __str__(self) -> str:
        return " ".join(["piecewise", *(f"{text_of(cost)}:{text_of(utility)}" for cost, utility in self.points)])


def _checked(given: Iterable[tuple[float, float]]) -> tuple[tuple[float, float], ...]:
    """Return points that are in order."""
    points: list[tuple[float, float]] = []
    for point in items(given, "the points of a piecewise linear utility"):
        try:
            first, second = point
        except (TypeError, ValueError):
            raise UsageError(f"a point of a utility is a pair (cost, utility), found {shown(point)}") from None
        cost, utility = finite(first, "the cost of a point"), finite(second, "the utility of a point")
        if points and not points[-1][0] < cost:
            raise UsageError(
                f"the points of a utility must be in the order of their costs, found {text_of(cost)} after "
                f"{text_of(points[-1][0])}"
            )
        if points and utility > points[-1][1]:
            raise UsageError(
                f"a utility of the cost must not rise, found {text_of(points[-1][1])} for {text_of(points[-1][0])} and "
                f"{text_of(utility)} for {text_of(cost)}; utilities are maximised, costs positive"
            )
        if points and not math.isfinite((utility - points[-1][1]) / (cost - points[-1][0])):
            raise UsageError(
                f"a utility falls too steeply for floating-point numbers, from {text_of(points[-1][1])} for "
                f"{text_of(points[-1][0])} to {text_of(utility)} for {text_of(cost)}; {SMALLER}"
            )
        points.append((cost, utility))
    if len(points) < LEAST_POINTS:
        raise UsageError(f"a piecewise linear utility needs at least two points, found {len(points)}")
    return tuple(points)
