"""Costs that hang together: each has a law of its own in every scenario, and a scenario is common to all of a plan."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property
from operator import mul
from typing import TYPE_CHECKING, Any

from statehtn.errors import UnsupportedError, UsageError
from statehtn.expected import did_you_mean, number, shown
from statehtn.model.chance import Scenario
from statehtn.model.cost.distribution import CostDistribution
from statehtn.model.cost.law import CostLaw, checked_probability
from statehtn.model.cost.numerics.exponential_mean import exponential_mean_of
from statehtn.model.cost.sum import CostSum, total_cost

if TYPE_CHECKING:
    from numpy import float64
    from numpy.random import Generator
    from numpy.typing import NDArray

HALVINGS = 200  # of an interval of costs: beyond what a float tells apart


@dataclass(frozen=True, repr=False)
class ScenarioCost(CostLaw):
    """A cost that depends on what is hidden: a law given each scenario, and the mixture of them all.

    Whatever a law is asked, it answers for the mixture. Costs of one plan have the same scenarios: given one of them
    they are independent, and over all of them they are not (`sum_of`, `total_of`).

    Args:
        scenarios: of the problem.
        laws: one for each scenario.
    """

    scenarios: tuple[Scenario, ...]
    laws: tuple[CostLaw, ...]

    def __hash__(self) -> int:
        return self._hash

    @cached_property
    def _hash(self) -> int:
        return hash(self.laws)

    def given(self, scenario: Scenario | str | int) -> CostLaw:
        """Return the law given a scenario: itself, its name, or its number from 0.

        Raises:
            UsageError: there is no such scenario.
        """
        if isinstance(scenario, int) and 0 <= scenario < len(self.laws):
            return self.laws[scenario]
        name = str(scenario)
        for known, law in zip(self.scenarios, self.laws, strict=True):
            if known.name == name:
                return law
        names = [known.name for known in self.scenarios]
        raise UsageError(f"there is no scenario {shown(scenario)}{did_you_mean(name, names)}")

    @cached_property
    def weights(self) -> tuple[float, ...]:
        """The probability of each scenario."""
        return tuple(scenario.probability for scenario in self.scenarios)

    @cached_property
    def mixture(self) -> CostDistribution | None:
        """The law over all scenarios as a list of outcomes; None where a scenario has another law."""
        if not all(isinstance(law, CostDistribution) for law in self.laws):
            return None
        return CostDistribution.of(
            (weight * probability, cost)
            for weight, law in zip(self.weights, self.laws, strict=True)
            for probability, cost in law.outcomes  # type: ignore[attr-defined]
        )

    def _mean_of(self, measure: Callable[[CostLaw], float]) -> float:
        return math.fsum(map(mul, self.weights, map(measure, self.laws)))

    @cached_property
    def mean(self) -> float:
        """The expected cost."""
        return self._mean_of(lambda law: law.mean)

    @property
    def standard_deviation(self) -> float:
        """The standard deviation of the cost."""
        mean = self.mean
        variance = self._mean_of(lambda law: law.standard_deviation**2 + (law.mean - mean) ** 2)
        return math.sqrt(variance)

    @property
    def least(self) -> float:
        """The least cost that is possible."""
        return min(law.least for law in self.laws)

    @property
    def most(self) -> float:
        """The largest cost that is possible; may be infinite."""
        return max(law.most for law in self.laws)

    def cdf(self, cost: float) -> float:
        """Return the probability of paying at most `cost`."""
        number(cost, "a cost")
        return min(1.0, self._mean_of(lambda law: law.cdf(cost)))

    def exceedance(self, budget: float) -> float:
        """Return the probability of paying more than `budget`."""
        number(budget, "a budget")
        return min(1.0, self._mean_of(lambda law: law.exceedance(budget)))

    def quantile(self, probability: float) -> float:
        """Return the least budget that is kept with at least this probability.

        Raises:
            UsageError: the probability is not between 0 and 1.
        """
        if self.mixture is not None:
            return self.mixture.quantile(probability)
        if checked_probability(probability, "the probability of a quantile") in (0, 1):
            return self.most if probability else self.least
        low, high = (choose(law.quantile(probability) for law in self.laws) for choose in (min, max))
        for _ in range(HALVINGS):
            middle = (low + high) / 2
            if not low < middle < high:
                break
            low, high = (low, middle) if self.cdf(middle) >= probability else (middle, high)
        return low if self.cdf(low) >= probability else high

    def cvar(self, level: float) -> float:
        """Return the mean cost of the worst `1 - level` of all cases.

        Raises:
            UsageError: the level is not between 0 and 1.
        """
        if self.mixture is not None:
            return self.mixture.cvar(level)
        if checked_probability(level, "the level of the CVaR") in (0, 1):
            return self.most if level else self.mean
        quantile = self.quantile(level)
        return quantile + self.expected_overrun(quantile) / (1 - level)

    def exponential_mean(self, slope: float) -> float:
        """Return `ln E[e^(slope C)] / slope`, where the mean of a scenario's is taken over all scenarios."""
        slope = number(slope, "the slope")
        pairs = sorted(zip((law.exponential_mean(slope) for law in self.laws), self.weights, strict=True))
        costs, weights = zip(*pairs, strict=True)
        mean = math.fsum(map(mul, weights, costs)) / math.fsum(weights)
        return exponential_mean_of(weights, costs, min(max(mean, costs[0]), costs[-1]), slope)

    def exponential_mean_error(self, slope: float) -> float:
        """Return the error of `exponential_mean` beyond rounding: at most the largest of a scenario's."""
        return max(law.exponential_mean_error(slope) for law in self.laws)

    def expectation(self, function: Callable[[float], float]) -> float:
        """Return the expected value of a function of the cost."""
        return self._mean_of(lambda law: law.expectation(function))

    def expected_overrun(self, budget: float) -> float:
        """Return `E max(C - budget, 0)`: what is paid above a budget, in the mean over all cases."""
        return self._mean_of(lambda law: law.expected_overrun(budget))

    def to_scipy(self) -> Any:
        """Return the mixture as a frozen discrete distribution of `scipy.stats`.

        Raises:
            UnsupportedError: the law given some scenario is no list of outcomes.
        """
        if self.mixture is None:
            raise UnsupportedError(
                f"scipy.stats has no mixtures, such as {self}; ask for the law given a scenario: law.given(scenario)"
            )
        return self.mixture.to_scipy()

    def sample(self, runs: int, generator: Generator) -> NDArray[float64]:
        """Draw so many independent costs, each in a scenario of its own, with a generator of numpy."""
        import numpy

        weights = numpy.array(self.weights)
        drawn = generator.choice(len(self.laws), size=runs, p=weights / weights.sum())
        costs = numpy.empty(runs)
        for index, law in enumerate(self.laws):
            chosen = drawn == index
            costs[chosen] = law.sample(int(chosen.sum()), generator)
        return costs

    def __str__(self) -> str:
        if self.mixture is None:
            return f"a law for each of {len(self.laws)} scenarios, from {self.least:g} to {self.most:g}"
        return str(self.mixture)


