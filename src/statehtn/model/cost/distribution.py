"""Costs with finitely many outcomes."""

from __future__ import annotations

import math
from bisect import bisect_left
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from itertools import accumulate
from operator import mul
from typing import TYPE_CHECKING, Any

from statehtn.counted import likely
from statehtn.errors import InputError, UsageError
from statehtn.expected import expect, number, shown, shown_number, whole_number
from statehtn.model.cost.law import PLOT_POINTS, CostLaw, checked_function, checked_probability
from statehtn.model.cost.numerics.exponential_mean import exponential_mean_of
from statehtn.model.cost.numerics.sums import sum_of_positive

if TYPE_CHECKING:
    from numpy import float64
    from numpy.random import Generator
    from numpy.typing import NDArray

    from statehtn.model.cost.sampled import SampledCost

PROBABILITY_TOLERANCE = 1e-9
ROUNDING = 1e-12  # of sums of probabilities, which are compared with a level that was asked for
MOST_SHOWN = 5  # longer lists are summed up


@dataclass(frozen=True, slots=True, repr=False)
class CostDistribution(CostLaw):
    """The probability distribution of a cost with finitely many outcomes: pairs (probability, cost), sorted by cost.

    Probabilities are positive and sum to 1 within 1e-9; costs are finite, at least 0 and distinct.
    Make one by `CostDistribution.of` (which merges and checks), `certain`, `from_samples`, `from_counts` or
    `from_scipy`.
    Source: the `c(o)` of the paper's Definition 4.4 (cost-variable operator), with the sign turned.
    """

    outcomes: tuple[tuple[float, float], ...]

    @staticmethod
    def certain(cost: float) -> CostDistribution:
        """Return the distribution of a cost that is known."""
        return CostDistribution.of([(1.0, number(cost, "a cost"))])

    @staticmethod
    def of(outcomes: Iterable[tuple[float, float]]) -> CostDistribution:
        """Merge outcomes of equal cost, drop impossible ones, and check the rest.

        Raises:
            InputError: a probability is negative or not finite, a cost is negative or not finite,
                or the probabilities do not sum to 1.
            UsageError: these are no pairs of numbers.
        """
        try:
            return CostDistribution(checked_outcomes(outcomes))
        except (TypeError, ValueError, OverflowError):
            raise UsageError(_no_outcomes(outcomes)) from None

    @staticmethod
    def from_samples(data: Iterable[float], *, most: float | None = None) -> SampledCost:
        """Return the empirical distribution of costs that were observed: each as likely as it was frequent.

        It is level 3 of the paper's section 2.1: what is possible is known, how likely it is comes from data. The
        result knows how far its risk costs may be off (`SampledCost.risk_cost_bounds`).

        Args:
            data: independent observations of the cost, at least one, in any order; arrays of numpy will do.
            most: the largest cost that is possible at all, where it is known; error bounds upwards need it.

        Raises:
            InputError: there are no data, one is no finite number of at least 0, or one is above `most`.
        """
        from statehtn.model.cost.sampled import sampled_cost

        return sampled_cost(data, most)

    @staticmethod
    def from_counts(counts: Mapping[float, float], prior: float | Mapping[float, float] = 1.0) -> CostDistribution:
        """Return the posterior predictive distribution of the next cost, from counts and a Dirichlet prior.

        An outcome seen `n` times with a prior weight of `a` has probability `(n + a) / (N + A)`, where `N` and `A` are
        the sums over all outcomes. It is level 4 of the paper's section 2.1: probabilities are beliefs. Source: Gelman
        et al., *Bayesian Data Analysis*, section 3.4. An action that a plan has twice is taken as two independent
        draws.

        Args:
            counts: how often each cost was seen; 0 for one that is possible.
            prior: the weight of each outcome before any was seen, in observations: one number for all (1: all equally
                likely; 0: the frequencies), or a number for each cost, which may be one that was never seen.

        Raises:
            InputError: a count or a weight is negative, or all are 0; a cost is negative or not finite.
        """
        from statehtn.model.cost.sampled import posterior_predictive

        return posterior_predictive(counts, prior)

    @staticmethod
    def from_scipy(distribution: Any) -> CostLaw:
        """Return the law of a frozen distribution of `scipy.stats`, such as `scipy.stats.gamma(2, scale=3)`.

        Returns a `CostDistribution` for a discrete one with finitely many outcomes, and a `ScipyCost` for others.

        Raises:
            InputError: it is none, its parameters are out of range, it can be negative, or its mean is infinite.
            UnsupportedError: it is discrete with infinitely many outcomes, and not Poisson, geometric or negative
                binomial.
        """
        from statehtn.model.cost.scipy_law import law_of

        return law_of(distribution)

    @staticmethod
    def pert(least: float, likely: float, most: float) -> CostLaw:
        """Return the PERT law of three estimates: optimistic, likely, pessimistic.

        It is a beta law between `least` and `most` whose mode is `likely` and whose mean is
        `(least + 4 likely + most) / 6`. Source: Malcolm, Roseboom, Clark and Fazar, *Application of a technique for
        research and development program evaluation*, 1959; Vose, *Risk Analysis*, 2000.

        Args:
            least: at least 0, in the domain's unit.
            likely: the most likely cost; not outside of the two others.
            most: the largest cost. Where all three are equal, the cost is certain.

        Raises:
            InputError: the estimates are out of order, negative or not finite.
            UsageError: an estimate is no number, or scipy is not installed.
        """
        from statehtn.model.cost.scipy_law import pert

        return pert(
            number(least, "the least cost"), number(likely, "the likely cost"), number(most, "the largest cost")
        )

    @property
    def mean(self) -> float:
        """The expected cost, in the domain's unit."""
        return math.fsum(map(mul, *zip(*self.outcomes, strict=True)))

    @property
    def standard_deviation(self) -> float:
        """The standard deviation of the cost, in the domain's unit."""
        mean = self.mean
        return math.hypot(*(math.sqrt(probability) * (cost - mean) for probability, cost in self.outcomes))

    @property
    def variance(self) -> float:
        """The variance of the cost, in the square of the domain's unit; infinite where a float cannot hold it."""
        mean = self.mean
        return sum_of_positive(probability * (cost - mean) * (cost - mean) for probability, cost in self.outcomes)

    @property
    def least(self) -> float:
        """The least cost that is possible."""
        return self.outcomes[0][1]

    @property
    def most(self) -> float:
        """The largest cost that is possible."""
        return self.outcomes[-1][1]

    def cdf(self, cost: float) -> float:
        """Return the probability of paying at most `cost`."""
        number(cost, "a cost")
        return min(1.0, math.fsum(probability for probability, outcome in self.outcomes if outcome <= cost))

    def exceedance(self, budget: float) -> float:
        """Return the probability of paying more than `budget`."""
        number(budget, "a budget")
        return min(1.0, math.fsum(probability for probability, outcome in self.outcomes if outcome > budget))

    def quantile(self, probability: float) -> float:
        """Return the least outcome that is not exceeded with at least this probability, to 1e-12 of it.

        Raises:
            UsageError: the probability is not between 0 and 1.
        """
        if checked_probability(probability, "the probability of a quantile") == 1:
            return self.most
        probabilities, costs = zip(*self.outcomes, strict=True)
        wanted = probability - ROUNDING
        first = bisect_left(range(len(costs)), wanted, key=lambda index: math.fsum(probabilities[: index + 1]))
        return costs[min(first, len(costs) - 1)]  # type: ignore[no-any-return]

    def cvar(self, level: float) -> float:
        """Return the mean cost of the worst `1 - level` of all cases.

        Raises:
            UsageError: the level is not between 0 and 1.
        """
        tail = 1 - checked_probability(level, "the level of the CVaR")
        if tail <= ROUNDING:
            return self.most
        probabilities, costs = zip(*self.outcomes, strict=True)
        first = bisect_left(range(len(costs)), -tail, key=lambda index: -math.fsum(probabilities[index:]))
        weights = list(probabilities[first:])
        if first > 0:  # of the next outcome as much as the tail has left
            weights.insert(0, tail - math.fsum(weights))
            first -= 1
        mean = math.fsum(map(mul, weights, costs[first:])) / math.fsum(weights)
        return min(max(mean, self.least), self.most)

    def exponential_mean(self, slope: float) -> float:
        """Return `ln E[e^(slope C)] / slope`, between the least and the largest outcome."""
        slope = number(slope, "the slope")
        probabilities, costs = zip(*self.outcomes, strict=True)
        mean = min(max(self.mean, self.least), self.most)
        return exponential_mean_of(probabilities, costs, mean, slope)

    def exponential_mean_error(self, slope: float) -> float:  # noqa: ARG002
        """Return 0: it is exact but for rounding."""
        return 0.0

    def expectation(self, function: Callable[[float], float]) -> float:
        """Return the expected value of a function of the cost, as a sum over the outcomes."""
        called = checked_function(function)
        return math.fsum(probability * called(cost) for probability, cost in self.outcomes)

    def to_scipy(self) -> Any:
        """Return the law as a frozen discrete distribution of `scipy.stats`.

        Raises:
            UsageError: scipy is not installed.
        """
        try:
            from scipy.stats import rv_discrete
        except ImportError:
            raise UsageError("laws of scipy.stats need the package 'scipy': pip install 'statehtn[scipy]'") from None
        probabilities, costs = zip(*self.outcomes, strict=True)
        total = math.fsum(probabilities)
        return rv_discrete(name="outcomes", values=(costs, [probability / total for probability in probabilities]))()

    def sample(self, runs: int, generator: Generator) -> NDArray[float64]:
        """Draw so many independent costs with a generator of numpy."""
        import numpy

        table = numpy.array(self.outcomes)
        return generator.choice(table[:, 1], size=runs, p=table[:, 0] / table[:, 0].sum())

    def convolve(self, other: CostDistribution) -> CostDistribution:
        """Return the distribution of the sum of two independent costs."""
        expect(other, CostDistribution, "expected a CostDistribution")
        return CostDistribution.of((p * q, c + d) for p, c in self.outcomes for q, d in other.outcomes)

    def curve(self, points: int = PLOT_POINTS) -> tuple[list[float], list[float]]:
        """Return ascending costs, and the probability of each or less, for a drawing in at most so many steps."""
        costs, heights = [cost for _, cost in self.outcomes], list(accumulate(p for p, _ in self.outcomes))
        step = max(1, math.ceil(len(costs) / max(1, whole_number(points, "the number of points"))))
        last = len(costs) - 1
        shown = sorted({*range(0, last, step), last})
        return [costs[0], *(costs[index] for index in shown)], [0.0, *(heights[index] for index in shown)]

    def __str__(self) -> str:
        if len(self.outcomes) == 1:
            return f"{self.outcomes[0][1]:g}"
        if len(self.outcomes) > MOST_SHOWN:
            return f"{len(self.outcomes)} outcomes from {self.least:g} to {self.most:g}"
        return ", ".join(f"{cost:g} w.p. {likely(probability, digits=6)}" for probability, cost in self.outcomes)


