"""The policy of least entropic value at risk, by searches for averse agents and lines below all policies.

The entropic value at risk of a cost is the least of `f(x) + c x` over all `x > 0`, where `f(x)` is the certainty
equivalent of the averse agent of alpha `1/x`, and `c = ln(1/(1 - level))`. Policies and x may change places in the
minimum, so that it is the least of `V(x) + c x`, where V(x) is the least certainty equivalent of any policy: a search
for one agent.

- A policy that is known has its least value at some x. The best policy for the agent there is no worse; and so on until
  none is better. That begins with the neutral agent's, so that there is a policy as soon as there can be one.
- With `m` the least expected cost of any policy, none is better than the best one known, of value `U`, at any x with
  `m + c x >= U`. So x may be had in the interval from 0, the worst case, to `(U - m)/c`.
- V falls as x rises: on an interval nothing is below V at its upper end. And what the search has explored there gives a
  line below the certainty equivalents of all policies on the interval, which touches V where the best policy known has
  its least value (relax/policies/policy_chord.hpp). Its error is quadratic in the width of the interval.
- Below an x where no policy is finite none is.
- An interval whose bound is too low is split; the interval with the lowest bound is the next. The parts keep what was
  explored for the whole, and search themselves where that proves too little.
"""

from __future__ import annotations

import heapq
import math
import time
from collections.abc import Callable
from functools import partial

from statehtn.core.policy_chord import ExploredPolicies
from statehtn.core.policy_outcome import PolicyOutcome
from statehtn.core.progress import Progress, SearchProgress
from statehtn.effort import SearchEffort
from statehtn.limits import ENDINGS, Limits, status_of
from statehtn.model.status import Status
from statehtn.policies.evar_best import BestByEvar
from statehtn.risk import Attitude, EntropicValueAtRisk, Exponential, Neutral
from statehtn.sweeps.evar import Interval
from statehtn.sweeps.minorants import minorant

MOST_INTERVALS = 2000
LEAST_TOUCHING = 1 / 64
"""Of an interval's upper end, where a line touches that had better touch at 0."""
NEARBY = (1.0, 1.0001, 1.01)
"""Times an x at which rounding hides whether anything is finite."""
FAR = 2.0
"""Times an x is where much may have been left alone that agents of this x need."""
DOUBLINGS = 60
Search = Callable[..., PolicyOutcome]