def by_scenario(scenarios: tuple[Scenario, ...], laws: Sequence[CostLaw]) -> CostLaw:
    """Return the cost that has a law in each scenario: the law itself where it is the same in all of them."""
    first = laws[0]
    return first if all(law is first or law == first for law in laws) else ScenarioCost(scenarios, tuple(laws))


def as_if_independent(laws: Iterable[CostLaw]) -> tuple[CostLaw, ...] | None:
    """Return the laws over all scenarios as if they had none in common; None where one has no list of outcomes."""
    found = [law.mixture if isinstance(law, ScenarioCost) else law for law in laws]
    return None if None in found else tuple(law for law in found if law is not None)


def sum_of(laws: Sequence[CostLaw]) -> CostLaw:
    """Return the sum of costs that are independent given each scenario; of one cost that cost itself."""
    if len(laws) == 1:
        return laws[0]
    return _in_each_scenario(laws, lambda given: CostSum(tuple(given)))


def total_of(laws: Iterable[CostLaw]) -> CostLaw:
    """Return the law of the sum of costs that are independent given each scenario; see `total_cost`.

    Where costs depend on scenarios it is the mixture of the totals given each of them, a `CostDistribution` if all are
    lists of outcomes.
    """
    total = total_by_scenario(laws)
    return total.mixture or total if isinstance(total, ScenarioCost) else total


def total_by_scenario(laws: Iterable[CostLaw]) -> CostLaw:
    """Return the law of the sum, as `total_of`, with its law given each scenario where it has several."""
    return _in_each_scenario(list(laws), total_cost)


def _in_each_scenario(laws: Sequence[CostLaw], summed: Callable[[Sequence[CostLaw]], CostLaw]) -> CostLaw:
    """Sum up the laws given each scenario; without costs that depend on scenarios, once."""
    scenarios = next((law.scenarios for law in laws if isinstance(law, ScenarioCost)), None)
    if scenarios is None:
        return summed(laws)
    return ScenarioCost(
        scenarios,
        tuple(
            summed([law.laws[index] if isinstance(law, ScenarioCost) else law for law in laws])
            for index in range(len(scenarios))
        ),
    )


def sampled_total(laws: Sequence[CostLaw], runs: int, generator: Generator) -> NDArray[float64]:
    """Draw so many sums of costs that are independent given each scenario."""
    import numpy

    total = _in_each_scenario(laws, lambda given: CostSum(tuple(given)))
    return total.sample(runs, generator) if laws else numpy.zeros(runs)
