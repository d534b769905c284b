"""The searches for the k best plans, on one scale after the other, with what they have proven together."""

from __future__ import annotations

import math
from collections.abc import Callable

import statehtn._relax as _relax
from statehtn.core.action_names import Key, action_names, key_of
from statehtn.core.pricing import PricedProblem, PricedTrace
from statehtn.core.progress import TopProgress
from statehtn.core.scale import TOLERANCE, Scale
from statehtn.core.search_run import PricedRun, SearchOutcome, TracedPlans
from statehtn.effort import SearchEffort
from statehtn.limits import ENDINGS, Limits, status_of
from statehtn.model.status import Status


class TopRun(PricedRun[TopProgress, _relax.LabelStatistics]):
    """The best plans that are known, in the order of their costs, and a bound of all others.

    `bound` holds for every plan that is not among the `plans`, on whatever scale it was proven: a search proves it of
    all that it has not found, what it has found is compared by its own cost, and what is taken off the end of the list
    costs no less than the last plan. It is infinite where there are no others.
    """

    def __init__(
        self,
        problem: PricedProblem,
        options: _relax.LabelSearchOptions,
        limits: Limits,
        progress: Callable[[TopProgress], None] | None,
    ) -> None:
        super().__init__(problem, limits, progress)
        self.action_names = action_names(problem.grounding)
        self.options = options
        self.plans: list[PricedTrace] = []
        self._found: dict[Key, PricedTrace] = {}

    @property
    def proven(self) -> int:
        """How many plans, counted from the first, are proven to be the best: no other costs less."""
        if self.bound is None:
            return 0
        return sum(plan.cost * (1 - TOLERANCE) <= self.bound for plan in self.plans)

    def outcome_of_all(self) -> SearchOutcome:
        """Search on one scale after the other as long as that can prove more; return how that ended."""
        try:
            self.search()
            while self.sharpen():
                self.search()
        except ENDINGS as ending:  # between two searches
            self.stopped = status_of(ending)
        return self.outcome()

    def search(self) -> None:
        """Search on the present scale."""
        problem, sums = self.problem.grounding.handle, _relax.PriceSums(self.prices.handle)
        result = _relax.label_search(problem, sums, self.action_names, self.options, *self.limits.left(), self.watch)
        self.take(result.statistics, result.stop)
        self.unread = bool(result.plans)  # until all are taken up
        for trace in result.plans:
            plan = self.problem.of_plan(trace)
            known = self._found.setdefault(self._key(plan), plan)
            if plan.cost < known.cost:
                self._found[self._key(plan)] = plan
        self.plans = sorted(self._found.values(), key=lambda plan: plan.cost)[: self.options.count]
        self.unread = len(result.plans) < result.statistics.found
        self.bound = math.inf if result.is_all else self.bound_with(result.statistics.lower_bound)

    def sharpen(self) -> bool:
        """Take a finer scale, or one with a higher cap, where something is left to prove; returns whether it is."""
        is_full = len(self.plans) == self.options.count
        bound = self.bound or 0.0
        if self.stopped or math.isinf(bound) or (is_full and self.proven == len(self.plans)):
            return False
        last = self.plans[-1] if is_full else None  # without it, sums have left the range of fixed point
        return self.rescale(Scale.after(last.cost, bound, last.steps) if last else Scale.after(None, bound))

    def outcome(self) -> SearchOutcome:
        """Return how the searches ended together."""
        is_all = self.bound is not None and math.isinf(self.bound)
        bound = None if is_all else self.bound
        if bound is not None and len(self.plans) == self.options.count:
            bound = min(bound, self.plans[-1].cost)
        if self.plans:
            is_proven = is_all or self.proven == len(self.plans)
            status = Status.OPTIMAL if is_proven and self.stopped is None else Status.SOLVED
        else:
            status = self.stopped or Status.UNSOLVABLE
        plans = TracedPlans(self.reader, [plan.trace for plan in self.plans])
        return SearchOutcome(status, self.stopped, plans, bound, self.effort, self.proven, is_all, self.unread)

    def progress_of(
        self, statistics: _relax.LabelStatistics, seconds: float, effort: SearchEffort, bound: float | None
    ) -> TopProgress:
        """Return what the user's callback is told while a search goes on."""
        found, proven = max(len(self.plans), statistics.found), max(self.proven, statistics.proven)
        return TopProgress(seconds, effort, bound, found, proven)

    def _key(self, plan: PricedTrace) -> Key:
        return key_of(plan.actions, self.action_names, self.options.distinct)
