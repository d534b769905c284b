"""The outcomes of a sum of independent costs: exact while they are few, on a grid with a known error beyond."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterator, Sequence
from fractions import Fraction
from typing import TYPE_CHECKING

from statehtn.errors import InputError
from statehtn.model.cost.distribution import CostDistribution
from statehtn.model.cost.law import CostLaw
from statehtn.model.fraction import fraction_of

if TYPE_CHECKING:
    from numpy import float64
    from numpy.typing import NDArray

MOST_TOTALS = 20_000
"""As long as no partial sum has more outcomes, the convolution is exact ..."""
MOST_PAIRS = 4_000_000
"""... and not more pairs of outcomes are added up on the way, one by one, ..."""
MOST_BYTES = 5_000_000_000
"""... or not more bytes of weights, where all possible totals are so few that each has a place: some seconds."""
CELLS = 2**16
"""Of the grid that is taken beyond."""
TAIL = 1e-10
"""The probability at the upper end of an unbounded cost that the grid leaves out."""
NOISE = 1e-16  # what a fast Fourier transform leaves where there is nothing


def exact_total(laws: Sequence[CostDistribution]) -> CostDistribution | None:
    """Return the sum of finite laws in exact arithmetic, None where it is too large.

    A float stands for a fraction (see `fraction_of`); probabilities are scaled to sum to 1. Costs are integers over a
    common denominator, probabilities integers over the product of the sums of each law.
    """
    costs = [[fraction_of(cost) for _, cost in law.outcomes] for law in laws]
    unit = math.lcm(*(cost.denominator for row in costs for cost in row))
    steps = [[int(cost * unit) for cost in row] for row in costs]
    weights = [_integers([fraction_of(probability) for probability, _ in law.outcomes]) for law in laws]
    totals = _packed_totals(steps, weights) or _listed_totals(steps, weights)
    if totals is None:
        return None
    whole = math.prod(map(sum, weights))
    try:
        outcomes = [(weight / whole, total / unit) for total, weight in totals.items()]
    except OverflowError:
        raise InputError("the total cost is too large for a floating-point number") from None
    return CostDistribution.of(outcomes)


def _packed_totals(steps: Sequence[Sequence[int]], weights: Sequence[Sequence[int]]) -> dict[int, int] | None:
    """Return the weight of every total, None where totals lie too far apart for this, or there is too much to do.

    The weights of all totals up to now stand beside each other in one large integer, in a field of the same width for
    every total that could be, so that one multiplication and one shift add an outcome to all of them. It is Kronecker's
    substitution for the product of polynomials; no field overflows, since no weight exceeds the product of all sums.
    The widest summands come last: until then the integer is short.
    """
    least = sum(row[0] for row in steps)
    span = sum(row[-1] for row in steps) - least
    width = (math.prod(map(sum, weights)).bit_length() + 7) // 8
    if span >= MOST_TOTALS or span * width * sum(map(len, steps)) > MOST_BYTES:
        return None
    packed = 1
    for _, row in sorted((row[-1][0], row) for row in _powers(steps, weights)):
        packed = sum((packed * factor) << (8 * width * step) for step, factor in row)
    fields = packed.to_bytes((span + 1) * width, "little")
    found = (int.from_bytes(fields[place * width : (place + 1) * width], "little") for place in range(span + 1))
    return {least + place: weight for place, weight in enumerate(found) if weight}


def _powers(steps: Sequence[Sequence[int]], weights: Sequence[Sequence[int]]) -> Iterator[list[tuple[int, int]]]:
    """Yield the uncertain summands, each with its steps above the least one and their weights.

    Equal ones of two outcomes, as long plans have many, are one: their sum is binomial.
    """
    equal = Counter(zip(map(tuple, steps), map(tuple, weights), strict=True))
    for (row, factors), count in equal.items():
        if len(row) == 2:
            apart, (low, high) = row[1] - row[0], factors
            yield [(apart * n, math.comb(count, n) * low ** (count - n) * high**n) for n in range(count + 1)]
        elif len(row) > 2:
            one = [(step - row[0], factor) for step, factor in zip(row, factors, strict=True)]
            yield from [one] * count


def _listed_totals(steps: Sequence[Sequence[int]], weights: Sequence[Sequence[int]]) -> dict[int, int] | None:
    """Return the weight of every total, one pair of outcomes after the other; None where they are too many."""
    totals, pairs = {0: 1}, 0
    for row, factors in zip(steps, weights, strict=True):
        pairs += len(totals) * len(row)
        if len(row) > 1 and pairs > MOST_PAIRS:
            return None
        found: dict[int, int] = {}
        for total, weight in totals.items():
            for step, factor in zip(row, factors, strict=True):
                found[total + step] = found.get(total + step, 0) + weight * factor
        totals = found
        if len(totals) > MOST_TOTALS:
            return None
    return totals


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
