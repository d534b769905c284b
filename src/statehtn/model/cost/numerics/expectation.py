"""Expected values of functions of a cost with a law of `scipy.stats`."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy
from scipy.integrate import tanhsinh

from statehtn.errors import InputError
from statehtn.model.cost.scipy_call import scipy_call

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy import float64
    from numpy.typing import NDArray

    from statehtn.model.cost.scipy_law import ScipyCost

ASKED = 1e-6  # relative; an expectation that is less accurate is refused
TOLERANCE = 1e-12  # of a piece, relative to the whole
HALVINGS = 40  # of a piece in which the function jumps or bends
MOST_LEVEL = 6  # of a quadrature: a piece that needs more is halved
LEAST_TAIL = 1e-18  # of a discrete law; what is beyond does not count
AT_ONCE = 64  # outcomes; twice as many the next time


def expectation(law: ScipyCost, function: Callable[[float], float]) -> float:
    """Return `E f(C)` for a function of one number; see `integrated`."""
    if law.is_discrete:
        return _sum(law, function)
    return integrated(law, numpy.vectorize(function, otypes=[float]))


def integrated(law: ScipyCost, each: Callable[[NDArray[float64]], NDArray[float64]]) -> float:
    """Return `E f(C)`, as the integral of `f(Q(u))` over the probabilities `u`, for a function of arrays.

    Quantiles are taken from both ends, since floats near 0 are fine and those near 1 are coarse. Pieces are halved
    until their integrals are the sums of those of their halves.

    Raises:
        InputError: the quadrature is not sure of 1e-6 of the result.
    """
    value, error, size = 0.0, 0.0, 0.0
    for quantile in (law.frozen.ppf, law.frozen.isf):
        starts, ends = numpy.array([0.0]), numpy.array([0.5])
        whole = _in_pieces(law, quantile, each, starts, ends)
        for halving in range(HALVINGS + 1):
            middles = (starts + ends) / 2
            starts, ends = numpy.stack([starts, middles]), numpy.stack([middles, ends])
            halves = _in_pieces(law, quantile, each, starts.ravel(), ends.ravel()).reshape(starts.shape)
            difference = numpy.abs(halves.sum(axis=0) - whole)
            size = max(size, float(numpy.abs(halves).sum()))
            rough = ~(difference <= TOLERANCE * size)
            if halving == HALVINGS:
                rough[:] = False
            value += math.fsum(halves[:, ~rough].ravel())
            error += math.fsum(difference[~rough])
            if not rough.any():
                break
            starts, ends, whole = starts[:, rough].ravel(), ends[:, rough].ravel(), halves[:, rough].ravel()
    if not error <= ASKED * size:
        raise InputError(
            f"{law.title}: the expected value of the function cannot be integrated well enough (found {value:g}, to "
            f"{error:.2g}); give outcomes or samples instead"
        )
    return value


def _in_pieces(
    law: ScipyCost,
    quantile: Callable[[NDArray[float64]], NDArray[float64]],
    each: Callable[[NDArray[float64]], NDArray[float64]],
    starts: NDArray[float64],
    ends: NDArray[float64],
) -> NDArray[float64]:
    with scipy_call(law.title):
        return numpy.asarray(tanhsinh(lambda u: each(quantile(u)), starts, ends, maxlevel=MOST_LEVEL).integral)


def _sum(law: ScipyCost, function: Callable[[float], float]) -> float:
    terms: list[float] = []
    first, count = law.least, AT_ONCE
    while first <= law.most and law.frozen.sf(first - 1) > LEAST_TAIL:
        costs = first + numpy.arange(min(count, law.most - first + 1))
        masses = law.frozen.pmf(costs)
        terms += (mass * function(cost) for cost, mass in zip(costs.tolist(), masses.tolist(), strict=True))
        first, count = first + count, 2 * count
    return math.fsum(terms)
