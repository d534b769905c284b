"""Utilities that are Python functions of the total cost."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from contextlib import suppress
from dataclasses import dataclass, field
from itertools import accumulate

from statehtn.errors import UsageError
from statehtn.expected import number, shown
from statehtn.model.cost.distribution import CostDistribution
from statehtn.model.cost.law import CostLaw, checked_function
from statehtn.model.expect import expect_law
from statehtn.risk.asked_utilities import AskedUtilities
from statehtn.risk.certain_cost import certain_cost
from statehtn.risk.objective import ValueUnit
from statehtn.risk.total_utility import TotalUtility

GRID = 64  # costs between the least and the largest one at which monotony is checked
FAR = 1 - 1e-6  # the quantile up to which an unbounded law is checked
FAR_BETTER = 1e3  # times the largest utility that is known, or 1


@dataclass(frozen=True, slots=True)
class CallableUtility(TotalUtility):
    """Minus the expected utility, `-E u(C)`, of a utility that is a Python function; the unit is that of `u`.

    The function must not rise with the cost; that is checked on a grid, at every outcome, and between all costs that it
    is asked about. Nothing else is known of it, so plans are compared by whether one is sure to cost no more
    (first-order stochastic dominance) and by values. It may fail for costs that no plan has.

    Source: von Neumann and Morgenstern, *Theory of Games and Economic Behavior*, 1944.

    Args:
        function: of a total cost, a float of at least 0 in the domain's unit; returns a finite number.

    Raises:
        UsageError: this is no function; later, where it rises, or fails or returns no finite number for a cost that is
            valued.
    """

    function: Callable[[float], float]
    _asked: AskedUtilities = field(default_factory=AskedUtilities, init=False, repr=False, compare=False)

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
        """Check on a grid from one cost to another that the function does not rise, wherever it does not fail.

        Raises:
            UsageError: it rises.
        """
        step = (most - least) / GRID
        for cost in (*(least + step * point for point in range(GRID)), most):
            self._answer(cost)

    def utilities(self, costs: Iterable[float]) -> list[float]:
        """Return the utilities of ascending costs.

        Raises:
            UsageError: the function rises, or fails.
        """
        found = []
        for cost in costs:
            utility = self.utility(cost)
            self._asked.add(self.name, cost, utility)
            found.append(utility)
        return found

    def bounds(self, costs: Iterable[float]) -> list[float]:
        """Return upper bounds of the utilities of ascending costs, some of which no plan may have.

        They are the utilities themselves, but where the function fails. There the utility is at most that of a smaller
        cost. One that is less than all costs for which it does not fail counts as far better than they are: so a plan
        with such a cost is found and valued, which is an error.

        Raises:
            UsageError: the function rises, or fails for all of them.
        """
        listed = list(costs)
        answers = [self._answer(cost) for cost in listed]
        known = [answer for answer in answers if answer is not None]
        if not known:
            return self.utilities(listed)  # which says how it fails
        best = known[0] if answers[0] is not None else known[0] + FAR_BETTER * max(1.0, *map(abs, known))
        return list(accumulate(answers, lambda last, answer: last if answer is None else answer, initial=best))[1:]

    def _answer(self, cost: float) -> float | None:
        """Return the utility of a cost; None where the function fails.

        Raises:
            UsageError: it rises.
        """
        try:
            utility = self.utility(cost)
        except UsageError:
            return None
        self._asked.add(self.name, cost, utility)
        return utility

    def value(self, law: CostLaw) -> float:
        """Return minus the expected utility of a law.

        Raises:
            UsageError: the function rises, or fails or returns no finite number for a cost of the law.
            InputError: the expectation cannot be computed.
        """
        expect_law(law)
        if isinstance(law, CostDistribution):
            self.utilities(cost for _, cost in law.outcomes)
        self.check(law.least, _highest(law))
        return 0.0 - law.expectation(self.utility)

    def certainty_equivalent(self, law: CostLaw) -> float | None:
        """Return the certain cost of the same utility.

        None where the utility does not fall strictly there, or fails between the costs of the law.
        """
        value = self.value(law)
        with suppress(UsageError):
            return certain_cost(self.utility, -value, law.least, _highest(law))
        return None

    def __str__(self) -> str:
        return f"utility {self.name}"


def _highest(law: CostLaw) -> float:
    """Return the largest cost that a law has, or is next to sure not to exceed."""
    return law.most if math.isfinite(law.most) else law.quantile(FAR)
