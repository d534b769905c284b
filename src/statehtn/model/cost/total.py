"""The outcomes of a sum of independent costs: exact while they are few, on a grid with a known error beyond."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Sequence
from fractions import Fraction
from typing import TYPE_CHECKING

from statehtn.errors import InputError
from statehtn.model.cost.distribution import CostDistribution
from statehtn.model.cost.law import CostLaw

if TYPE_CHECKING:
    from numpy import float64
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


def exact_total(laws: Sequence[CostDistribution]) -> CostDistribution | None:
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


def grid_total(uncertain: Sequence[CostLaw], least: float, most: float) -> tuple[CostDistribution, float, float, float]:
    """Return the sum on a grid, and its error: that of a cost, the probability and the mean cost that are cut off.

    Finite costs are rounded to multiples of the cell's width above their least one; what a continuous cost has in a
    cell stands in the cell's middle. The bound on the error is the sum of what was moved at most.

    Args:
        uncertain: those of the costs that are not certain.
        least: the least sum of all.
        most: the largest one.
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
                cut_cost += count * law.expected_overrun(tops[law])
        else:
            masses, low, high = _rounded_masses(law, width)
        transform *= numpy.fft.rfft(masses, CELLS) ** count
        down += count * low
        up += count * high
    masses = numpy.fft.irfft(transform, CELLS)
    masses[masses < NOISE] = 0
    masses /= masses.sum()
    costs = least + (down + up) / 2 + width * numpy.arange(CELLS)
    costs = numpy.clip(costs, least, most)  # which is nearer to the truth
    kept = masses > 0
    grid = CostDistribution.of(zip(masses[kept].tolist(), costs[kept].tolist(), strict=True))
    error = (up - down) / 2 + 1e-15 * float(costs[kept][-1])
    return grid, error, cut_probability, cut_cost


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
