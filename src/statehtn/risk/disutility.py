"""Disutilities of a total cost that are a linear term and exponentials, and the certain cost that is as bad as a law.

The disutility of a cost C is `linear C`, plus `e^(log_weight + slope C)` for every term of positive slope, minus that
for every term of negative slope: it rises with C. Its expectation follows from the mean and from the exponential
means of the law, one for each slope, and these add up over independent costs. So a plan has one sum for each of them,
however many actions it has.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple, Protocol

from statehtn.model.cost.law import CostLaw
from statehtn.risk.neutral import expected_cost


class Term(NamedTuple):
    """One exponential of a disutility: `e^(log_weight + slope C)` with the sign of the slope.

    Args:
        slope: not 0, per unit of cost; positive where risk is shunned, negative where it is sought.
        log_weight: the natural logarithm of its weight, which a float might not hold.
    """

    slope: float
    log_weight: float


class FiniteObjective(Protocol):
    """An objective that is the certain cost as bad as a law to an agent with such a disutility."""

    @property
    def linear(self) -> float:
        """The weight of the cost itself, at least 0."""
        ...

    @property
    def terms(self) -> tuple[Term, ...]:
        """The exponentials, each slope once."""
        ...


def certainty_equivalent(linear: float, terms: Sequence[Term], law: CostLaw) -> float:
    """Return the certain cost whose disutility is the expected disutility of a law.

    With the mean `k_0` and the exponential means `k_j` it is the zero of a sum of rising functions, each of which has
    its own zero at `k_0` or `k_j`: so it lies between the least and the largest of them, where it is bisected to the
    last bit.

    Args:
        linear: at least 0; above 0, if there are no terms.
        terms: the exponentials.
        law: of the total cost.

    Raises:
        InputError: an exponential mean is infinite, or cannot be computed.
    """
    parts = [(Term(0.0, math.log(linear)), expected_cost(law))] if linear > 0 else []
    parts += [(term, law.exponential_mean(term.slope)) for term in terms]
    low, high = min(mean for _, mean in parts), max(mean for _, mean in parts)
    while low < (middle := low + (high - low) / 2) < high:
        if _is_above(middle, parts):
            high = middle
        else:
            low = middle
    return middle


def _is_above(cost: float, parts: Sequence[tuple[Term, float]]) -> bool:
    """Tell whether the disutility of a certain cost exceeds the expected one.

    Every part contributes `e^(log_weight) (e^(slope cost) - e^(slope mean))` with the sign of `cost - mean`. Sizes are
    compared as logarithms, relative to the largest: a float would neither hold e^(slope cost) nor a weight.
    """
    sizes = [
        (math.copysign(1.0, cost - mean), size)
        for term, mean in parts
        if (size := _log_difference(term, cost, mean)) > -math.inf
    ]
    largest = max((size for _, size in sizes), default=0.0)
    return math.fsum(sign * math.exp(size - largest) for sign, size in sizes) > 0


def _log_difference(term: Term, cost: float, mean: float) -> float:
    """Return the logarithm of how much the part's disutility of a cost differs from its expected one."""
    if term.slope == 0:
        difference = abs(cost - mean)
        return term.log_weight + math.log(difference) if difference > 0 else -math.inf
    lost = -math.expm1(-abs(term.slope * (cost - mean)))
    if lost == 0:
        return -math.inf
    return term.log_weight + max(term.slope * cost, term.slope * mean) + math.log(lost)
