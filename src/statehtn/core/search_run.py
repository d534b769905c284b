"""What the searches of one run share, on one scale of prices after the other: limits, effort, and what is proven."""

from __future__ import annotations

import time
from abc import ABC, abstractmethod
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, fields
from typing import Generic, TypeVar

import statehtn._relax as _relax
from statehtn.core.grounding import STOPPED, Grounding
from statehtn.core.pricing import PricedProblem
from statehtn.core.progress import SearchProgress
from statehtn.core.scale import Scale
from statehtn.core.trace import TraceReader
from statehtn.effort import SearchEffort
from statehtn.limits import Limits
from statehtn.model.plan import Plan
from statehtn.model.status import Status

P = TypeVar("P", bound=SearchProgress)
S = TypeVar("S", bound=_relax.SearchStatistics)


@dataclass(frozen=True, slots=True)
class TracedPlans:
    """Plans that the core has found, each read when it is asked for: that takes longer than finding it."""

    reader: TraceReader
    results: Sequence[_relax.SearchResult]

    def __len__(self) -> int:
        return len(self.results)

    def __iter__(self) -> Iterator[Plan]:
        return self.read(Limits())

    def read(self, limits: Limits, first: int = 0) -> Iterator[Plan]:
        """Yield the plans from the `first` one on.

        Raises:
            LimitReached: a limit was reached before the next one was read.
        """
        return (self.reader.read(result, limits) for result in self.results[first:])


@dataclass(frozen=True, slots=True)
class SearchOutcome:
    """How a search ended, or how far it has come.

    Args:
        status: how it ended; `SOLVED` where it goes on from a plan.
        stopped: what ended it before it was done, with or without a plan; None for nothing.
        plans: those that were found, the best first; read when they are asked for.
        lower_bound: a lower bound of the value of every plan (of a search for several: of every other one); None if
            there is none.
        effort: of all its stages together.
        proven: of a search for several plans: the first so many of them are the best there are.
        is_all: of such a search: there are no other plans.
        unread: a plan was found, or a better one, that could not be put together before the search was stopped.
    """

    status: Status
    stopped: Status | None
    plans: TracedPlans
    lower_bound: float | None
    effort: SearchEffort
    proven: int = 0
    is_all: bool = False
    unread: bool = False

    @property
    def plan(self) -> Plan | None:
        """The best plan; None where none was found."""
        return next(iter(self.plans), None)


class SearchRun(ABC, Generic[P, S]):
    """Searches for the plans of a problem, one after the other: the effort and the best bound of all of them.

    Args:
        grounding: the ground problem.
        limits: they hold for all searches together.
        progress: is called while a search goes on.
    """

    def __init__(self, grounding: Grounding, limits: Limits, progress: Callable[[P], None] | None) -> None:
        self.limits = limits
        self.progress = progress
        self.started = time.monotonic()
        self.reader = TraceReader(grounding)
        self.bound: float | None = None  # of what plans are worth, whatever the scale it was proven on
        self.stopped: Status | None = None
        self.effort = SearchEffort()
        self.unread = False

    @property
    def watch(self) -> Callable[[S], None] | None:
        """What the core calls while it searches."""
        return None if self.progress is None else self._report

    @abstractmethod
    def value_of(self, worth: int) -> float:
        """Return what a worth of the present search is in the unit of the objective."""

    @abstractmethod
    def progress_of(self, statistics: S, seconds: float, effort: SearchEffort, bound: float | None) -> P:
        """Return what the user's callback is told while a search goes on.

        Args:
            statistics: of this search.
            seconds: since the first one began.
            effort: of all searches, this one included.
            bound: the best lower bound of all of them.
        """

    def take(self, statistics: S, stop: _relax.StopReason | None) -> None:
        """Take up what a search has cost, and what ended it."""
        self.effort += effort_of(statistics)
        self.stopped = None if stop is None else STOPPED[stop]

    def bound_with(self, worth: int | None) -> float | None:
        """Return the best lower bound of all searches and one of the present search."""
        bound = None if worth is None else self.value_of(worth)
        return max((known for known in (self.bound, bound) if known is not None), default=None)

    def _report(self, statistics: S) -> None:
        assert self.progress is not None
        seconds, effort = time.monotonic() - self.started, self.effort + effort_of(statistics)
        self.progress(self.progress_of(statistics, seconds, effort, self.bound_with(statistics.lower_bound)))


class PricedRun(SearchRun[P, S]):
    """Searches for plans whose actions have prices that add up, on one scale of prices after the other."""

    def __init__(self, problem: PricedProblem, limits: Limits, progress: Callable[[P], None] | None) -> None:
        super().__init__(problem.grounding, limits, progress)
        self.problem = problem
        self.prices = problem.on(Scale.first(problem.bounds()))

    def value_of(self, worth: int) -> float:
        """Return an amount of units as a cost in the domain's own unit."""
        return self.prices.scale.cost(worth)

    def rescale(self, scale: Scale) -> bool:
        """Go on with another scale; returns whether it is another one."""
        if scale == self.prices.scale:
            return False
        self.prices = self.problem.on(scale)
        return True


def effort_of(statistics: _relax.SearchStatistics) -> SearchEffort:
    """Return the effort of a search in the core."""
    return SearchEffort(*(getattr(statistics, field.name) for field in fields(SearchEffort)))
