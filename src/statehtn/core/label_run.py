"""The stages of a search by an objective whose label is not one price: the best plans, and a bound of all others."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property, partial

import statehtn._relax as _relax
from statehtn.core.action_names import Key, action_names, key_of
from statehtn.core.grounding import Grounding
from statehtn.core.labels import Labels
from statehtn.core.progress import Progress, SearchProgress, TopProgress
from statehtn.core.search_run import SearchOutcome, SearchRun, TracedPlans
from statehtn.effort import SearchEffort
from statehtn.limits import ENDINGS, Limits, in_spite_of_interrupt, status_of
from statehtn.model.status import Status
from statehtn.risk.keep import Keep

VALUED = (16, 256)
"""So many times as many plans as are wanted are valued exactly where no grid tells which is the best ..."""
MOST_VALUED = 2**12
"""... but no more than this."""
PRECISION = 1e-6
"""How much of its value, or of 1 if that is more, a plan that is called optimal may be worse than the best."""


@dataclass(frozen=True, slots=True)
class ValuedTrace:
    """A plan that the core has found, and its exact value."""

    trace: _relax.SearchResult
    value: float


class LabelRun(SearchRun[SearchProgress, _relax.LabelStatistics]):
    """The best plans that are known, in the order of their values, and a bound of all others.

    Searches with a single price for each action come first: their plans are incumbents. Then label searches, on one
    grid after the other: on each, no plan has a worth above its value, so that what is proven on any of them holds.
    Plans are compared by their exact values, by which they keep their budgets, too. In the end, where no grid has
    proven which is the best, more plans than are wanted are listed and compared.

    Args:
        grounding: the ground problem.
        labels: the valuation of the objective.
        options: what the core is asked for; `count` plans.
        keep: budgets that plans must keep.
        precision: how much of its value, or of 1 if that is more, a plan may be worse than what is proven.
        limits: they hold for all searches together.
        progress: is called while a search goes on.
    """

    is_supported = True
    """Whether searches with a single price for each action come first."""
    lists_plans = True
    """Whether the core can search for several plans."""
    seconds_to_value = 0.0
    """What it took to work out the value of a plan at most: as long it takes once more when the search is over."""

    def __init__(
        self,
        grounding: Grounding,
        labels: Labels,
        options: _relax.LabelSearchOptions,
        keep: Sequence[Keep],
        precision: float,
        limits: Limits,
        progress: Callable[[SearchProgress], None] | None,
    ) -> None:
        super().__init__(grounding, limits, progress)
        self.grounding = grounding
        self.labels = labels
        self.options = options
        self.count = options.count
        self.keep = keep
        self.precision = precision
        self.plans: list[ValuedTrace] = []
        self._found: dict[Key, ValuedTrace] = {}
        options.tolerance = precision / 2 if labels.worths_are_values else 0.0

    @cached_property
    def names(self) -> list[int | None]:
        """By ground action: its number in the domain; None where it has none."""
        return action_names(self.grounding)

    @property
    def proven(self) -> int:
        """How many plans, counted from the first, are proven to be the best, within the precision."""
        bound = self.bound
        return 0 if bound is None else sum(plan.value - bound <= self._slack(plan.value) for plan in self.plans)

    @property
    def is_done(self) -> bool:
        """Whether something has ended the run, or nothing is left to prove."""
        return self.stopped is not None or self._is_proven

    @property
    def _is_proven(self) -> bool:
        is_full = len(self.plans) == self.count
        return self.bound == math.inf or (is_full and self.proven == len(self.plans))

    def outcomes(self) -> Iterator[SearchOutcome]:
        """Go through the stages, and yield an outcome after every one that found a better plan, and at the end.

        All but the last have the status `SOLVED`.
        """
        try:
            for is_better in self._stages():
                if self.is_done:
                    break
                if is_better:
                    yield replace(self.outcome(), status=Status.SOLVED)
        except ENDINGS as ending:
            self.stopped = self.stopped or status_of(ending)
        yield self.outcome()

    def _stages(self) -> Iterator[bool]:
        """Go through the stages; yield whether each has found a better plan."""
        if self.is_supported:
            for support in self.labels.support(self.limits):
                self.effort += support.effort
                self.stopped = support.stopped
                bound = math.inf if support.unsolvable else support.bound
                self.bound = max((known for known in (self.bound, bound) if known is not None), default=None)
                yield self._take_up(support.traces)
        yield self.search()
        while self.labels.refine(self.limits):
            yield self.search()
        for number in (times * self.count for times in VALUED):
            if self.lists_plans and number <= MOST_VALUED:
                yield self._list(number)

    def _list(self, number: int) -> bool:
        """Search for more plans than are wanted; returns whether a better one was found.

        Values are exact, so that the bound has to hold for plans that are not in the list only. Where no grid is fine
        enough, as with continuous costs, the plans in question are often few.
        """
        self.options.count = number
        try:
            return self.search()
        finally:
            self.options.count = self.count
            del self.plans[self.count :]

    def search(self) -> bool:
        """Search on the present grid; returns whether a better plan was found.

        Where the memory is too small, a search on a coarser grid follows: it may prove more, and find another plan.
        What was proven on either holds; the gap between that and the exact value of the plan says what is lost.
        """
        self.options.upper_bound = None
        if self.count == 1 and self.plans:
            best = self.plans[0].value
            self.options.upper_bound = self.labels.worth_of(best - self._slack(best) / 2)
        is_better = self._search_once()
        while self.stopped is Status.MEMORY_LIMIT and not self._is_proven and self.labels.coarsen(self.limits):
            is_better |= self._search_once()
            self.stopped = self.stopped or Status.MEMORY_LIMIT
        return is_better

    def _search_once(self) -> bool:
        result = self.run_core()
        self.take(result.statistics, result.stop)
        self.unread = bool(result.plans)  # until all are taken up
        is_better = self._take_up(result.plans)
        self.unread = len(result.plans) < result.statistics.found
        self.bound = math.inf if result.is_all else self.bound_with(result.statistics.lower_bound)
        return is_better

    def run_core(self) -> _relax.LabelSearchResult:
        """Run the search in the core on the present grid, with the present options."""
        problem, valuation = self.grounding.handle, self.labels.valuation
        left = self.limits.sooner(2 * self.seconds_to_value).left()
        return _relax.label_search(problem, valuation, self.names, self.options, *left, self.watch)

    def outcome(self) -> SearchOutcome:
        """Return how the searches ended together."""
        is_all = self.bound == math.inf
        bound = None if is_all else self.bound
        if bound is not None and len(self.plans) == self.count:
            bound = min(bound, self.plans[-1].value)
        if self.plans:
            is_proven = is_all or self.proven == len(self.plans)
            is_optimal = is_proven and self.stopped is None and not self.unread
            status = Status.OPTIMAL if is_optimal else Status.SOLVED
            bound = self.plans[-1].value if is_all and self.count == 1 else bound
        else:
            status = self.stopped or (Status.UNSOLVABLE if is_all else Status.GAVE_UP)
        plans = TracedPlans(self.reader, [plan.trace for plan in self.plans])
        return SearchOutcome(status, self.stopped, plans, bound, self.effort, self.proven, is_all, self.unread)

    def value_of(self, worth: int) -> float:
        """Return the value that a worth of the present search stands for."""
        return self.labels.value_of(worth)

    def progress_of(
        self, statistics: _relax.LabelStatistics, seconds: float, effort: SearchEffort, bound: float | None
    ) -> SearchProgress:
        """Return what the user's callback is told while a search goes on."""
        if self.count > 1:
            found, proven = max(len(self.plans), statistics.found), max(self.proven, statistics.proven)
            return TopProgress(seconds, effort, bound, found, proven)
        best = self.plans[0].value if self.plans else None
        if statistics.best is not None:
            best = min(self.value_of(statistics.best), math.inf if best is None else best)
        return Progress(seconds, effort, bound if best is None or bound is None else min(bound, best), best)

    def _take_up(self, traces: Sequence[_relax.SearchResult]) -> bool:
        """Take up plans that were found and keep their budgets; returns whether the best is a better one.

        An interruption ends the run, but not this at first.
        """
        is_better, is_interrupted = in_spite_of_interrupt(partial(self._value, traces), self.limits)
        if is_interrupted:
            self.stopped = Status.INTERRUPTED
        return is_better

    def _value(self, traces: Sequence[_relax.SearchResult]) -> bool:
        """Take up plans as `_take_up` does, unless something ends it."""
        before = self.plans[0].value if self.plans else math.inf
        for trace in traces:
            if trace.cost is None or not self._keeps_budgets(trace):
                continue
            started = time.monotonic()
            key, plan = self._key(trace), ValuedTrace(trace, self.labels.value(trace))
            self.seconds_to_value = max(self.seconds_to_value, time.monotonic() - started)
            known = self._found.setdefault(key, plan)
            if plan.value < known.value:
                self._found[key] = plan
        self.plans = sorted(self._found.values(), key=lambda plan: plan.value)[: self.options.count]
        return bool(self.plans) and self.plans[0].value < before

    def _keeps_budgets(self, trace: _relax.SearchResult) -> bool:
        return not self.keep or all(budget.holds(self.labels.law(trace)) for budget in self.keep)

    def _slack(self, value: float) -> float:
        return self.precision * max(1.0, abs(value))

    def _key(self, trace: _relax.SearchResult) -> Key:
        if self.options.count == 1:
            return ()  # the best plan is enough
        return key_of(trace.actions, self.names, self.options.distinct)


class NetworkRun(LabelRun):
    """The same by the plan-based solver (the paper's Algorithm 3), for one plan; no other search comes first.

    Args:
        plan_based: what the core is asked for.
    """

    is_supported = False
    lists_plans = False

    def __init__(
        self,
        grounding: Grounding,
        labels: Labels,
        plan_based: _relax.PlanBasedOptions,
        keep: Sequence[Keep],
        precision: float,
        limits: Limits,
        progress: Callable[[SearchProgress], None] | None,
    ) -> None:
        super().__init__(grounding, labels, _relax.LabelSearchOptions(), keep, precision, limits, progress)
        self.plan_based = plan_based

    def run_core(self) -> _relax.LabelSearchResult:
        """Run the plan-based search in the core on the present grid."""
        self.plan_based.upper_bound, self.plan_based.tolerance = self.options.upper_bound, self.options.tolerance
        problem, valuation = self.grounding.handle, self.labels.valuation
        left = self.limits.sooner(2 * self.seconds_to_value).left()
        return _relax.plan_based_search(problem, valuation, self.plan_based, *left, self.watch)
