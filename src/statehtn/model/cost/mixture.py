"""Costs that have one of several laws, by chance."""

from __future__ import annotations

import math
from abc import abstractmethod
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from operator import mul
from typing import TYPE_CHECKING, Any

from statehtn.errors import UnsupportedError
from statehtn.expected import number
from statehtn.model.cost.distribution import CostDistribution
from statehtn.model.cost.law import CostLaw, checked_probability
from statehtn.model.cost.numerics.exponential_mean import exponential_mean_of

if TYPE_CHECKING:
    from numpy import float64
    from numpy.random import Generator
    from numpy.typing import NDArray

HALVINGS = 200  # of an interval of costs: beyond what a float tells apart


class Mixed(CostLaw):
    """What all mixtures have in common: one of the `laws` is drawn, with probabilities `weights`, then the cost."""

    laws: tuple[CostLaw, ...]

    @property
    @abstractmethod
    def weights(self) -> tuple[float, ...]:
        """The probability of each law."""

    @cached_property
    def mixture(self) -> CostDistribution | None:
        """The mixture as a list of outcomes; None where one of the laws is none."""
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
        weighted = ((math.sqrt(weight), law) for weight, law in zip(self.weights, self.laws, strict=True))
        return math.hypot(
            *(x for root, law in weighted for x in (root * law.standard_deviation, root * (law.mean - mean)))
        )

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
        """Return `ln E[e^(slope C)] / slope`, from those of the laws."""
        slope = number(slope, "the slope")
        pairs = sorted(zip((law.exponential_mean(slope) for law in self.laws), self.weights, strict=True))
        costs, weights = zip(*pairs, strict=True)
        mean = math.fsum(map(mul, weights, costs)) / math.fsum(weights)
        return exponential_mean_of(weights, costs, min(max(mean, costs[0]), costs[-1]), slope)

    def exponential_mean_error(self, slope: float) -> float:
        """Return the error of `exponential_mean` beyond rounding: at most the largest of one of the laws."""
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
            UnsupportedError: one of its laws is no list of outcomes.
        """
        if self.mixture is None:
            raise UnsupportedError(
                f"scipy.stats has no mixtures, such as {self}; ask for the laws that it mixes: law.laws"
            )
        return self.mixture.to_scipy()

    def sample(self, runs: int, generator: Generator) -> NDArray[float64]:
        """Draw so many independent costs, each of a law drawn anew, with a generator of numpy."""
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
            return f"a mixture of {len(self.laws)} laws, from {self.least:g} to {self.most:g}"
        return str(self.mixture)


@dataclass(frozen=True, repr=False)
class Mixture(Mixed):
    """A mixture of laws.

    Args:
        probabilities: of the laws, in their order; they sum to 1.
        laws: not all of them lists of outcomes (`mixture_of`).
    """

    probabilities: tuple[float, ...]
    laws: tuple[CostLaw, ...]

    @property
    def weights(self) -> tuple[float, ...]:
        """The probability of each law."""
        return self.probabilities


def mixture_of(weights: Sequence[float], laws: Sequence[CostLaw]) -> CostLaw:
    """Return the law of a cost that has one of several laws by chance: a list of outcomes where they all are lists.

    Args:
        weights: how likely each law is, in proportion.
        laws: at least one.
    """
    first = laws[0]
    if all(law is first or law == first for law in laws):
        return first
    total = math.fsum(weights)
    mixture = Mixture(tuple(weight / total for weight in weights), tuple(laws))
    return mixture.mixture or mixture
