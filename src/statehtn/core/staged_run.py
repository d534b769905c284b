"""The stages of a search for one plan, as optimal as can be."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace

import statehtn._relax as _relax
from statehtn.core.pricing import PricedProblem, PricedTrace
from statehtn.core.progress import Progress
from statehtn.core.scale import MOST_UNITS, TOLERANCE, Scale, worth_while
from statehtn.core.search_run import PricedRun, SearchOutcome, TracedPlans
from statehtn.effort import SearchEffort
from statehtn.limits import ENDINGS, Limits, status_of
from statehtn.model.status import Status

_STATUSES = {
    _relax.SearchStatus.Optimal: Status.OPTIMAL,
    _relax.SearchStatus.Solved: Status.SOLVED,
    _relax.SearchStatus.Unsolvable: Status.UNSOLVABLE,
    _relax.SearchStatus.GaveUp: Status.GAVE_UP,
    _relax.SearchStatus.TimeLimit: Status.TIME_LIMIT,
    _relax.SearchStatus.MemoryLimit: Status.MEMORY_LIMIT,
    _relax.SearchStatus.Interrupted: Status.INTERRUPTED,
}
Options = _relax.FindPlansOptions | _relax.PlanBasedOptions | _relax.PortfolioOptions


class StagedRun(PricedRun[Progress, _relax.SearchStatistics]):
    """The stages of a search: the best plan so far, and a bound of the risk cost of every plan."""

    def __init__(
        self, problem: PricedProblem, limits: Limits, progress: Callable[[Progress], None] | None = None
    ) -> None:
        super().__init__(problem, limits, progress)
        self.best: PricedTrace | None = None
        self.ending = Status.UNSOLVABLE  # of the latest stage

    def outcomes(
        self, stages: Sequence[Options], weight: float = 1.0, sharpens: bool = True
    ) -> Iterator[SearchOutcome]:
        """Go through the stages, and yield an outcome after every stage that found a better plan, and at the end.

        All but the last have the status `SOLVED`.

        Args:
            stages: what the core is asked for; one or more.
            weight: the best plan is to be proven to cost at most so many times as much as any.
            sharpens: repeat the last stage on finer scales as long as that can prove more; a search that looks for any
                plan proves what it can in passing.
        """
        try:
            for _ in self._better_plans(stages, weight, sharpens):
                yield replace(self.outcome(), status=Status.SOLVED)
        except ENDINGS as ending:  # between two stages
            self.ending = self.stopped = status_of(ending)
        yield self.outcome()

    def _better_plans(self, stages: Sequence[Options], weight: float, sharpens: bool) -> Iterator[PricedTrace]:
        """Go through the stages, and yield every plan that is better than the one before."""
        for options in stages:
            best = self.best
            if self.stage(options):
                break
            if self.best is not None and self.best is not best:
                yield self.best
        while sharpens and self.sharpen(weight):
            best = self.best
            self.stage(stages[-1])
            if self.best is not None and self.best is not best:
                yield self.best

    def stage(self, options: Options) -> bool:
        """Run one stage; returns whether it was the last one that can make a difference on this scale."""
        while True:
            options.upper_bound = self.wanted()
            result = _relax.find_plans(self.prices.handle, options, *self.limits.left(), self.watch)
            self._take(result, options.upper_bound)
            if result.statistics.lower_bound != MOST_UNITS or self.stopped is not None or self.best is not None:
                break
            self.rescale(Scale.after(None, self.bound or 0.0))  # every plan costs more than units tell
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
        return self.rescale(Scale.after(self.best.cost, self.bound or 0.0, self.best.steps))

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
            status = Status.OPTIMAL if self.stopped is None and self.proves() else Status.SOLVED
            bound = None if bound is None else min(bound, self.best.cost)
        plans = TracedPlans(self.reader, [] if self.best is None else [self.best.trace])
        return SearchOutcome(status, self.stopped, plans, bound, self.effort, unread=self.unread)

    def progress_of(
        self, statistics: _relax.SearchStatistics, seconds: float, effort: SearchEffort, bound: float | None
    ) -> Progress:
        """Return what the user's callback is told while a stage goes on."""
        scale, best = self.prices.scale, None if self.best is None else self.best.cost
        if statistics.best is not None and statistics.best <= scale.cap:  # else it may cost far more than in units
            best = min(scale.cost(statistics.best), math.inf if best is None else best)
        return Progress(seconds, effort, bound if best is None or bound is None else min(bound, best), best)

    def _take(self, result: _relax.SearchResult, upper_bound: int | None) -> None:
        """Take up what a search has found and proven below an upper bound."""
        self.take(result.statistics, result.stop)
        self.ending = _STATUSES[result.status]
        units = result.statistics.lower_bound
        if result.status is _relax.SearchStatus.Unsolvable:
            units = upper_bound  # there is no plan below it
        self.bound = self.bound_with(units)
        if result.cost is not None:
            found = self.problem.of_plan(result)
            if self.best is None or found.cost < self.best.cost:
                self.best = found
        elif result.statistics.best is not None:
            self.unread = True
