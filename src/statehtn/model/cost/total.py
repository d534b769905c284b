"""The law of a sum of independent costs: exact while it has few outcomes, on a grid with a known error beyond."""

from __future__ import annotations

import math
from bisect import bisect_left
from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import accumulate
from typing import TYPE_CHECKING, overload

from statehtn.errors import InputError
from statehtn.model.cost.distribution import CostDistribution
from statehtn.model.cost.law import MOST_DRAWN, PLOT_POINTS, CostLaw
from statehtn.model.cost.sum import CostSum, parts_of

if TYPE_CHECKING:
    from numpy import float64
    from numpy.random import Generator
    from numpy.typing import NDArray

MOST_TOTALS = 20_000
"""As long as no partial sum has more outcomes, the convolution is exact ..."""
MOST_PAIRS = 4_000_000
"""... and not more pairs of outcomes are added up on the way."""
CELLS = 2**16
"""Of the grid that is taken beyond."""
TAIL = 1e-10
"""The probability at the upper end of an unbounded cost that the grid leaves out."""
NOISE = 1e-16  # what a fast Fourier transform leaves where there is nothing


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
    lists of outcomes and no partial sum has more than `MOST_TOTALS` different totals (nor takes more than `MOST_PAIRS`
    additions in all); the cost itself where there is one; a `TotalCost` otherwise.
    """
    parts = list(parts_of(law.summands if isinstance(law, TotalCost) else law for law in laws))
    certain = [part for part in parts if part.least == part.most]
    uncertain = [part for part in parts if part.least != part.most]
    if len(uncertain) == 1 and all(part.least == 0 for part in certain):
        return uncertain[0]
    finite = [part for part in parts if isinstance(part, CostDistribution)]
    exact = _convolution(finite) if len(finite) == len(parts) else None
    return exact or _on_grid(CostSum(tuple(parts)), uncertain)


def _convolution(laws: Sequence[CostDistribution]) -> CostDistribution | None:
    """Return the sum of finite laws in exact arithmetic, None where it is too large.

    A float means the decimal that it prints as; probabilities are scaled to sum to 1. Costs are integers over a common
    denominator, probabilities integers over the product of the sums of each law.
    """
    costs = [[Fraction(repr(cost)) for _, cost in law.outcomes] for law in laws]
    unit = math.lcm(*(cost.denominator for row in costs for cost in row))
    totals, whole, pairs = {0: 1}, 1, 0
    for law, row in zip(laws, costs, strict=True):
        pairs += len(totals) * len(row)
        if len(row) > 1 and pairs > MOST_PAIRS:
            return None
        weights = _integers([Fraction(repr(probability)) for probability, _ in law.outcomes])
        whole *= sum(weights)
        steps = list(zip((int(cost * unit) for cost in row), weights, strict=True))
        found: dict[int, int] = {}
        for total, weight in totals.items():
            for cost, factor in steps:
                found[total + cost] = found.get(total + cost, 0) + weight * factor
        totals = found
        if len(totals) > MOST_TOTALS:
            return None
    try:
        outcomes = [(weight / whole, total / unit) for total, weight in totals.items()]
    except OverflowError:
        raise InputError("the total cost is too large for a floating-point number") from None
    return CostDistribution.of(outcomes)


def _integers(fractions: Sequence[Fraction]) -> list[int]:
    """Return the smallest integers in the same proportions."""
    unit = math.lcm(*(value.denominator for value in fractions))
    whole = [int(value * unit) for value in fractions]
    common = math.gcd(*whole)
    return [value // common for value in whole]


def _on_grid(summands: CostSum, uncertain: Sequence[CostLaw]) -> TotalCost:
    """Return the sum on a grid.

    Finite costs are rounded to multiples of the cell's width above their least one; what a continuous cost has in a
    cell stands in the cell's middle. The bound on the error is the sum of what was moved at most.
    """
    import numpy

    from statehtn.model.cost.scipy_law import ScipyCost

    tops = {law: law.quantile(1 - TAIL) if math.isinf(law.most) else law.most for law in uncertain}
    width = math.fsum(tops[law] - law.least for law in uncertain) / (CELLS - 2 * len(uncertain) - 2)
    transform = numpy.ones(CELLS // 2 + 1, dtype=complex)
    down = up = cut_probability = cut_cost = 0.0
    for law, count in Counter(uncertain).items():
        if isinstance(law, ScipyCost):
            masses = law.masses(width, math.ceil((tops[law] - law.least) / width))
            low, high = 0.0, width
            if math.isinf(law.most):
                cut_probability += count * law.exceedance(tops[law])
                cut_cost += count * law.excess(tops[law])
        else:
            masses, low, high = _rounded_masses(law, width)
        transform *= numpy.fft.rfft(masses, CELLS) ** count
        down += count * low
        up += count * high
    masses = numpy.fft.irfft(transform, CELLS)
    masses[masses < NOISE] = 0
    masses /= masses.sum()
    costs = summands.least + (down + up) / 2 + width * numpy.arange(CELLS)
    costs = numpy.clip(costs, summands.least, summands.most)  # which is nearer to the truth
    kept = masses > 0
    outcomes = CostDistribution.of(zip(masses[kept].tolist(), costs[kept].tolist(), strict=True)).outcomes
    error = (up - down) / 2 + 1e-15 * float(costs[kept][-1])
    return TotalCost(outcomes, summands, error, cut_probability, cut_cost)


def _rounded_masses(law: CostLaw, width: float) -> tuple[NDArray[float64], float, float]:
    """Return the probability of every multiple of the width, and how far true costs are above it: from, to."""
    import numpy

    assert isinstance(law, CostDistribution)
    table = numpy.array(law.outcomes)
    above = table[:, 1] - law.least
    cells = numpy.rint(above / width).astype(int)
    moved = above - cells * width
    masses = numpy.asarray(numpy.bincount(cells, weights=table[:, 0]), dtype=float)
    return masses, float(moved.min()), float(moved.max())