def _no_outcomes(given: object) -> str:
    """Return what is wrong with outcomes that are no pairs of numbers."""
    write = "write pairs (probability, cost), such as CostDistribution.of([(0.8, 2), (0.2, 6)])"
    if isinstance(given, Mapping):
        pairs = ", ".join(f"({probability!r}, {cost!r})" for cost, probability in list(given.items())[:3])
        write = f"write pairs (probability, cost); if its keys are the costs: CostDistribution.of([{pairs}])"
    elif isinstance(given, Iterable) and not isinstance(given, str):
        write += "; costs that were observed: CostDistribution.from_samples(...)"
    return f"expected the outcomes of a cost, found {shown(given)}; {write}"


def checked_outcomes(outcomes: Iterable[tuple[float, float]]) -> tuple[tuple[float, float], ...]:
    """Return outcomes as a `CostDistribution` has them; for its errors see `CostDistribution.of`."""
    merged: dict[float, float] = {}
    for probability, cost in outcomes:
        if not 0 <= probability <= 1 + PROBABILITY_TOLERANCE:
            raise InputError(f"a probability must be between 0 and 1, found {probability:g}")
        if not (math.isfinite(cost) and cost >= 0):
            raise InputError(f"a cost must be a finite number and at least 0, found {cost:g}")
        if probability > 0:
            merged[cost] = merged.get(cost, 0.0) + probability
    total = math.fsum(merged.values())
    if abs(total - 1) > PROBABILITY_TOLERANCE:
        raise InputError(f"the probabilities of a cost must sum to 1, found {shown_number(total)}")
    return tuple((merged[cost], float(cost)) for cost in sorted(merged))
