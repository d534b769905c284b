"""The policy of least entropic value at risk, by branch and bound: the judge of the planner's.

That is the least over a > 0 of `V(a) + c / a`, where V(a) is the value of the best policy of an averse agent with this
alpha, and `c = ln(1 / (1 - level))`. V rises in a, so that on [a, b] nothing is below `V(a) + c / b`.
"""

from __future__ import annotations

import heapq
import math
from fractions import Fraction

from tests.brute_force import GaveUp
from tests.explicit_graph import ExplicitGraph
from tests.explicit_policies import Answer, best_policy

CLOSE = 2e-7
LEAST_ALPHA, MOST_ALPHA = Fraction(1, 2**10), Fraction(2**26)
MOST_AGENTS = 400


def best_policy_by_evar(
    graph: ExplicitGraph, text: str, failure_cost: Fraction | None = None, close: float = CLOSE
) -> Answer:
    """The value of the best policy for `evar LEVEL`, to within `close` of max(1, value).

    Raises:
        GaveUp: that takes more than MOST_AGENTS agents, or larger or smaller alphas than are tried.
    """
    level = float(text.split()[1])
    radius = -math.log1p(-level)
    known: dict[Fraction, float] = {}

    def value(alpha: Fraction) -> float:
        if alpha not in known:
            if len(known) > MOST_AGENTS:
                raise GaveUp
            found = best_policy(graph, f"averse {alpha}", failure_cost).value
            known[alpha] = math.inf if found is None else float(found)
        return known[alpha]

    mean = best_policy(graph, "neutral", failure_cost).value
    if mean is None:
        return Answer(None)
    best = min(value(MOST_ALPHA / 2**i) + radius / float(MOST_ALPHA / 2**i) for i in range(36))
    # Beyond both ends: below the least alpha nothing is less than the mean and c / a, above the largest one than V.
    if float(mean) + radius / float(LEAST_ALPHA) < best or value(MOST_ALPHA) < best - close * max(1.0, best):
        raise GaveUp
    intervals = [(value(LEAST_ALPHA) + radius / float(MOST_ALPHA), LEAST_ALPHA, MOST_ALPHA)]
    while intervals:
        bound, low, high = heapq.heappop(intervals)
        if bound >= best - close * max(1.0, best):
            return Answer(Fraction(best))
        middle = Fraction(math.sqrt(low * high)).limit_denominator(2**30)
        best = min(best, value(middle) + radius / float(middle))
        for a, b in ((low, middle), (middle, high)):
            heapq.heappush(intervals, (value(a) + radius / float(b), a, b))
    raise AssertionError
