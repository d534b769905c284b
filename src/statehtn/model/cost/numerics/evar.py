"""The entropic value at risk of any law whose exponential means are known."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from statehtn.model.cost.infinite import InfiniteMean

if TYPE_CHECKING:
    from collections.abc import Callable

    from statehtn.model.cost.law import CostLaw

GOLDEN = (3 - math.sqrt(5)) / 2
ACCURACY = 3e-8  # of the logarithm of the minimiser; what the minimum loses is its square, relative to the range
SMALLEST = 1e-18  # a minimiser that is smaller by this factor than the largest one changes no digit of the minimum
DOUBLINGS = 200
NEARBY = math.log(4)  # so far around a point the logarithm of the minimiser is looked for


def entropic_value_at_risk(law: CostLaw, level: float) -> float:
    """Return the infimum over all `a > 0` of `ln E[e^(a C)] / a + ln(1 / (1 - level)) / a`, to about 1e-14 of it.

    Args:
        law: of the cost.
        level: above 0 and below 1.

    Raises:
        InfiniteMean: `E[e^(a C)]` is infinite for every `a > 0` that was tried.
        InputError: an exponential mean cannot be computed.
    """
    return least_bound(law, level)[0]


def least_bound(law: CostLaw, level: float, near: float = 0.0, accuracy: float = ACCURACY) -> tuple[float, float]:
    """Return the same, and the `x = 1 / a` at which it is had; 0 where it is the largest cost.

    In `x` it is convex: the perspective of the logarithm of the moment generating function, which is convex, plus a
    line. It tends to the largest cost at 0, and is at least `mean + x ln(1 / (1 - level))`, which bounds the minimiser.
    Brent's method for `ln x` finds it.

    Source: Brent, *Algorithms for minimization without derivatives*, 1973, chapter 5.

    Args:
        law: as above.
        level: as above.
        near: where to look first; 0 for nowhere.
        accuracy: of `ln x`.
    """
    least, most, divergence = law.least, law.most, -math.log1p(-level)
    if least == most:
        return most, 0.0

    def bound(logarithm: float) -> float:
        x = math.exp(logarithm)
        try:
            return law.exponential_mean(1 / x) + divergence * x
        except InfiniteMean:
            return math.inf

    mean = law.mean
    found = None if near <= 0 else _least_near(bound, math.log(near), accuracy)
    if found is None:
        highest = (most if math.isfinite(most) else _some_bound(law, bound)) - mean
        if highest <= 0:  # the range is a rounding error
            return most, 0.0
        high = math.log(highest / divergence)
        found = _least(bound, high + math.log(SMALLEST), high, accuracy)
    value, at = found
    return (most, 0.0) if most <= value else (max(value, mean), math.exp(at))


def _some_bound(law: CostLaw, bound: Callable[[float], float]) -> float:
    """Return the bound for some `x` of an unbounded law where it is finite."""
    unit = law.mean - law.least
    for doubling in range(DOUBLINGS):
        if math.isfinite(value := bound(math.log(unit) + doubling * math.log(2))):
            return value
    raise InfiniteMean(
        f"{law}: E[e^(alpha C)] is infinite for every alpha, and so is the entropic value at risk; bound the cost (a "
        f"truncated law, samples), or take the CVaR"
    )


def _least_near(function: Callable[[float], float], near: float, accuracy: float) -> tuple[float, float] | None:
    """Return what `_least` does near a point; None where it is not to be found there."""
    value, at = _least(function, near - NEARBY, near + NEARBY, accuracy)
    return (value, at) if math.isfinite(value) and abs(at - near) < NEARBY - 2 * accuracy else None


def _least(function: Callable[[float], float], low: float, high: float, accuracy: float) -> tuple[float, float]:
    """Return the least value found of a function that falls, perhaps from infinity, and then rises; and where.

    The next point is where a parabola through the three best ones is least; or, where that is no progress, the golden
    section of the longer part.
    """
    best = second = third = low + GOLDEN * (high - low)
    at_best = at_second = at_third = function(best)
    step = before = high - low
    while max(best - low, high - best) > accuracy:
        before, last = step, before
        middle = (low + high) / 2
        step = GOLDEN * ((low if best > middle else high) - best)
        if math.isfinite(at_third) and best != second != third:
            to_vertex = _to_vertex(best - second, at_best - at_second, best - third, at_best - at_third)
            if abs(to_vertex) < abs(last) / 2 and low < best + to_vertex < high:
                is_near_end = min(best + to_vertex - low, high - best - to_vertex) < accuracy
                step = math.copysign(accuracy / 3, middle - best) if is_near_end else to_vertex
        if abs(step) < accuracy / 3:
            step = math.copysign(accuracy / 3, step)
        point = best + step
        value = function(point)
        if value <= at_best:
            low, high = (best, high) if point >= best else (low, best)
            third, second, best = second, best, point
            at_third, at_second, at_best = at_second, at_best, value
        else:
            low, high = (point, high) if point < best else (low, point)
            if value <= at_second or second == best:
                third, second, at_third, at_second = second, point, at_second, value
            elif value <= at_third or third in (best, second):
                third, at_third = point, value
    return at_best, best


def _to_vertex(to_best: float, rise: float, to_best_too: float, rise_too: float) -> float:
    """Return the way from the best point to the vertex of the parabola through it and two others; else infinity.

    Args:
        to_best: the way from one of the others to it.
        rise: of the function on this way.
        to_best_too: the way from the other one.
        rise_too: likewise.
    """
    one, other = to_best * rise_too, to_best_too * rise
    denominator = 2 * (other - one)
    return (to_best * one - to_best_too * other) / denominator if denominator else math.inf
