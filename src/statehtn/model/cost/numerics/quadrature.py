"""Integrals over laws of `scipy.stats` that have no closed form, with the error that the quadrature tells.

They are taken by tanh-sinh quadrature (Takahasi and Mori, 1974; `scipy.integrate.tanhsinh`) of logarithms, piece by
piece between points where the integrand changes its size. The error is the sum of the estimates for the pieces.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy
from scipy.integrate import tanhsinh
from scipy.special import logsumexp
from scipy.stats import rv_continuous

from statehtn.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from numpy import float64
    from numpy.typing import NDArray

    from statehtn.model.cost.scipy_law import ScipyCost

    Logarithm = Callable[[NDArray[float64]], NDArray[float64]]

LEVELS = (1e-12, 1e-6, 1e-3, 0.05, 0.3, 0.7, 0.95, 0.999, 1 - 1e-6, 1 - 1e-12)
NEGLIGIBLE = 80.0  # pieces whose integrand is smaller by e^80 do not count
STEP = 20.0  # the logarithm of the integrand changes by no more within a piece
ROUNDS = 200
RATIO = 4.0  # of the ends of a piece in the tail
LOG_TOLERANCE = math.log(1e-12)
ROUNDING = 1e-12  # relative, of densities and sums
ACCURACY = 1e-9  # relative, that is asked of an integral
CDF_ERROR = 1e-8  # of distribution functions that scipy integrates from the density
AT_ONCE = 64
MOST_HALVINGS = 6  # of the probabilities
MOST_PIECES = 1024  # a density that needs more is not smooth in floats
HALVINGS = 45  # of a piece in which the density jumps or bends
HEAVY_POWER, LIGHT_POWER = 0.9, 1.05  # of x, in the exponent of a density: clearly below and above 1
LEAST_LOGARITHM = -800.0  # a density that is given as a logarithm goes below that; the logarithm of a float does not


def log_moment(law: ScipyCost, slope: float) -> tuple[float, float]:
    """Return `ln E[e^(slope (C - least))]`, finite by assumption, and a bound on its error.

    It is integrated over the density, or over the quantiles where floats are too coarse for the density: a bounded law
    may have much of its probability within a rounding error of an end. The error is what the quadratures tell.
    """
    is_bounded = slope < 0 or math.isfinite(law.most)  # the integrand
    if not (is_bounded and _is_blurred(law)):
        value, error = _log_moment_by_density(law, slope)
        if not is_bounded or error <= ACCURACY * abs(value):
            return value, error
    return log_moment_by_quantiles(law, slope)


def _is_blurred(law: ScipyCost) -> bool:
    """Tell whether probability lies so near to an end that no float is between."""
    beside = law.frozen.cdf(numpy.nextafter(law.least, math.inf))
    if math.isfinite(law.most):
        beside += law.frozen.sf(numpy.nextafter(law.most, -math.inf))
    return not beside <= ROUNDING


def _log_moment_by_density(law: ScipyCost, slope: float) -> tuple[float, float]:
    size = abs(slope)

    def growth(above: NDArray[float64]) -> NDArray[float64]:  # of |e^(slope x) - 1|, exact near 0
        return max(slope, 0) * above + numpy.log(-numpy.expm1(-size * above)) + _log_density(law, above)

    value, error = _log_integral(law, growth)
    if slope > 0:
        logarithm = math.log1p(math.exp(value)) if value < 0 else value + math.log1p(math.exp(-value))
        return logarithm, error * math.exp(value - logarithm)  # only the growth has an error
    if value < math.log(0.5):
        lost = math.exp(value)
        return math.log1p(-lost), error * lost / (1 - lost)
    return _log_integral(law, lambda above: slope * above + _log_density(law, above))


def log_moment_by_quantiles(law: ScipyCost, slope: float) -> tuple[float, float]:
    """Return what `log_moment` does, as the integral of `e^(slope (Q(u) - least))` over the probabilities `u`.

    The integrand is bounded by assumption: the slope is negative, or the law is bounded. Quantiles are taken from both
    ends, since floats near 0 are fine and those near 1 are coarse.
    """
    reach = law.most - law.least
    if slope > 0 and slope * reach > 1:  # from above, where most of it is
        value, error = _mean_over_quantiles(law, lambda above: numpy.exp(slope * (above - reach)))
        return slope * reach + math.log(value), error / value
    value, error = _mean_over_quantiles(law, lambda above: numpy.expm1(slope * above))
    if value > -0.5:
        return math.log1p(value), error / (1 + value)
    value, error = _mean_over_quantiles(law, lambda above: numpy.exp(slope * above))
    return math.log(value), error / value


def _mean_over_quantiles(law: ScipyCost, function: Logarithm) -> tuple[float, float]:
    """Return the mean of a function of the cost above the least one, which has one sign, and a bound on its error.

    Pieces are halved until the sum stays: quantiles may bend where a density jumps.
    """
    edges = numpy.array([0.0, 0.5])
    before = math.inf
    for _ in range(MOST_HALVINGS):
        halves = [
            tanhsinh(lambda u, quantile=quantile: function(quantile(u) - law.least), edges[:-1], edges[1:])
            for quantile in (law.frozen.ppf, law.frozen.isf)
        ]
        value = math.fsum(math.fsum(half.integral) for half in halves)
        error = math.fsum(math.fsum(half.error) for half in halves) + abs(value - before)
        if error <= ROUNDING * abs(value):
            break
        before = value
        edges = numpy.union1d(edges, (edges[:-1] + edges[1:]) / 2)
    if type(law.frozen.dist)._cdf is rv_continuous._cdf:
        error += CDF_ERROR * abs(value)
    return value, error + ROUNDING * abs(value)


def excess(law: ScipyCost, budget: float) -> float:
    """Return `E[max(C - budget, 0)]` of a continuous law."""
    start = max(budget, law.least)
    below = start - budget
    if start >= law.most:
        return below
    tail = law.exceedance(start)
    points = [float(law.frozen.isf(tail * part)) for part in (0.5, 0.1, 1e-3, 1e-6, 1e-10)]
    edges = numpy.unique([start, *(point for point in points if start < point < law.most), law.most])
    found = tanhsinh(law.frozen.sf, edges[:-1], edges[1:])
    return below + math.fsum(found.integral)


def excesses(law: ScipyCost, budgets: Sequence[float]) -> list[float]:
    """Return `E[max(C - budget, 0)]` of a continuous law for each of some ascending budgets."""
    edges = numpy.clip(budgets, law.least, law.most)
    between = tanhsinh(law.frozen.sf, edges[:-1], edges[1:]).integral
    above = numpy.append(numpy.cumsum(between[::-1])[::-1], 0.0) + excess(law, float(edges[-1]))
    return list(numpy.maximum(above + numpy.maximum(law.least - numpy.asarray(budgets), 0.0), 0.0).tolist())


def has_infinite_moment(law: ScipyCost, slope: float) -> bool:
    """Tell whether `E[e^(slope C)]` is infinite, from the density as far out as floats go.

    Raises:
        InputError: the density is not known so far out that it would tell.
    """
    if math.isfinite(law.most):
        return False
    unit = law.quantile(0.999) - law.least
    far = law.least + unit * 2.0 ** numpy.arange(1000)
    far = far[far < 1e300 / max(1.0, slope)]
    density = law.frozen.logpdf(far)
    known = numpy.isfinite(density)
    last = int(numpy.flatnonzero(known)[-1]) if known.any() else 0
    rises = bool(slope * far[last] + density[last] + math.log(far[last]) > 0)
    if last == len(far) - 1 or density[last] < LEAST_LOGARITHM:
        return rises
    # The density has fallen below the smallest float: like e^(-x^power), as far as it is known.
    power = math.log2(density[last] / density[last - 1]) if last > 0 and density[last - 1] < 0 else 0.0
    if power > LIGHT_POWER:
        return False
    if power < HEAVY_POWER and rises:
        return True
    raise InputError(
        f"{law.title}: its density is not known far enough to tell whether E[e^(alpha C)] is finite for alpha = "
        f"{slope:g}; truncate it, or give outcomes or samples"
    )


def _log_density(law: ScipyCost, above: NDArray[float64]) -> NDArray[float64]:
    return numpy.asarray(law.frozen.logpdf(law.least + above))


def _log_integral(law: ScipyCost, function: Logarithm) -> tuple[float, float]:
    """Return the logarithm of the integral of e^function over the law's range above its least cost, and its error.

    The error is relative to the integral.
    """
    edges = _edges(law, function)
    starts, ends = edges[:-1], edges[1:]
    values, errors = numpy.empty(0), numpy.empty(0)
    for halving in range(HALVINGS + 1):
        found, uncertain = _in_pieces(function, starts, ends)
        size = logsumexp(numpy.concatenate([values, found]))
        is_rough = ~(uncertain <= size + LOG_TOLERANCE)  # also where it is no number
        if halving == HALVINGS or numpy.count_nonzero(is_rough) > MOST_PIECES:
            is_rough[:] = False
        values = numpy.concatenate([values, found[~is_rough]])
        errors = numpy.concatenate([errors, uncertain[~is_rough]])
        if not is_rough.any():
            break
        middles = (starts + ends)[is_rough] / 2
        starts = numpy.concatenate([starts[is_rough], middles])
        ends = numpy.concatenate([middles, ends[is_rough]])
    value, error = float(logsumexp(values)), float(logsumexp(errors))
    if math.isnan(value) or math.isnan(error):
        return value, math.inf
    return value, ROUNDING + math.exp(min(error - value, 0.0))


def _in_pieces(
    function: Logarithm, starts: NDArray[float64], ends: NDArray[float64]
) -> tuple[NDArray[float64], NDArray[float64]]:
    """Return the logarithms of integrals and of their errors; a few at a time, so that memory is bounded."""
    found = [
        tanhsinh(function, starts[first : first + AT_ONCE], ends[first : first + AT_ONCE], log=True, rtol=LOG_TOLERANCE)
        for first in range(0, len(starts), AT_ONCE)
    ]
    return (
        numpy.concatenate([piece.integral.real for piece in found]),
        numpy.concatenate([piece.error.real for piece in found]),
    )


def _edges(law: ScipyCost, function: Logarithm) -> NDArray[float64]:
    """Return the ends of pieces in which the function changes little, and outside of which it is negligible."""
    inner = [law.quantile(level) - law.least for level in LEVELS]
    if math.isfinite(law.most):
        end = law.most - law.least
    else:
        end = inner[-1]
        while function(numpy.array([2 * end]))[0] > function(numpy.array([end]))[0] - NEGLIGIBLE and end < 1e300:
            end *= 2
        end *= 2
    inner += [inner[-1] * RATIO**power for power in range(1, math.ceil(math.log(end / inner[-1], RATIO)))]
    edges = numpy.unique([0.0, *(point for point in inner if 0 < point < end), end])
    for _ in range(ROUNDS):
        middles = (edges[:-1] + edges[1:]) / 2
        sizes = function(numpy.concatenate([edges, middles]))
        left, right, middle = sizes[: len(edges) - 1], sizes[1 : len(edges)], sizes[len(edges) :]
        inside = numpy.stack([left, middle, right])
        finite = numpy.where(numpy.isfinite(inside), inside, numpy.nan)
        high, low = numpy.nanmax(finite, axis=0), numpy.nanmin(finite, axis=0)
        split = (high - low > STEP) & (high > numpy.nanmax(high) - NEGLIGIBLE) & (middles > edges[:-1])
        if not split.any() or len(edges) > MOST_PIECES:
            break
        edges = numpy.unique(numpy.concatenate([edges, middles[split]]))
    if numpy.isneginf(right[-1]) and math.isinf(law.most):  # the density of a far cost is no float any more
        sizes = function(edges)
        finite = sizes[numpy.isfinite(sizes)]
        if finite[-1] > finite.max() - NEGLIGIBLE / 2:
            raise InputError(f"{law.title}: its density is not known as far as its certainty equivalent needs it")
    return edges
