"""The entropic value at risk of any law whose exponential means are known."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from statehtn.model.cost.infinite import InfiniteMean

if TYPE_CHECKING:
    from collections.abc import Callable

    from statehtn.model.cost.law import CostLaw

GOLDEN = (math.sqrt(5) - 1) / 2
ACCURACY = 3e-8  # of the logarithm of the minimiser; what the minimum loses is its square, relative to the range
SMALLEST = 1e-18  # a minimiser that is smaller by this factor than the largest one changes no digit of the minimum
DOUBLINGS = 200


def entropic_value_at_risk(law: CostLaw, level: float) -> float:
    """Return the infimum over all `a > 0` of `ln E[e^(a C)] / a + ln(1 / (1 - level)) / a`, to about 1e-14 of it.

    In `x = 1 / a` it is convex: the perspective of the logarithm of the moment generating function, which is convex,
    plus a line. It tends to the largest cost at 0, and is at least `mean + x ln(1 / (1 - level))`, which bounds the
    minimiser. A golden-section search for `ln x` finds it (Kiefer, 1953).

    Args:
        law: of the cost.
        level: above 0 and below 1.

    Raises:
        InfiniteMean: `E[e^(a C)]` is infinite for every `a > 0` that was tried.
        InputError: an exponential mean cannot be computed.
    """
    least, most, divergence = law.least, law.most, -math.log1p(-level)
    if least == most:
        return most

    def bound(logarithm: float) -> float:
        x = math.exp(logarithm)
        try:
            return law.exponential_mean(1 / x) + divergence * x
        except InfiniteMean:
            return math.inf

    mean = law.mean
    highest = (most if math.isfinite(most) else _some_bound(law, bound)) - mean
    if highest <= 0:  # the range is a rounding error
        return most
    high = math.log(highest / divergence)
    return max(min(_least(bound, high + math.log(SMALLEST), high), most), mean)


def _some_bound(law: CostLaw, bound: Callable[[float], float]) -> float:
    """Return the bound for some `x` of an unbounded law where it is finite."""
    unit = max(law.mean - law.least, law.quantile(0.9) - law.least)
    for doubling in range(DOUBLINGS):
        if math.isfinite(value := bound(math.log(unit) + doubling * math.log(2))):
            return value
    raise InfiniteMean(
        f"{law}: E[e^(alpha C)] is infinite for every alpha, and so is the entropic value at risk; bound the cost (a "
        f"truncated law, samples), or take the CVaR"
    )


def _least(function: Callable[[float], float], low: float, high: float) -> float:
    """Return the least value found of a function that falls, perhaps from infinity, and then rises."""
    left, right = high - GOLDEN * (high - low), low + GOLDEN * (high - low)
    at_left, at_right = function(left), function(right)
    best = min(at_left, at_right)
    while high - low > ACCURACY:
        if at_left < at_right:
            high, right, at_right = right, left, at_left
            left = high - GOLDEN * (high - low)
            at_left = function(left)
        else:
            low, left, at_left = left, right, at_right
            right = low + GOLDEN * (high - low)
            at_right = function(right)
        best = min(best, at_left, at_right)
    return best
