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

from statehtn.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy import float64
    from numpy.typing import NDArray

    from statehtn.model.scipy_cost import ScipyCost

    Logarithm = Callable[[NDArray[float64]], NDArray[float64]]

LEVELS = (1e-12, 1e-6, 1e-3, 0.05, 0.3, 0.7, 0.95, 0.999, 1 - 1e-6, 1 - 1e-12)
NEGLIGIBLE = 80.0  # pieces whose integrand is smaller by e^80 do not count
STEP = 20.0  # the logarithm of the integrand changes by no more within a piece
ROUNDS = 200
RATIO = 4.0  # of the ends of a piece in the tail
LOG_TOLERANCE = math.log(1e-12)
ROUNDING = 1e-12  # relative, of densities and sums
HALVINGS = 45  # of a piece in which the density jumps or bends
HEAVY_POWER, LIGHT_POWER = 0.9, 1.05  # of x, in the exponent of a density: clearly below and above 1
LEAST_LOGARITHM = -800.0  # a density that is given as a logarithm goes below that; the logarithm of a float does not


def log_moment(law: ScipyCost, slope: float) -> tuple[float, float]:
    """Return `ln E[e^(slope (C - least))]`, finite by assumption, and a bound on its error."""
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
    with numpy.errstate(all="ignore"):
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
        f"{law}: its density is not known far enough to tell whether E[e^(alpha C)] is finite for alpha = {slope:g}; "
        f"truncate it, or give outcomes or samples"
    )


def _log_density(law: ScipyCost, above: NDArray[float64]) -> NDArray[float64]:
    return numpy.asarray(law.frozen.logpdf(law.least + above))


def _log_integral(law: ScipyCost, function: Logarithm) -> tuple[float, float]:
    """Return the logarithm of the integral of e^function over the law's range above its least cost, and its error.

    The error is relative to the integral.
    """
    with numpy.errstate(all="ignore"):
        edges = _edges(law, function)
        starts, ends = edges[:-1], edges[1:]
        values, errors = numpy.empty(0), numpy.empty(0)
        for halving in range(HALVINGS + 1):
            found = tanhsinh(function, starts, ends, log=True, rtol=LOG_TOLERANCE)
            size = logsumexp(numpy.concatenate([values, found.integral.real]))
            is_rough = (found.error.real > size + LOG_TOLERANCE) & (halving < HALVINGS)
            values = numpy.concatenate([values, found.integral.real[~is_rough]])
            errors = numpy.concatenate([errors, found.error.real[~is_rough]])
            if not is_rough.any():
                break
            middles = (starts + ends)[is_rough] / 2
            starts = numpy.concatenate([starts[is_rough], middles])
            ends = numpy.concatenate([middles, ends[is_rough]])
        value, error = logsumexp(values), logsumexp(errors)
    return float(value), ROUNDING + float(math.exp(min(error - value, 0.0)))


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
        if not split.any():
            break
        edges = numpy.unique(numpy.concatenate([edges, middles[split]]))
    if numpy.isneginf(right[-1]) and math.isinf(law.most):  # the density of a far cost is no float any more
        sizes = function(edges)
        finite = sizes[numpy.isfinite(sizes)]
        if finite[-1] > finite.max() - NEGLIGIBLE / 2:
            raise InputError(f"{law}: its density is not known as far as its certainty equivalent needs it")
    return edges
