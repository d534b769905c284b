"""The policy of least entropic value at risk, by searches for averse agents.

The entropic value at risk of a cost is the least of `ce_a + c/a` over all `a > 0`, where `ce_a` is the certainty
equivalent of the averse agent of alpha `a` and `c = ln(1/(1 - level))`. Policies and `a` may change places in the
minimum, so that it is the least of `V(a) + c/a`, where V(a) is the least certainty equivalent of any policy: a search
for one agent. V rises with `a`. So between `a1` and `a2` nothing is below `V(a1) + c/a2`, from `a1` on nothing is below
`V(a1)`, and up to `a2` nothing is below `V(0) + c/a2`, where V(0) is the least expected cost. Intervals are halved,
that of the least bound first, until the bound has come to the best policy that was found.
"""

from __future__ import annotations

import heapq
import math
from collections.abc import Callable

from statehtn.core.policy_outcome import PolicyOutcome
from statehtn.effort import SearchEffort
from statehtn.errors import StateHtnError
from statehtn.model.policy_graph import FlatPolicy
from statehtn.model.status import Status
from statehtn.policies.chain import Chain
from statehtn.policies.total_cost import PolicyCost
from statehtn.risk import Attitude, EntropicValueAtRisk, Exponential, Neutral, Objective

MOST_RUNS = 2000
FIRST = 1.0
"""The first alpha, times the least expected cost."""
Search = Callable[[Objective], PolicyOutcome]


class EvarSearch:
    """Finds the policy of least entropic value at risk.

    Args:
        objective: which.
        failure: what failing costs on top of what was spent; 0 where no run fails.
        precision: how far from the best a policy may be that counts as optimal, as a part of max(1, value).
        search: finds the best policy by an additive objective.
    """

    def __init__(self, objective: EntropicValueAtRisk, failure: float, precision: float, search: Search) -> None:
        self.level = objective.level
        self.divergence = -math.log1p(-objective.level)
        self.failure = failure
        self.precision = precision
        self._search = search
        self.effort = SearchEffort()
        self.stopped: Status | None = None
        self.best: PolicyOutcome | None = None
        self.value = math.inf
        self.runs = 0

    def outcome(self) -> PolicyOutcome:
        """Search, and return the best policy with what is proven of all."""
        neutral = self._run(Neutral())
        if neutral.graph is None or neutral.lower is None:
            return neutral
        bound = self._sweep(neutral.lower)
        assert self.best is not None
        is_best = self.value - bound <= self.precision * max(1.0, abs(self.value))
        status = Status.OPTIMAL if is_best else Status.SOLVED
        best = self.best
        how = self.best.graph, self.effort, None, None, best.plan_of
        return PolicyOutcome(status, self.stopped, min(bound, self.value), self.value, *how)

    def _sweep(self, neutral: float) -> float:
        """Halve intervals; return a bound of the value of every policy.

        An interval is its bound, its ends, and what is proven of V at the lower end.
        """
        intervals = [self._interval(0.0, math.inf, neutral)]
        while intervals and self.stopped is None and self.runs < MOST_RUNS:
            bound, low, high, at_low = intervals[0]
            if self.value - bound <= self.precision * max(1.0, abs(self.value)):
                break
            heapq.heappop(intervals)
            middle = self._between(low, high, neutral)
            if not low < middle < high:
                return bound
            found = self._run(Exponential(Attitude.AVERSE, middle))
            if found.stopped is not None:
                heapq.heappush(intervals, (bound, low, high, at_low))
                break
            heapq.heappush(intervals, self._interval(low, middle, at_low))
            if found.status is not Status.UNSOLVABLE:  # else every larger alpha has an infinite value, too
                at_middle = max(at_low, at_low if found.lower is None else found.lower)
                heapq.heappush(intervals, self._interval(middle, high, at_middle))
        return min((bound for bound, *_ in intervals), default=self.value)

    def _interval(self, low: float, high: float, at_low: float) -> tuple[float, float, float, float]:
        return at_low + (self.divergence / high if math.isfinite(high) else 0.0), low, high, at_low

    def _between(self, low: float, high: float, neutral: float) -> float:
        """Return an alpha in an interval: in the middle of its logarithms where it has ends."""
        if low == 0:
            return high / 2 if math.isfinite(high) else FIRST / max(neutral, 1e-9)
        return low * 2 if math.isinf(high) else math.sqrt(low * high)

    def _run(self, objective: Objective) -> PolicyOutcome:
        """Search for one agent; its policy is valued by this objective."""
        found = self._search(objective)
        self.runs += 1
        self.effort += found.effort
        self.stopped = self.stopped or found.stopped
        if found.graph is not None:
            value = self._value(found.graph.flat)
            if value < self.value:
                self.value, self.best = value, found
        return found

    def _value(self, flat: FlatPolicy) -> float:
        try:
            return PolicyCost(Chain(flat), self.failure).evar(self.level)
        except StateHtnError:  # it is infinite, or cannot be computed
            return math.inf
