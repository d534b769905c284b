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

    from statehtn.model.cost.scipy_law import ScipyCost

ASKED = 1e-6  # relative; an expectation that is less accurate is refused
TOLERANCE = 1e-12  # of a piece, relative to the whole
HALVINGS = 40  # of a piece in which the function jumps or bends
MOST_LEVEL = 6  # of a quadrature: a piece that needs more is halved
LEAST_TAIL = 1e-18  # of a discrete law; what is beyond does not count
AT_ONCE = 4096  # outcomes


def expectation(law: ScipyCost, function: Callable[[float], float]) -> float:
    """Return `E f(C)`, as the integral of `f(Q(u))` over the probabilities `u`, or as a sum for a discrete law.

    Quantiles are taken from both ends, since floats near 0 are fine and those near 1 are coarse. Pieces in which the
    quadrature is not sure are halved.

    Raises:
        InputError: the quadrature is not sure of 1e-6 of the result.
    """
    if law.is_discrete:
        return _sum(law, function)
    each = numpy.vectorize(function, otypes=[float])
    value, error, size = 0.0, 0.0, 0.0
    for quantile in (law.frozen.ppf, law.frozen.isf):
        starts, ends = numpy.array([0.0]), numpy.array([0.5])
        for halving in range(HALVINGS + 1):
            with scipy_call(law.title):
                found = tanhsinh(lambda u, at=quantile: each(at(u)), starts, ends, maxlevel=MOST_LEVEL)
            size = max(size, float(numpy.abs(found.integral).sum()))
            rough = ~(found.error <= TOLERANCE * size)
            if halving == HALVINGS:
                rough[:] = False
            value += math.fsum(found.integral[~rough])
            error += math.fsum(found.error[~rough])
            if not rough.any():
                break
            middles = (starts + ends)[rough] / 2
            starts, ends = numpy.append(starts[rough], middles), numpy.append(middles, ends[rough])
    if not error <= ASKED * size:
        raise InputError(
            f"{law.title}: the expected value of the function cannot be integrated well enough (found {value:g}, to "
            f"{error:.2g}); give outcomes or samples instead"
        )
    return value


def _sum(law: ScipyCost, function: Callable[[float], float]) -> float:
    terms = []
    first = law.least
    while first <= law.most and law.frozen.sf(first - 1) > LEAST_TAIL:
        costs = first + numpy.arange(min(AT_ONCE, law.most - first + 1))
        terms += [
            mass * function(cost) for cost, mass in zip(costs.tolist(), law.frozen.pmf(costs).tolist(), strict=True)
        ]
        first += AT_ONCE
    return math.fsum(terms)