class EvarSearch:
    """Finds the policy of least entropic value at risk.

    Args:
        objective: which.
        failure: what failing costs on top of what was spent; 0 where no run fails.
        precision: how far from the best a policy may be that counts as optimal, as a part of max(1, value).
        search: finds the best policy by an additive objective, within the limits; takes `progress`.
        limits: they hold for all searches together.
        progress: is called while the search goes on.
    """

    def __init__(
        self,
        objective: EntropicValueAtRisk,
        failure: float,
        precision: float,
        search: Search,
        limits: Limits,
        progress: Callable[[SearchProgress], None] | None = None,
    ) -> None:
        self.divergence = -math.log1p(-objective.level)
        self.best = BestByEvar(objective.level, failure, precision)
        self._search = search
        self._limits = limits
        self._progress = progress
        self._started = time.monotonic()
        self.effort = SearchEffort()
        self.stopped: Status | None = None
        self.mean = 0.0
        self._intervals: list[tuple[Interval, int, ExploredPolicies | None]] = []
        self._made = 0
        self._infinite = 0.0  # no policy is finite up to this x

    def outcome(self) -> PolicyOutcome:
        """Search, and return the best policy with what is proven of all.

        Raises:
            InputError: the cost of every policy has an infinite value.
        """
        neutral = self._searched(Neutral())
        if neutral.graph is None or neutral.lower is None:
            return neutral
        self.mean = neutral.lower
        try:
            self.best.consider(neutral, self._limits)
            self._begin(neutral)
            self._go_on()
        except ENDINGS as ending:
            self.stopped = status_of(ending)
        best, bound = self.best.found or neutral, min(self.bound, self.best.value)
        is_best = bound >= self.best.enough and self.best.found is not None
        upper = self.best.value if math.isfinite(self.best.value) else None
        how = best.graph, self.effort, None, None, best.plan_of
        stopped = None if is_best else self.stopped
        return PolicyOutcome(Status.OPTIMAL if is_best else Status.SOLVED, stopped, bound, upper, *how)

    @property
    def bound(self) -> float:
        """No policy has a lower value."""
        if self._made == 0:
            return self.mean
        return self._intervals[0][0].bound if self._intervals else self.best.value

    def _begin(self, neutral: PolicyOutcome) -> None:
        """Find good policies, and the first interval."""
        for doubling in range(DOUBLINGS):
            if math.isfinite(self.best.value) or self.stopped is not None:
                break
            self._run_at(max(self.mean, 1e-9) * 2.0**doubling)
        if math.isinf(self.best.value):
            if self.stopped is None:
                self.best.say_what_is_infinite(neutral)
            return
        self._improve()
        highest = (self.best.value - self.mean) / self.divergence
        if highest > 0:
            self._add(Interval.of(0.0, highest, self.mean, self.mean + self.divergence * highest), None)
        self._made += 1

    def _improve(self) -> None:
        """Take the best policy for the agent to whom the best one known comes to its value; and again."""
        value = math.inf
        while self.stopped is None and self.best.x > 0 and self.best.value < value:
            value = self.best.value - self.best.precision / 10 * abs(self.best.value)
            self._run_at(self.best.x)

    def _go_on(self) -> None:
        """Bound all policies on the worst interval, until the bound has come to the best policy."""
        while self._intervals and self._made < MOST_INTERVALS and self.stopped is None:
            interval, _, explored = self._intervals[0]
            if interval.bound >= self.best.enough:
                break
            value = self.best.value
            parts = self._refined(interval, explored)
            if parts == [(interval, explored)]:  # there is nothing between its ends
                break
            heapq.heappop(self._intervals)
            for part in parts:
                self._add(*part)
            if self.best.value < value:
                self._improve()

    def _add(self, interval: Interval, explored: ExploredPolicies | None) -> None:
        self._made += 1
        heapq.heappush(self._intervals, (interval, self._made, explored))

    def _refined(
        self, interval: Interval, explored: ExploredPolicies | None
    ) -> list[tuple[Interval, ExploredPolicies | None]]:
        """Return what an interval becomes, each part with what was explored for its upper end or beyond."""
        if interval.high <= self._infinite:
            return []
        if explored is not None:
            interval = self._bounded(interval, explored)
        if interval.bound < self.best.enough and self._needs_search(interval, explored):
            found = self._explored_at(interval.high)
            if found.status is Status.UNSOLVABLE:
                self._infinite = max(self._infinite, interval.high)
                return []
            if found.lower is not None and found.status is not Status.GAVE_UP:
                interval = interval.raised(*(found.lower + self.divergence * x for x in (interval.low, interval.high)))
                explored = found.explored or explored
                if self.stopped is None and found.explored is not None:
                    interval = self._bounded(interval, found.explored)
        if interval.bound >= self.best.enough or self.stopped is not None:
            return [(interval, explored)]
        point = interval.weak_point(self.best.value, self._touching(interval))
        if not interval.low < point < interval.high:
            return [(interval, explored)]
        return [(part, explored) for part in interval.split(point)]

    def _needs_search(self, interval: Interval, explored: ExploredPolicies | None) -> bool:
        """Tell whether a search at the upper end may tell more than what was explored beyond it.

        Where the best policy known has its value in the interval, no other is better at that x, and a chord explores
        what it needs.
        """
        if explored is None:
            return True
        is_far = explored.x > FAR * interval.high or not interval.low <= self.best.x <= interval.high
        return is_far and explored.x > interval.high

    def _touching(self, interval: Interval) -> float:
        return min(max(self.best.x, interval.low, LEAST_TOUCHING * interval.high), interval.high)

    def _bounded(self, interval: Interval, explored: ExploredPolicies) -> Interval:
        """Bound all policies on an interval by a chord.

        At the upper end no sum of steps is negative for lines that touch there.
        """
        low, high = interval.low, interval.high
        enough = self.best.enough - self.divergence * low, self.best.enough - self.divergence * high
        for touching in dict.fromkeys((self._touching(interval), high)):
            lines = partial(minorant, low=low, high=high, at=touching)
            chord = explored.chord(lines, low, high, touching, enough, self._limits)
            if chord is not None:
                return interval.raised(chord[0] + self.divergence * low, chord[1] + self.divergence * high)
        return interval

    def _explored_at(self, x: float) -> PolicyOutcome:
        """Search for the agent of an x, or of a little more where that is too close to call."""
        for factor in NEARBY:
            found = self._run_at(x * factor)
            if found.status is not Status.GAVE_UP or self.stopped is not None:
                break
        return found

    def _run_at(self, x: float) -> PolicyOutcome:
        """Search for the agent of an x."""
        found = self._searched(Exponential(Attitude.AVERSE, math.nextafter(1 / x, 0)))  # whose inverse is not below x
        self.best.consider(found, self._limits)
        return found

    def _searched(self, objective: Neutral | Exponential) -> PolicyOutcome:
        found = self._search(objective, progress=None if self._progress is None else self._report)
        self.effort += found.effort
        self.stopped = self.stopped or found.stopped
        return found

    def _report(self, progress: SearchProgress) -> None:
        assert self._progress is not None
        effort = self.effort + progress.effort
        best = self.best.value if math.isfinite(self.best.value) else None
        self._progress(Progress(time.monotonic() - self._started, effort, self.bound, best))
