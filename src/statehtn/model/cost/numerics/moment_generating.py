"""Exponential means of laws of `scipy.stats`: by the moment generating function where it has a closed form.

A closed form gives `ln E[e^(s Z)]` of the family's standard variable `Z` (`loc` 0, `scale` 1), infinite where the
expectation is, to a few units in the last place also for `s` near 0. With `C = loc + scale Z` it is
`ln E[e^(t C)] = t loc + closed_form(t scale)`. Source: Johnson, Kotz and Balakrishnan, *Continuous Univariate
Distributions*, and Johnson, Kemp and Kotz, *Univariate Discrete Distributions*.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from functools import lru_cache
from types import MappingProxyType
from typing import TYPE_CHECKING

from statehtn.errors import InputError, UsageError
from statehtn.model.cost.infinite import InfiniteMean
from statehtn.model.cost.scipy_call import scipy_call

if TYPE_CHECKING:
    from statehtn.model.cost.scipy_law import ScipyCost

Shapes = Mapping[str, float]
ClosedForm = Callable[[Shapes, float], "float | None"]
ACCURACY = 1e-9  # of an exponential mean, in units of itself, that is asked of a quadrature
SERIES = 1e-3  # below it, the series of a uniform law is better than the formula


def _uniform(_: Shapes, s: float) -> float:
    if abs(s) < SERIES:
        return s / 2 + s * s / 24 - s**4 / 2880
    if s > 0:
        return s + math.log(-math.expm1(-s) / s)
    return math.log(math.expm1(s) / s)


def _gamma(shape: float, s: float) -> float:
    return -shape * math.log1p(-s) if s < 1 else math.inf


def _inverse_gaussian(shapes: Shapes, s: float) -> float:
    mu = shapes["mu"]
    inside = 1 - 2 * mu * mu * s
    return 2 * mu * s / (1 + math.sqrt(inside)) if inside >= 0 else math.inf


def _truncated_normal(low: float, high: float, s: float) -> float | None:
    """Return None near 0, where the formula takes the difference of nearly equal numbers."""
    if abs(s) < 0.1:
        return None
    return s * s / 2 + _log_normal_mass(low - s, high - s) - _log_normal_mass(low, high)


def _log_normal_mass(low: float, high: float) -> float:
    """Return the logarithm of the probability that a standard normal variable lies between two numbers."""
    from scipy.special import log_ndtr

    if low > 0:
        low, high = -high, -low
    whole, missing = float(log_ndtr(high)), float(log_ndtr(low))
    return whole + math.log1p(-math.exp(missing - whole)) if missing < whole else -math.inf


def _poisson(shapes: Shapes, s: float) -> float:
    return shapes["mu"] * _expm1(s)


def _geometric(shapes: Shapes, s: float) -> float:
    return s + _failures(shapes["p"], s)


def _negative_binomial(shapes: Shapes, s: float) -> float:
    return shapes["n"] * _failures(shapes["p"], s)


def _failures(p: float, s: float) -> float:
    """Return the closed form for the number of failures before the first success."""
    ratio = (1 - p) / p * _expm1(s)
    return -math.log1p(-ratio) if ratio < 1 else math.inf


def _expm1(s: float) -> float:
    try:
        return math.expm1(s)
    except OverflowError:
        return math.inf


CLOSED_FORMS: Mapping[str, ClosedForm] = MappingProxyType(
    {
        "uniform": _uniform,
        "expon": lambda _, s: _gamma(1.0, s),
        "gamma": lambda shapes, s: _gamma(shapes["a"], s),
        "erlang": lambda shapes, s: _gamma(shapes["a"], s),
        "chi2": lambda shapes, s: _gamma(shapes["df"] / 2, 2 * s),
        "invgauss": _inverse_gaussian,
        "truncnorm": lambda shapes, s: _truncated_normal(shapes["a"], shapes["b"], s),
        "halfnorm": lambda _, s: _truncated_normal(0.0, math.inf, s),
        "poisson": _poisson,
        "geom": _geometric,
        "nbinom": _negative_binomial,
    }
)
"""By the family's name in `scipy.stats`; None where the formula is not accurate."""


@lru_cache(maxsize=4096)
def exponential_mean(law: ScipyCost, slope: float) -> tuple[float, float]:
    """Return `ln E[e^(slope C)] / slope`, and a bound on its error beyond rounding (0 for a closed form).

    Args:
        law: the law of C.
        slope: finite and not 0, per unit of cost.

    Raises:
        InputError: the expectation is infinite, or it cannot be computed well enough.
    """
    if slope == 0 or not math.isfinite(slope):
        raise UsageError(f"the slope of an exponential mean must be finite and not 0, found {slope:g}")
    value, error = _closed_form(law, slope) or _integrated(law, slope)
    if math.isinf(value):
        raise InfiniteMean(
            f"{law.title}: E[e^(alpha C)] is infinite, or too large, for alpha = {slope:g}, so that no certain cost is "
            f"as bad to a risk-averse agent; take a smaller alpha where that helps, or bound the cost (a truncated "
            f"law, samples)"
        )
    value = min(max(value, law.mean), law.most) if slope > 0 else min(max(value, law.least), law.mean)
    if not error <= ACCURACY * max(value, abs(value - law.least)):
        raise InputError(
            f"{law.title}: its certainty equivalent for alpha = {abs(slope):g} cannot be integrated well enough "
            f"(found {value:g}, to {error:.2g}); give outcomes or samples instead"
        )
    return value, error


def _closed_form(law: ScipyCost, slope: float) -> tuple[float, float] | None:
    if law.family not in CLOSED_FORMS or law.identity is not None:
        return None
    shapes = {name: value for name, value in law.parameters if not isinstance(value, tuple)}
    value = CLOSED_FORMS[law.family](shapes, slope * law.scale)
    return None if value is None else (law.shift + value / slope, 0.0)


def _integrated(law: ScipyCost, slope: float) -> tuple[float, float]:
    """Integrate over the standard variable: near `loc` floats are coarse, near 0 they are not."""
    from statehtn.model.cost.numerics.quadrature import has_infinite_moment, log_moment

    standard, standard_slope = law.standard, slope * law.scale
    with scipy_call(law.title):
        if slope > 0 and has_infinite_moment(standard, standard_slope):
            return math.inf, 0.0
        value, error = log_moment(standard, standard_slope)
    return law.least + value / slope, error / abs(slope)
