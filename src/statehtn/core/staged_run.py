"""The stages of one search together, with outcomes in the domain's own unit of cost."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass

import statehtn._relax as _relax
from statehtn.core.grounding import STOPPED, Grounding
from statehtn.core.pricing import Prices
from statehtn.core.progress import Progress
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
        self, grounding: Grounding, prices: Prices, limits: Limits, progress: Callable[[Progress], None] | None
    ) -> None:
        self.grounding = grounding
        self.reader = TraceReader(grounding)
        self.prices = prices
        self.limits = limits
        self.progress = progress
        self.started = time.monotonic()
        self.best: _relax.SearchResult | None = None
        self.status = Status.UNSOLVABLE
        self.lower_bound: int | None = None
        self.stopped: Status | None = None
        self.done: list[_relax.SearchStatistics] = []

    def stage(self, options: _relax.SearchOptions) -> bool:
        """Run one stage; returns whether it was the last one that can make a difference."""
        options.upper_bound = None if self.best is None else self.best.cost
        limits = self.limits
        result = _relax.find_plans(
            self.grounding.handle,
            self.prices.units,
            options,
            None if limits.deadline is None else limits.deadline - time.monotonic(),
            None if limits.memory_mb is None else int(limits.memory_mb * 1e6),
            None if self.progress is None else self.report,
        )
        self.done.append(result.statistics)
        self.lower_bound = self.bound_with(result.statistics)
        self.stopped = None if result.stop is None else STOPPED[result.stop]
        self.status = _STATUSES[result.status]
        if self.status is Status.UNSOLVABLE and self.best is not None:
            self.status = Status.OPTIMAL  # nothing is better than the best plan so far
            self.lower_bound = self.best.cost
        elif result.cost is not None:
            self.best = result
        elif self.best is not None:
            self.status = Status.SOLVED
        return self.stopped is not None or self.status not in (Status.SOLVED, Status.EXHAUSTED)

    def bound_with(self, statistics: _relax.SearchStatistics) -> int | None:
        """Return the best lower bound of all stages and this one."""
        bounds = [bound for bound in (self.lower_bound, statistics.lower_bound) if bound is not None]
        return max(bounds, default=None)

    def report(self, statistics: _relax.SearchStatistics) -> None:
        """Tell the user's callback how far the search has come."""
        assert self.progress is not None
        best = statistics.best if statistics.best is not None or self.best is None else self.best.cost
        everything = [*self.done, statistics]
        self.progress(
            Progress(
                time.monotonic() - self.started,
                sum(one.expanded for one in everything),
                sum(one.generated for one in everything),
                sum(one.evaluated for one in everything),
                self.cost(self.bound_with(statistics)),
                self.cost(best),
            )
        )

    def outcome(self) -> SearchOutcome:
        """Return how the stages ended together."""
        return SearchOutcome(
            self.status,
            None if self.best is None else self.reader.read(self.best),
            self.cost(self.lower_bound),
            sum(one.expanded for one in self.done),
            sum(one.generated for one in self.done),
            sum(one.evaluated for one in self.done),
            sum(one.dead_ends for one in self.done),
            sum(one.cuts for one in self.done),
            self.stopped,
        )

    def cost(self, units: int | None) -> float | None:
        """Return an amount of units in the domain's own unit."""
        return None if units is None else self.prices.cost(units)
