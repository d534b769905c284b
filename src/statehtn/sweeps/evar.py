"""The plan of least entropic value at risk (EVaR), by branch and bound over alpha.

The EVaR of a cost at a level is the least value of `ce_a(C) + c/a` over `a > 0`, where `ce_a` is the certainty
equivalent of the averse exponential agent and `c = ln(1 / (1 - level))` (Ahmadi-Javid, *Entropic value-at-risk: a new
coherent risk measure*, 2012). So the least one of any plan is the least value of `V(1/x) + c x` over `x >= 0`, where
`V(a)` is the least certainty equivalent of any plan, and every run of A* at fixed prices tells something about V.

- With `m` the least mean of any plan, no plan is better than the best one known, of EVaR `U`, at any x with
  `m + c x >= U`. So x may be had in the interval from 0, the worst case, to `(U - m)/c`.
- On an interval of x no plan has a value below the lower one of the ends of a chord that two runs of A* give
  (`statehtn.sweeps.minorants`). The lines touch at the point where the best plan known has its least value, or at the
  end next to it: there its own line is level, so that no error remains for it, and where the interval is wide the
  others decide how good the bound is.
- An interval whose bound is too low is split; the interval with the lowest bound is the next.
- Without `chords` each run is at one end of an interval, and many more are needed: like `1 / sqrt(precision)`.

Every plan that is found is a candidate, whose EVaR is exact.
"""

from __future__ import annotations

import heapq
import math
from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import partial

from statehtn.compatible import LABEL_SWITCHES
from statehtn.found_plan import FoundPlan, priced
from statehtn.limits import ENDINGS, Limits, in_spite_of_interrupt, status_of
from statehtn.model.status import Status
from statehtn.pipeline import solutions
from statehtn.result import Result
from statehtn.risk import Attitude, EntropicValueAtRisk, Exponential, Neutral
from statehtn.session import ProgressCallback, Session
from statehtn.settings import Settings
from statehtn.sweeps.plan_curve import PlanCurve
from statehtn.sweeps.prices import Minorant
from statehtn.sweeps.runs import Runs

LEAST_SHARE = 0.1  # of an interval, that a part of it has
WORTHWHILE = 0.25  # of an interval, that is bounded well enough and parted from the rest


@dataclass(frozen=True, slots=True, order=True)
class Interval:
    """An interval of x, and a line below the values of all plans on it.

    Args:
        bound: the lower one of the line's ends.
        low: the lower end, in units of cost.
        high: the upper end.
        at_low: the value of the line at the lower end.
        at_high: its value at the upper one.
    """

    bound: float
    low: float
    high: float
    at_low: float
    at_high: float

    @staticmethod
    def of(low: float, high: float, at_low: float, at_high: float) -> Interval:
        """Return an interval with a line."""
        return Interval(min(at_low, at_high), low, high, at_low, at_high)

    def raised(self, at_low: float, at_high: float) -> Interval:
        """Return it with the better one of two lines: its own, and one with these values at its ends.

        The larger values of both would make no line below: it would be above both where they cross.
        """
        return max(self, Interval.of(self.low, self.high, at_low, at_high))

    def split(self, at: float) -> list[Interval]:
        """Return the parts below and above a point inside."""
        share = (at - self.low) / (self.high - self.low)
        middle = self.at_low + share * (self.at_high - self.at_low)
        return [Interval.of(self.low, at, self.at_low, middle), Interval.of(at, self.high, middle, self.at_high)]

    def weak_point(self, value: float, touching: float) -> float:
        """Return where to split so that one part is bounded by a value, or both by more than now.

        Args:
            value: that is to be proven; above the bound.
            touching: where the lines touched.
        """
        width = self.high - self.low
        worse, other = (self.low, self.high) if self.at_low <= self.at_high else (self.high, self.low)
        rise = abs(self.at_high - self.at_low)
        good = (max(self.at_low, self.at_high) - value) / rise if rise > 0 else 0.0  # share that is good enough
        if good >= WORTHWHILE:
            point = other + good * (worse - other)
        else:  # halfway between the worse end and where the lines touched, since they will touch there again
            point = (worse + (other if touching == worse else touching)) / 2
        return min(max(point, self.low + LEAST_SHARE * width), self.high - LEAST_SHARE * width)


