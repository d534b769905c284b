"""The law of what runs of a policy cost."""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import cached_property
from typing import TYPE_CHECKING, Any

from statehtn.errors import InputError
from statehtn.expected import number
from statehtn.model.cost.distribution import ROUNDING, CostDistribution
from statehtn.model.cost.infinite import InfiniteMean
from statehtn.model.cost.law import PLOT_POINTS, CostLaw, checked_function, checked_probability
from statehtn.policies.chain import Chain
from statehtn.policies.extremes import largest_cost, least_cost
from statehtn.policies.simulation import sampled_costs
from statehtn.policies.totals import Totals, totals_of

if TYPE_CHECKING:
    from numpy import float64
    from numpy.random import Generator
    from numpy.typing import NDArray

NEGLIGIBLE = 1e-15  # of a probability that is shown


class PolicyCost(CostLaw):
    """The law of the total cost of a policy's runs: at least 0, in the domain's unit.

    It is a mixture over what the outcomes of actions may be. A run that fails costs what it has spent, and the failure
    cost on top; where that is infinite, so is the cost. Mean and exponential means are exact, as solutions of linear
    equations; probabilities come from `outcomes`, which are worked out when they are asked for.

    Args:
        chain: the runs.
        failure: what a run pays that fails, on top of what it has spent; may be infinite.
    """

    def __init__(self, chain: Chain, failure: float = 0.0) -> None:
        self.chain = chain
        self.failure = failure

    @cached_property
    def totals(self) -> Totals:
        """The amounts that are paid, and how likely they are.

        Raises:
            UnsupportedError: a cost is no list of outcomes, or there are too many amounts.
        """
        return totals_of(self.chain)

    @cached_property
    def outcomes(self) -> tuple[tuple[float, float], ...]:
        """Pairs of a probability and a finite cost, by cost; what is missing to 1 costs infinitely much, or was cut."""
        unit, found = self.totals.unit, dict[float, float]()
        for amount, probability in self.totals.done.items():
            found[float(amount * unit)] = probability
        for amount, probability in self.totals.failed.items() if math.isfinite(self.failure) else ():
            cost = float(amount * unit) + self.failure
            found[cost] = found.get(cost, 0.0) + probability
        return tuple((found[cost], cost) for cost in sorted(found))

    @cached_property
    def infinite(self) -> float:
        """The probability of an infinite cost."""
        failed = 0.0 if math.isfinite(self.failure) else math.fsum(self.totals.failed.values())
        return failed + self.totals.endless

    @cached_property
    def failed(self) -> float:
        """The probability that a run fails, or never ends."""
        return max(0.0, 1.0 - self.chain.success_probability())

    @property
    def given_done(self) -> CostDistribution | None:
        """The law of the total cost among runs that are done; None where there are none."""
        return self._given(self.totals.done)

    @property
    def given_failed(self) -> CostDistribution | None:
        """The law of what runs have spent that fail, without the failure cost; None where none does."""
        return self._given(self.totals.failed)

    def _given(self, amounts: dict[int, float]) -> CostDistribution | None:
        whole = math.fsum(amounts.values())
        if whole <= 0:
            return None
        return CostDistribution.of((p / whole, float(amount * self.totals.unit)) for amount, p in amounts.items())

    @property
    def mean(self) -> float:
        """The expected cost; may be infinite."""
        return self.chain.mean(self.failure)

    @property
    def standard_deviation(self) -> float:
        """The standard deviation of the cost; infinite where the cost may be."""
        if self.infinite:
            return math.inf
        mean = self.mean
        return math.hypot(*(math.sqrt(probability) * (cost - mean) for probability, cost in self.outcomes))

    @cached_property
    def least(self) -> float:
        """The least cost that is possible."""
        return least_cost(self.chain, self.failure)

    @cached_property
    def most(self) -> float:
        """The largest cost that is possible; infinite where a loop may cost any amount."""
        return largest_cost(self.chain, self.failure)

    def cdf(self, cost: float) -> float:
        """Return the probability of paying at most `cost`."""
        budget = number(cost, "a cost")
        return min(1.0, math.fsum(probability for probability, paid in self.outcomes if paid <= budget))

    def exceedance(self, budget: float) -> float:
        """Return the probability of paying more than `budget`."""
        budget = number(budget, "a budget")
        more = math.fsum(probability for probability, paid in self.outcomes if paid > budget)
        return min(1.0, more + self.infinite)

    def quantile(self, probability: float) -> float:
        """Return the least budget that is kept with at least this probability, to 1e-12 of it; may be infinite."""
        wanted = checked_probability(probability, "the probability of a quantile") - ROUNDING
        kept = 0.0
        for part, cost in self.outcomes:
            kept += part
            if kept >= wanted:
                return self.most if probability == 1 else cost
        return self.most

    def cvar(self, level: float) -> float:
        """Return the mean cost of the worst `1 - level` of all cases; infinite where an infinite cost is among them.

        Raises:
            UsageError: the level is not between 0 and 1.
        """
        tail = 1 - checked_probability(level, "the level of the CVaR")
        if self.infinite > NEGLIGIBLE or (tail <= ROUNDING and math.isinf(self.most)):
            return math.inf
        return CostDistribution(self._whole()).cvar(level)

    def _whole(self) -> tuple[tuple[float, float], ...]:
        """Return the finite outcomes, their probabilities scaled to sum to 1."""
        whole = math.fsum(probability for probability, _ in self.outcomes)
        return tuple((probability / whole, cost) for probability, cost in self.outcomes)

    def exponential_mean(self, slope: float) -> float:
        """Return `ln E[e^(slope C)] / slope`.

        Raises:
            InfiniteMean: the expectation is infinite: a loop is tried again too often for its cost.
        """
        found = self.chain.exponential_mean(number(slope, "the slope"), self.failure)
        if math.isinf(found):
            raise InfiniteMean(f"the policy's total cost has an infinite exponential mean for the slope {slope:g}")
        return found

    def exponential_mean_error(self, slope: float) -> float:  # noqa: ARG002
        """Return 0: it is exact but for rounding."""
        return 0.0

    def expectation(self, function: Callable[[float], float]) -> float:
        """Return the expected value of a function of the cost, over the outcomes.

        Raises:
            InputError: the cost may be infinite.
        """
        called = checked_function(function)
        if self.infinite > NEGLIGIBLE:
            raise InputError("a run of this policy may cost infinitely much, of which a function says nothing")
        return math.fsum(probability * called(cost) for probability, cost in self._whole())

    def to_scipy(self) -> Any:
        """Return the law as a frozen discrete distribution of `scipy.stats`.

        Raises:
            UsageError: scipy is not installed.
            InputError: the cost may be infinite.
        """
        if self.infinite > NEGLIGIBLE:
            raise InputError("a run of this policy may cost infinitely much, which no law of scipy says")
        return CostDistribution(self._whole()).to_scipy()

    def sample(self, runs: int, generator: Generator) -> NDArray[float64]:
        """Draw the costs of so many runs with a generator of numpy."""
        return sampled_costs(self.chain, runs, generator, self.failure)

    def curve(self, points: int = PLOT_POINTS) -> tuple[list[float], list[float]]:
        """Return ascending costs, and the probability of each or less, for a drawing."""
        if not self.outcomes:
            return [0.0], [0.0]
        costs, heights = CostDistribution(self.outcomes).curve(points)
        return costs, heights

    def __str__(self) -> str:
        """Say the outcomes where there are few, and how likely a run is to fail."""
        shown = [(p, cost) for p, cost in self.outcomes if p > NEGLIGIBLE]
        text = str(CostDistribution(tuple(shown))) if shown else "infinite"
        if self.totals.cut:
            text = f"from {self.least:g}, without a largest cost"
        return text if self.failed <= NEGLIGIBLE else f"{text}; failed w.p. {self.failed:.6g}"
