"""The policy of least entropic value at risk, by branch and bound: the judge of the planner's.

That is the least over a > 0 of `V(a) + c / a`, where V(a) is the value of the best policy of an averse agent with this
alpha, and `c = ln(1 / (1 - level))`. V rises in a, so that on [a, b] nothing is below `V(a) + c / b`.
"""

from __future__ import annotations

import heapq
import math
from collections.abc import Callable
from fractions import Fraction

from tests.brute_force import GaveUp
from tests.exact_policy_iteration import InfiniteCircle
from tests.explicit_graph import ExplicitGraph
from tests.explicit_policies import Answer, best_policy

CLOSE = 2e-7
LEAST_ALPHA, MOST_ALPHA = Fraction(1, 2**10), Fraction(2**26)
MOST_AGENTS = 400
NEARLY = 1e-3  # of max(1, value): a bound that far below is enough where more agents would be needed
REFINEMENTS = 30


def best_policy_by_evar(
    graph: ExplicitGraph, text: str, failure_cost: Fraction | None = None, close: float = CLOSE
) -> Answer:
    """The value of the best policy for `evar LEVEL`, to within `close` of max(1, value).

    Where that takes more than MOST_AGENTS agents, it is the least value near the best of these, and no policy is better
    by more than NEARLY.

    Raises:
        GaveUp: not even that is known by then, or it takes larger or smaller alphas than are tried.
    """
    level = float(text.split()[1])
    radius = -math.log1p(-level)
    known: dict[Fraction, float] = {}

    def value(alpha: Fraction) -> float:
        if alpha not in known:
            known[alpha] = value_of(graph, alpha, failure_cost)
        return known[alpha]

    mean = best_policy(graph, "neutral", failure_cost).value
    if mean is None:
        return Answer(None)
    best, at = min((value(alpha) + radius / float(alpha), alpha) for alpha in (MOST_ALPHA / 2**i for i in range(36)))
    # Beyond both ends: below the least alpha nothing is less than the mean and c / a, above the largest one than V.
    if float(mean) + radius / float(LEAST_ALPHA) < best or value(MOST_ALPHA) < best - close * max(1.0, best):
        raise GaveUp
    intervals = [(value(LEAST_ALPHA) + radius / float(MOST_ALPHA), LEAST_ALPHA, MOST_ALPHA)]
    while intervals:
        bound, low, high = heapq.heappop(intervals)
        if bound >= best - close * max(1.0, best):
            return Answer(Fraction(best))
        if len(known) > MOST_AGENTS:
            if bound < best - NEARLY * max(1.0, best):
                raise GaveUp
            return Answer(Fraction(refined(lambda alpha: value(alpha) + radius / float(alpha), at)))
        middle = Fraction(math.sqrt(low * high)).limit_denominator(2**30)
        best, at = min((best, at), (value(middle) + radius / float(middle), middle))
        for a, b in ((low, middle), (middle, high)):
            heapq.heappush(intervals, (value(a) + radius / float(b), a, b))
    raise AssertionError


def value_of(graph: ExplicitGraph, alpha: Fraction, failure_cost: Fraction | None) -> float:
    """The certainty equivalent of the best policy; infinite where there is none."""
    try:
        found = best_policy(graph, f"averse {alpha}", failure_cost).value
    except InfiniteCircle:
        assert graph.is_policy
        return math.inf
    return math.inf if found is None else float(found)


def refined(function: Callable[[Fraction], float], at: Fraction) -> float:
    """The least value found near a number, ever nearer to the best one by now."""
    best, step = function(at), 0.1
    for _ in range(REFINEMENTS):
        others = [Fraction(float(at) * (1 + sign * step)).limit_denominator(2**40) for sign in (1, -1)]
        value, other = min((function(other), other) for other in others)
        if value < best:
            best, at = value, other
        else:
            step /= 2
    return best
