"""Sums of independent costs, and what is asked of them: the law of the total, exact or on a grid."""

from __future__ import annotations

import math
from bisect import bisect_left
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import accumulate
from typing import TYPE_CHECKING, Any, overload

from statehtn.model.cost.distribution import CostDistribution
from statehtn.model.cost.law import MOST_DRAWN, PLOT_POINTS, CostLaw
from statehtn.model.cost.numerics.sums import sum_of_positive
from statehtn.model.cost.total import exact_total, grid_total

if TYPE_CHECKING:
    from numpy import float64
    from numpy.random import Generator
    from numpy.typing import NDArray


MOST_SHOWN = 5  # parts; more are summed up


@dataclass(frozen=True, repr=False)
class CostSum(CostLaw):
    """The sum of independent costs: one of them is continuous, or together they have many outcomes.

    Mean, standard deviation and exponential means are sums over the parts, as exact as those. Probabilities, quantiles
    and the CVaR come from `total`, which is worked out when it is asked for.
    """

    parts: tuple[CostLaw, ...]

    @cached_property
    def total(self) -> CostLaw:
        """The law of the sum: exact, or on a grid with bounds on its error; see `total_cost`."""
        return total_cost(self.parts)

    @cached_property
    def _counted(self) -> tuple[tuple[CostLaw, int], ...]:
        """Different parts, and how often each is there: long plans have few laws."""
        return tuple(Counter(self.parts).items())

    @property
    def mean(self) -> float:
        """The expected cost."""
        return math.fsum(part.mean for part in self.parts)

    @property
    def standard_deviation(self) -> float:
        """The standard deviation of the cost."""
        return math.hypot(*(part.standard_deviation for part in self.parts))

    @property
    def variance(self) -> float:
        """The variance of the cost, the sum of those of the parts; infinite where a float cannot hold it."""
        return sum_of_positive(part.variance for part in self.parts)

    @property
    def least(self) -> float:
        """The least cost that is possible."""
        return math.fsum(part.least for part in self.parts)

    @property
    def most(self) -> float:
        """The largest cost that is possible; may be infinite."""
        return math.fsum(part.most for part in self.parts)

    def cdf(self, cost: float) -> float:
        """Return the probability of paying at most `cost`."""
        return self.total.cdf(cost)

    def exceedance(self, budget: float) -> float:
        """Return the probability of paying more than `budget`."""
        return self.total.exceedance(budget)

    def quantile(self, probability: float) -> float:
        """Return the least budget that is kept with at least this probability."""
        return self.total.quantile(probability)

    def cvar(self, level: float) -> float:
        """Return the mean cost of the worst `1 - level` of all cases."""
        return self.total.cvar(level)

    def expectation(self, function: Callable[[float], float]) -> float:
        """Return the expected value of a function of the cost, from the law of the sum."""
        return self.total.expectation(function)

    def exponential_mean(self, slope: float) -> float:
        """Return `ln E[e^(slope C)] / slope`, the sum of those of the parts."""
        return math.fsum(count * part.exponential_mean(slope) for part, count in self._counted)

    def exponential_mean_error(self, slope: float) -> float:
        """Return the error of `exponential_mean` beyond rounding."""
        return math.fsum(part.exponential_mean_error(slope) for part in self.parts)

    def to_scipy(self) -> Any:
        """Return the law of the sum as a frozen distribution of `scipy.stats`: discrete where it is on a grid."""
        return self.total.to_scipy()

    def sample(self, runs: int, generator: Generator) -> NDArray[float64]:
        """Draw so many independent costs with a generator of numpy."""
        return sampled_sum(self.parts, runs, generator)

    def curve(self, points: int = PLOT_POINTS) -> tuple[list[float], list[float]]:
        """Return ascending costs, and the probability of each or less, for a drawing."""
        return self.total.curve(points)

    def __str__(self) -> str:
        shown = [part for part in self.parts if part.most != 0] or self.parts[:1]
        if len(shown) > MOST_SHOWN:
            return f"{len(shown)} independent parts, from {self.least:g} to {self.most:g}"
        return " + ".join(map(str, shown))


