"""Exponential means of lists of outcomes, without overflow and with little lost to rounding."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from numpy import float64
    from numpy.typing import NDArray

LARGEST_EXPONENT = 700.0  # below it, exp and expm1 of a float do not overflow
MANY = 500  # outcomes, beyond which arrays are faster than lists
LEAST_CURVATURE = 1e-17  # a smaller slope * (range of the cost) changes no digit of the mean


def exponential_mean_of(probabilities: Sequence[float], costs: Sequence[float], mean: float, slope: float) -> float:
    """Return `ln(sum p e^(slope c) / sum p) / slope`, which is at least the mean for a positive slope.

    Args:
        probabilities: positive, of the costs.
        costs: sorted.
        mean: of the costs; the limit for a slope that tends to 0.
        slope: not 0, per unit of cost.
    """
    least, largest = costs[0], costs[-1]
    curvature = abs(slope) * (largest - least)
    if curvature < LEAST_CURVATURE:
        return mean
    if not math.isfinite(curvature):
        return largest if slope > 0 else least
    if len(costs) > MANY:
        logarithm = _log_mean_exp_of_many(probabilities, costs, slope)
    else:
        logarithm = _log_mean_exp(probabilities, [slope * (cost - least) for cost in costs])
    value = least + logarithm / slope
    # Rounding must not carry the value across its bounds.
    return min(max(value, mean), largest) if slope > 0 else min(max(value, least), mean)


def _log_mean_exp(probabilities: Sequence[float], exponents: Sequence[float]) -> float:
    """Return `ln(sum p e^x / sum p)` for exponents of one sign, one of them 0, without overflow or cancellation."""
    total = math.fsum(probabilities)
    if max(exponents) <= LARGEST_EXPONENT:
        # All terms have one sign, so the sum is exact to rounding however small it is; so is log1p away from -1.
        growth = math.fsum(p * math.expm1(x) for p, x in zip(probabilities, exponents, strict=True)) / total
        if growth > -0.5:
            return math.log1p(growth)
    logs = [math.log(p) + x for p, x in zip(probabilities, exponents, strict=True)]
    largest = max(logs)
    return largest + math.log(math.fsum(math.exp(value - largest) for value in logs) / total)


def _log_mean_exp_of_many(probabilities: Sequence[float], costs: Sequence[float], slope: float) -> float:
    """Return what `_log_mean_exp` does for the exponents `slope (c - c_0)`; the elements by numpy, the sums exactly."""
    import numpy

    weights = numpy.array(probabilities)
    exponents = slope * (numpy.array(costs) - costs[0])
    if exponents.max() <= LARGEST_EXPONENT:
        growth = _sum(weights * numpy.expm1(exponents)) / _sum(weights)
        if growth > -0.5:
            return math.log1p(growth)
    logs = numpy.log(weights) + exponents
    largest = float(logs.max())
    return largest + math.log(_sum(numpy.exp(logs - largest)) / _sum(weights))


def _sum(values: NDArray[float64]) -> float:
    return math.fsum(values.tolist())
