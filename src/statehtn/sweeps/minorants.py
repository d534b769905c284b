"""Lower bounds of certainty equivalents that hold for all averse agents of an interval at once, and add up.

Let `f(x) = x ln E[e^(C/x)]` be the certainty equivalent of a cost `C` at `alpha = 1/x`, with `f(0)` the largest cost.
Beside its sign, two things are known of it: it falls as x rises, from the largest cost to the mean; and it is convex,
for it is the perspective `x K(1/x)` of the convex function `K(a) = ln E[e^(a C)]`. So a tangent lies below f
everywhere, and a line through two of its points lies below f outside of them.

Give each law of a problem such a line on an interval [low, high] of x. A plan's certainty equivalent is the sum of
those of its actions, and so at least the sum of their lines, which is a line again. A line is nowhere below its chord
between `low` and `high`. So if `m` and `n` are the least costs of any plan at the prices that the lines have at `low`
and at `high` (two runs of A*), no plan has a certainty equivalent below the chord from `(low, m)` to `(high, n)`. The
error is quadratic in the width of the interval, where that of the bound `f(x) >= f(high)` is linear.

Prices must not be negative: where a tangent falls below 0 within the interval, one further up is taken.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

from statehtn.errors import InputError
from statehtn.model.cost.distribution import CostDistribution
from statehtn.model.cost.law import CostLaw
from statehtn.model.cost.sum import CostSum, TotalCost

ROUNDING = 2.0**-42  # of the terms that a tangent's value is the sum of; see `statehtn.core.pricing`
LEAST_SHARE = 0.25  # of the certainty equivalent, that a tangent must still have at the upper end
GROWTH = 1.5
STEP = 1 / 256  # of x, between the two points of a secant at least
DOUBLINGS = 64
HALVINGS = 12


def parts_of(law: CostLaw) -> Iterator[CostLaw]:
    """Yield independent laws whose sum is the law."""
    if isinstance(law, TotalCost):
        law = law.summands
    if isinstance(law, CostSum):
        for part in law.parts:
            yield from parts_of(part)
    else:
        yield law


def certainty_equivalent(law: CostLaw, x: float) -> float:
    """Return the certainty equivalent of a cost at `alpha = 1/x` of an averse agent; x may be 0 or infinite.

    Raises:
        InputError: it is infinite, or cannot be computed.
    """
    if x == 0:
        return law.most
    if math.isinf(x):
        return min(max(law.mean, law.least), law.most)
    return law.exponential_mean(1 / x)


def tilted_mean(law: CostDistribution, x: float) -> float:
    """Return `E[C e^(C/x)] / E[e^(C/x)]`, the slope of `ln E[e^(a C)]` at `a = 1/x`; x is positive."""
    most = law.most
    weights = [probability * math.exp((cost - most) / x) for probability, cost in law.outcomes]
    weighted = (weight * cost for weight, (_, cost) in zip(weights, law.outcomes, strict=True))
    return math.fsum(weighted) / math.fsum(weights)


def minorant(law: CostLaw, low: float, high: float, at: float) -> tuple[float, float]:
    """Return the values at both ends of an interval of x of a line below the certainty equivalent; never negative.

    Args:
        law: the law of the cost.
        low: the lower end, at least 0, in units of cost.
        high: the upper end, above it and finite.
        at: where the tangents of finite laws touch, within the interval.

    Raises:
        InputError: no averse agent has a finite price for it.
    """
    ends = [_minorant_of_part(part, low, high, at) for part in parts_of(law)]
    return math.fsum(end for end, _ in ends), math.fsum(end for _, end in ends)


def _minorant_of_part(law: CostLaw, low: float, high: float, at: float) -> tuple[float, float]:
    if law.least == law.most:
        return law.least, law.least
    if not isinstance(law, CostDistribution):
        return _secant(law, low, high)
    while True:
        ends = _tangent(law, low, high, at)
        if at == high or ends[1] >= LEAST_SHARE * law.mean:
            return ends
        at = min(high, max(at * GROWTH, high / 64))


def _tangent(law: CostDistribution, low: float, high: float, at: float) -> tuple[float, float]:
    """Return the values of the tangent that touches at a point; rounded down, at both ends by what its slope may be."""
    touching, lost = certainty_equivalent(law, at), 0.0
    if at == 0:  # the chance of the largest cost is all that counts
        fall = -math.log(law.outcomes[-1][0] / math.fsum(probability for probability, _ in law.outcomes))
    else:  # near 0 the two differ by little
        tilted = tilted_mean(law, at)
        fall, lost = max(0.0, tilted - touching) / at, ROUNDING * (tilted + touching) / at
    below, above = (at - low) * (fall - lost), (high - at) * (fall + lost)
    return touching + below - ROUNDING * (touching + abs(below)), touching - above - ROUNDING * (touching + above)


def _secant(law: CostLaw, low: float, high: float) -> tuple[float, float]:
    """Return the values of a line through two points at or beyond the upper end, for laws that tell no slope.

    Where the expectation is infinite at the upper end, the points lie where it is finite.
    """
    near = _least_finite(law, high)
    far = near + max((high - low) / 4, near * STEP)
    upper, lower = _bounds_at(law, near), _bounds_at(law, far)
    fall = max(0.0, upper[0] - lower[1]) / (far - near)
    at_high = max(0.0, upper[0] + (near - high) * fall) * (1 - ROUNDING)
    return at_high + (high - low) * fall * (1 - ROUNDING), at_high


def _bounds_at(law: CostLaw, x: float) -> tuple[float, float]:
    """Return bounds of the certainty equivalent, which may be integrated numerically."""
    value, error = certainty_equivalent(law, x), law.exponential_mean_error(1 / x)
    return value - error, value + error


def _least_finite(law: CostLaw, x: float) -> float:
    """Return x, or a point above it at which the certainty equivalent can be had; near the least of these."""
    infinite = x
    for _ in range(DOUBLINGS):
        if _is_finite(law, x):
            break
        infinite, x = x, max(2 * x, law.mean / DOUBLINGS)
    else:
        certainty_equivalent(law, x)  # raises what is wrong
    for _ in range(HALVINGS if x > infinite else 0):
        middle = (infinite + x) / 2
        infinite, x = (infinite, middle) if _is_finite(law, middle) else (middle, x)
    return x


def _is_finite(law: CostLaw, x: float) -> bool:
    try:
        return math.isfinite(certainty_equivalent(law, x))
    except InputError:
        return False