@dataclass(frozen=True, slots=True, repr=False)
class TotalCost(CostDistribution):
    """The law of a sum of independent costs on a grid: its outcomes stand for all costs near them.

    There is a grid variable `G` with these outcomes and the true cost `C` on one probability space, such that `C` and
    `G` differ by at most `cost_error`, but for an event of at most `cut_probability`, in which `C` may be larger, by
    `cut_cost` in the mean over all cases. So quantiles of `C` are within `cost_error` of those of `G` at the same
    probability (from above: at one that is higher by `cut_probability`), and `CVaR(p)` is within
    `cost_error + cut_cost / (1 - p)`. Probabilities are rounded to about 1e-13.

    Mean, standard deviation, exponential means and samples are those of the sum itself, not of the grid.

    Args:
        summands: the sum.
        cost_error: in the domain's unit.
        cut_probability: 0 where all costs are bounded.
        cut_cost: the expected cost beyond the cut, in the domain's unit.
    """

    summands: CostSum
    cost_error: float
    cut_probability: float = 0.0
    cut_cost: float = 0.0

    @property
    def mean(self) -> float:
        """The expected cost, in the domain's unit."""
        return self.summands.mean

    @property
    def standard_deviation(self) -> float:
        """The standard deviation of the cost, in the domain's unit."""
        return self.summands.standard_deviation

    @property
    def variance(self) -> float:
        """The variance of the cost, in the square of the domain's unit."""
        return self.summands.variance

    @property
    def least(self) -> float:
        """The least cost that is possible."""
        return self.summands.least

    @property
    def most(self) -> float:
        """The largest cost that is possible; may be infinite."""
        return self.summands.most

    def exponential_mean(self, slope: float) -> float:
        """Return `ln E[e^(slope C)] / slope`, the sum of those of the parts."""
        return self.summands.exponential_mean(slope)

    def exponential_mean_error(self, slope: float) -> float:
        """Return the error of `exponential_mean` beyond rounding."""
        return self.summands.exponential_mean_error(slope)

    def sample(self, runs: int, generator: Generator) -> NDArray[float64]:
        """Draw so many independent costs with a generator of numpy."""
        return self.summands.sample(runs, generator)

    def curve(self, points: int = PLOT_POINTS) -> tuple[list[float], list[float]]:
        """Return ascending costs, and the probability of each or less, for a drawing; its far end is left out."""
        near = bisect_left(list(accumulate(probability for probability, _ in self.outcomes)), MOST_DRAWN)
        return CostDistribution(self.outcomes[: near + 1]).curve(points)

    def __str__(self) -> str:
        return f"a mean of {self.mean:g}, from {self.least:g} to {self.most:g} (each cost to {self.cost_error:.2g})"


@overload
def total_cost(laws: Iterable[CostDistribution]) -> CostDistribution: ...
@overload
def total_cost(laws: Iterable[CostLaw]) -> CostLaw: ...
def total_cost(laws: Iterable[CostLaw]) -> CostLaw:
    """Return the law of the sum of independent costs.

    It is a `CostDistribution`, exact but for one rounding of each probability and cost, where all costs are finite
    lists of outcomes and no partial sum has more than `MOST_TOTALS` different totals (nor takes too long: `MOST_PAIRS`,
    `MOST_BYTES`); the cost itself where there is one; a `TotalCost` otherwise.
    """
    parts = list(parts_of(law.summands if isinstance(law, TotalCost) else law for law in laws))
    certain = [part for part in parts if part.least == part.most]
    uncertain = [part for part in parts if part.least != part.most]
    if len(uncertain) == 1 and all(part.least == 0 for part in certain):
        return uncertain[0]
    finite = [part for part in parts if isinstance(part, CostDistribution)]
    exact = exact_total(finite) if len(finite) == len(parts) else None
    return exact or on_grid(CostSum(tuple(parts)), uncertain)


def on_grid(summands: CostSum, uncertain: Sequence[CostLaw]) -> TotalCost:
    """Return a sum on a grid; see `total_cost`."""
    grid, *error = grid_total(uncertain, summands.least, summands.most)
    return TotalCost(grid.outcomes, summands, *error)


def parts_of(laws: Iterable[CostLaw]) -> Iterator[CostLaw]:
    """Yield the parts of which the sum of independent laws consists."""
    for law in laws:
        if isinstance(law, CostSum):
            yield from parts_of(law.parts)
        else:
            yield law


def sampled_sum(laws: Iterable[CostLaw], runs: int, generator: Generator) -> NDArray[float64]:
    """Draw so many sums of independent costs."""
    import numpy

    total = numpy.zeros(runs)
    for law in laws:
        total += law.sample(runs, generator)
    return total
