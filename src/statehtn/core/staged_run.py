"""The stages of one search together, with outcomes in the domain's own unit of cost."""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from dataclasses import dataclass

import statehtn._relax as _relax
from statehtn.core.grounding import STOPPED, Grounding
from statehtn.core.pricing import FoundPlan, RiskCosts
from statehtn.core.progress import Progress
from statehtn.core.scale import MOST_UNITS, TOLERANCE, Scale, worth_while
from statehtn.core.trace import TraceReader
from statehtn.limits import Limits
from statehtn.model.plan import Plan
from statehtn.model.status import Status

_STATUSES = {
    _relax.SearchStatus.Optimal: Status.OPTIMAL,
    _relax.SearchStatus.Solved: Status.SOLVED,
    _relax.SearchStatus.Unsolvable: Status.UNSOLVABLE,
    _relax.SearchStatus.GaveUp: Status.EXHAUSTED,
    _relax.SearchStatus.TimeLimit: Status.TIME_LIMIT,
    _relax.SearchStatus.MemoryLimit: Status.MEMORY_LIMIT,
    _relax.SearchStatus.Interrupted: Status.INTERRUPTED,
}


@dataclass(frozen=True, slots=True)
class SearchOutcome:
    """How a search ended. `lower_bound` bounds the risk cost of every plan; None if there is none."""

    status: Status
    plan: Plan | None
    lower_bound: float | None
    expanded: int
    generated: int
    evaluated: int
    dead_ends: int
    cuts: int
    """Landmark cuts of all evaluations together."""
    stopped: Status | None
    """What ended the search before it was done, with or without a plan; None for nothing."""


class StagedRun:
    """The stages of a search: the best plan and the best bound so far, and the effort of all of them together."""

    def __init__(
        self, grounding: Grounding, costs: RiskCosts, limits: Limits, progress: Callable[[Progress], None] | None
    ) -> None:
        self.grounding = grounding
        self.reader = TraceReader(grounding)
        self.costs = costs
        self.prices = costs.on(Scale.first(costs.bounds()))
        self.limits = limits
        self.progress = progress
        self.started = time.monotonic()
        self.best: FoundPlan | None = None
        self.bound: float | None = None  # of the risk cost of every plan, whatever the scale it was proven on
        self.ending = Status.UNSOLVABLE  # of the latest stage
        self.stopped: Status | None = None
        self.done: list[_relax.SearchStatistics] = []

    def stage(self, options: _relax.SearchOptions) -> bool:
        """Run one stage; returns whether it was the last one that can make a difference on this scale."""
        while True:
            options.upper_bound = self.wanted()
            result = self._search(options)
            self._take(result, options.upper_bound)
            if result.statistics.lower_bound != MOST_UNITS or self.stopped is not None or self.best is not None:
                break
            self.prices = self.costs.on(Scale.after(None, self.bound or 0.0))  # every plan costs more than units tell
        is_settled = result.status in (_relax.SearchStatus.Optimal, _relax.SearchStatus.Unsolvable)
        return self.stopped is not None or is_settled or self.proves()

    def sharpen(self, weight: float = 1.0) -> bool:
        """Take a finer scale, or one with a higher cap, where something is left to prove.

        Args:
            weight: the best plan is to be proven to cost at most so many times as much as any.

        Returns:
            Whether another stage can prove more; else no scale can, or nothing is left to prove, or to be done.
        """
        if self.stopped is not None or self.best is None or self.proves(weight):
            return False
        scale = Scale.after(self.best.cost, self.bound or 0.0, self.best.steps)
        if scale == self.prices.scale:
            return False
        self.prices = self.costs.on(scale)
        return True

    def proves(self, weight: float = 1.0) -> bool:
        """Tell whether the best plan is proven to cost at most so many times as much as any plan."""
        if self.best is None or self.bound is None:
            return False
        return self.best.cost * (1 - TOLERANCE) <= weight * self.bound

    def wanted(self) -> int | None:
        """Return the number of units below which a plan is of interest; None for any."""
        return None if self.best is None else worth_while(self.prices.of_plan(self.best), self.prices.has_free)

    def outcome(self) -> SearchOutcome:
        """Return how the stages ended together."""
        status, bound = self.ending, self.bound
        if self.best is not None:
            status = Status.OPTIMAL if self.proves() else Status.SOLVED
            bound = None if bound is None else min(bound, self.best.cost)
        return SearchOutcome(
            status,
            None if self.best is None else self.reader.read(self.best.trace),
            bound,
            sum(one.expanded for one in self.done),
            sum(one.generated for one in self.done),
            sum(one.evaluated for one in self.done),
            sum(one.dead_ends for one in self.done),
            sum(one.cuts for one in self.done),
            self.stopped,
        )

    def _search(self, options: _relax.SearchOptions) -> _relax.SearchResult:
        limits = self.limits
        return _relax.find_plans(
            self.grounding.handle,
            self.prices.units,
            options,
            None if limits.deadline is None else limits.deadline - time.monotonic(),
            None if limits.memory_mb is None else int(limits.memory_mb * 1e6),
            None if self.progress is None else self._report,
        )

    def _take(self, result: _relax.SearchResult, upper_bound: int | None) -> None:
        """Take up what a search has found and proven below an upper bound."""
        self.done.append(result.statistics)
        self.ending = _STATUSES[result.status]
        self.stopped = None if result.stop is None else STOPPED[result.stop]
        units = result.statistics.lower_bound
        if result.status is _relax.SearchStatus.Unsolvable:
            units = upper_bound  # there is no plan below it
        self.bound = self._bound_with(units)
        if result.cost is not None:
            found = self.costs.of_plan(result)
            if self.best is None or found.cost < self.best.cost:
                self.best = found

    def _bound_with(self, units: int | None) -> float | None:
        """Return the best lower bound of all stages and this one."""
        bound = None if units is None else self.prices.scale.cost(units)
        return max((known for known in (self.bound, bound) if known is not None), default=None)

    def _report(self, statistics: _relax.SearchStatistics) -> None:
        """Tell the user's callback how far the search has come."""
        assert self.progress is not None
        scale, best = self.prices.scale, None if self.best is None else self.best.cost
        if statistics.best is not None and statistics.best <= scale.cap:  # else it may cost far more than in units
            best = min(scale.cost(statistics.best), math.inf if best is None else best)
        bound = self._bound_with(statistics.lower_bound)
        everything = [*self.done, statistics]
        self.progress(
            Progress(
                time.monotonic() - self.started,
                sum(one.expanded for one in everything),
                sum(one.generated for one in everything),
                sum(one.evaluated for one in everything),
                bound if best is None or bound is None else min(bound, best),
                best,
            )
        )
