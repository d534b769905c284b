"""Costs that are sums of independent parts which no short list of outcomes states."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

from statehtn.model.cost.law import PLOT_POINTS, CostLaw

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
        """The law of the sum: exact, or on a grid with bounds on its error; see `statehtn.model.cost.total`."""
        from statehtn.model.cost.total import total_cost

        return total_cost(self.parts)

    @property
    def mean(self) -> float:
        """The expected cost."""
        return math.fsum(part.mean for part in self.parts)

    @property
    def standard_deviation(self) -> float:
        """The standard deviation of the cost."""
        return math.hypot(*(part.standard_deviation for part in self.parts))

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

    def exponential_mean(self, slope: float) -> float:
        """Return `ln E[e^(slope C)] / slope`, the sum of those of the parts."""
        return math.fsum(part.exponential_mean(slope) for part in self.parts)

    def exponential_mean_error(self, slope: float) -> float:
        """Return the error of `exponential_mean` beyond rounding."""
        return math.fsum(part.exponential_mean_error(slope) for part in self.parts)

    def sample(self, runs: int, generator: Generator) -> NDArray[float64]:
        """Draw so many independent costs with a generator of numpy."""
        return sampled_sum(self.parts, runs, generator)

    def curve(self, points: int = PLOT_POINTS) -> tuple[list[float], list[float]]:
        """Return ascending costs, and the probability of each or less, for a drawing."""
        return self.total.curve(points)

    def __str__(self) -> str:
        if len(self.parts) > MOST_SHOWN:
            return f"{len(self.parts)} independent parts, from {self.least:g} to {self.most:g}"
        return " + ".join(map(str, self.parts))


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
