"""Utilities that are Python functions of the total cost."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from itertools import pairwise

from statehtn.errors import UsageError
from statehtn.expected import number, shown
from statehtn.model.cost.distribution import CostDistribution
from statehtn.model.cost.law import CostLaw, checked_function
from statehtn.model.expect import expect_law
from statehtn.risk.certain_cost import certain_cost
from statehtn.risk.objective import ValueUnit
from statehtn.risk.total_utility import TotalUtility

GRID = 64  # costs between the least and the largest one at which monotony is checked
ROUNDING = 1e-12  # relative, by which a utility may rise
FAR = 1 - 1e-6  # the quantile up to which an unbounded law is checked


@dataclass(frozen=True, slots=True)
class CallableUtility(TotalUtility):
    """Minus the expected utility, `-E u(C)`, of a utility that is a Python function; the unit is that of `u`.

    The function must not rise with the cost; that is checked on a grid, and at every outcome. Nothing else is known of
    it, so plans are compared by whether one is sure to cost no more (first-order stochastic dominance) and by values.

    Source: von Neumann and Morgenstern, *Theory of Games and Economic Behavior*, 1944.

    Args:
        function: of a total cost, a float of at least 0 in the domain's unit; returns a finite number.

    Raises:
        UsageError: this is no function; later, where it rises, fails or returns no finite number.
    """

    function: Callable[[float], float]

    unit = ValueUnit.UTILITY
    monotone = True
    concave = False

    def __post_init__(self) -> None:
        if not callable(self.function) or isinstance(self.function, type):
            raise UsageError(f"a utility is a function of the total cost, found {shown(self.function)}")

    @property
    def name(self) -> str:
        """What the function is called."""
        return str(getattr(self.function, "__name__", type(self.function).__name__))

    def utility(self, cost: float) -> float:
        """Return the utility of a certain cost.

        Raises:
            UsageError: the function fails, or returns no finite number.
        """
        return checked_function(self.function, f"the utility '{self.name}'")(number(cost, "a cost"))

    def check(self, least: float, most: float) -> None:
        """Check on a grid from one cost to another that the function does not rise.

        Raises:
            UsageError: it rises, or fails.
        """
        step = (most - least) / GRID
        self.utilities([*(least + step * point for point in range(GRID)), most])

    def utilities(self, costs: Iterable[float]) -> list[float]:
        """Return the utilities of ascending costs.

        Raises:
            UsageError: the function rises, or fails.
        """
        found = [(cost, self.utility(cost)) for cost in costs]
        for (cost, utility), (later, other) in pairwise(found):
            if other > utility + ROUNDING * max(abs(utility), abs(other)):
                raise UsageError(
                    f"the utility '{self.name}' rises: {utility:g} for a cost of {cost:g}, {other:g} for {later:g}; "
                    f"costs are positive and utilities maximised, so it must fall or stay"
                )
        return [utility for _, utility in found]

    def value(self, law: CostLaw) -> float:
        """Return minus the expected utility of a law.

        Raises:
            UsageError: the function rises, fails, or returns no finite number.
            InputError: the expectation cannot be computed.
        """
        self.check(expect_law(law).least, _highest(law))
        if isinstance(law, CostDistribution):
            self.utilities(cost for _, cost in law.outcomes)
        return 0.0 - law.expectation(self.utility)

    def certainty_equivalent(self, law: CostLaw) -> float | None:
        """Return the certain cost of the same utility; None where the utility does not fall strictly there."""
        return certain_cost(self.utility, -self.value(law), law.least, _highest(law))

    def __str__(self) -> str:
        return f"utility {self.name}"


def _highest(law: CostLaw) -> float:
    """Return the largest cost that a law has, or is next to sure not to exceed."""
    return law.most if math.isfinite(law.most) else law.quantile(FAR)