class EvarSweep:
    """A search for the plan of least entropic value at risk; iterate over `results` once.

    Args:
        session: the problem.
        settings: the objective, and how to search.
        limits: they hold for all runs together.
        progress: is called while a run goes on.
    """

    def __init__(
        self, session: Session, settings: Settings, limits: Limits, progress: ProgressCallback | None = None
    ) -> None:
        assert isinstance(settings.objective, EntropicValueAtRisk)
        self.settings = settings
        self.objective = settings.objective
        self.radius = -math.log1p(-self.objective.level)
        self.runs = Runs(session, settings, limits, progress)
        self.best: FoundPlan | None = None
        self.best_x = 0.0
        self.bound: float | None = None

    @property
    def value(self) -> float:
        """The EVaR of the best plan known; infinite where there is none."""
        return math.inf if self.best is None else self.best.value

    def results(self) -> Iterator[Result]:
        """Yield a result after every run that found a better plan, and last how the sweep ended."""
        try:
            yield from self.better_and_better()
        except ENDINGS as ending:  # between two runs
            self.runs.stopped = status_of(ending)
            yield self.result(self.runs.stopped)

    def better_and_better(self) -> Iterator[Result]:
        """Yield what `results` does, unless something ends it between two runs."""
        for first in self.runs.improving(Neutral()):
            if self.runs.has_scenarios:  # certainty equivalents do not add up
                yield from self.by_labels()
                return
            if self.consider(first):
                yield self.result(Status.SOLVED)
            if self.runs.stopped is not None:
                break
        self.bound = first.lower_bound  # no EVaR is below the mean
        if self.best is None or self.runs.stopped is not None or self.bound is None:
            yield self.result(first.status)
            return
        mean, highest = self.bound, (self.value - self.bound) / self.radius
        todo = [Interval.of(0.0, highest, mean, mean + self.radius * highest)] if highest > 0 else []
        while todo and not self.is_proven(todo[0].bound) and self.runs.stopped is None:
            is_better = False
            for result in self.halve(todo) if "chords" in self.settings.without else self.refine(todo):
                is_better |= self.consider(result)
            self.bound = self.runs.bound = min(todo[0].bound, self.value)
            if is_better:
                yield self.result(Status.SOLVED)
        if not todo:
            self.bound = self.value
        yield self.result(Status.SOLVED)

    def by_labels(self) -> Iterator[Result]:
        """Yield the results of a search by labels: the way where certainty equivalents do not add up."""
        without = tuple(name for name in self.settings.without if name in LABEL_SWITCHES)
        settings = replace(self.settings, without=without)
        return solutions(self.runs.session, settings, self.runs.limits, self.runs.progress, every_plan=True)

    def halve(self, todo: list[Interval]) -> Iterator[Result]:
        """Bound all plans on the worst interval by one run; yield it, and put back what the interval becomes.

        The plain way: on an interval of x no value is below `V(1/high) + c low`, since `V(1/x)` does not rise with x.
        """
        interval = heapq.heappop(todo)
        low, high = interval.low, interval.high
        result = self.runs.run(Exponential(Attitude.AVERSE, 1 / high))
        yield result
        known = interval.bound if result.lower_bound is None else result.lower_bound + self.radius * low
        bound = max(interval.bound, known)
        halves = [(low, high)] if self.is_proven(bound) else [(low, (low + high) / 2), ((low + high) / 2, high)]
        for one in halves:
            heapq.heappush(todo, Interval.of(*one, bound, bound))

    def refine(self, todo: list[Interval]) -> Iterator[Result]:
        """Bound all plans on the worst interval by two runs; yield these, and put back what the interval becomes."""
        interval = heapq.heappop(todo)
        low, high = interval.low, interval.high
        at = min(max(self.best_x, low), high)
        ends = []
        for upper in (False, True):
            if self.runs.stopped is None:
                result = self.runs.run(Minorant(low, high, at, upper))
                if result.lower_bound is not None:
                    ends.append(result.lower_bound + self.radius * (high if upper else low))
                yield result
        known = interval.raised(*ends) if len(ends) == 2 else interval
        parts = [known]
        if not self.is_proven(known.bound) and self.runs.stopped is None:
            parts = known.split(known.weak_point(self.value, at))
        for part in parts:
            heapq.heappush(todo, part)

    def consider(self, result: Result) -> bool:
        """Take the plan of a run for the best one, if it is better; tell whether it is."""
        if result.found is None:
            return False
        measure = partial(self._measured, result.found)
        (better, x), is_interrupted = in_spite_of_interrupt(measure, self.runs.limits)
        if is_interrupted:
            self.runs.stopped = Status.INTERRUPTED
        if better is None:
            return False
        self.best, self.best_x = better, x
        self.runs.best = self.value
        return True

    def _measured(self, found: FoundPlan) -> tuple[FoundPlan | None, float]:
        """Return a plan with its EVaR, None where that is not less than the best one known, and the x that gives it."""
        value, x = PlanCurve(step.law for step in found.steps).evar(self.radius)
        if self.best is not None and value >= self.value:
            return None, x
        return priced(found.plan, self.objective, unchecked=found.unchecked), x

    def is_proven(self, bound: float) -> bool:
        """Tell whether a bound proves the best plan to the precision that is asked for."""
        return self.value - bound <= self.settings.precision * max(1.0, self.value)

    def result(self, status: Status) -> Result:
        """Return what is known by now; `status` is that of a run without a plan."""
        if self.best is not None:
            is_proven = self.bound is not None and self.is_proven(self.bound)
            status = Status.OPTIMAL if is_proven else Status.SOLVED
        runs = self.runs
        return Result(
            status,
            self.settings,
            runs.statistics,
            runs.stopped,
            unread=runs.unread,
            found=self.best,
            bound=self.bound,
        )
