"""The runs of a sweep: many searches of one session, under common limits, told of as one."""

from __future__ import annotations

import time
from collections.abc import Iterator
from dataclasses import fields, replace

from statehtn.compatible import SWEEP_SWITCHES, heuristics_for
from statehtn.core.progress import Progress
from statehtn.core.search import last_of
from statehtn.effort import SearchEffort, Statistics
from statehtn.limits import Limits
from statehtn.model.cost.ground_cost import is_unconditional
from statehtn.model.status import Status
from statehtn.pipeline import solutions, solve_top
from statehtn.result import Result
from statehtn.risk import AdditiveObjective, Keep, Objective
from statehtn.session import ProgressCallback, Session
from statehtn.settings import DistinctName, Settings, TopSettings
from statehtn.top_result import TopPlans


class Runs:
    """Searches of one problem for one objective after the other.

    Args:
        session: the problem.
        settings: how to search; the objective is that of each run.
        limits: they hold for all runs together.
        progress: is called while a run goes on, with what is known of the sweep.
    """

    def __init__(
        self, session: Session, settings: Settings, limits: Limits, progress: ProgressCallback | None = None
    ) -> None:
        self.session = session
        without = tuple(name for name in settings.without if name not in SWEEP_SWITCHES)
        self.settings = replace(settings, without=without)
        self.limits = limits
        self.progress = progress
        self.started = time.monotonic()
        self.statistics = Statistics()
        self.stopped: Status | None = None
        self.unread = False
        self.count = 0
        self.bound: float | None = None
        """What is proven of the value of every plan, for the progress."""
        self.best: float | None = None
        """The value of the best plan known, for the progress."""

    @property
    def has_scenarios(self) -> bool:
        """Whether costs hang together, so that certainty equivalents do not add up; known after the first run."""
        problem = self.session.problem
        return problem is not None and bool(problem.scenarios)

    @property
    def order_matters(self) -> bool:
        """Whether the same actions may have other costs in another order; known after the first run."""
        problem = self.session.problem
        actions = () if problem is None else problem.domain.actions.values()
        return not all(is_unconditional(block) for action in actions for block in action.costs)

    def run(self, objective: Objective, keep: tuple[Keep, ...] = ()) -> Result:
        """Search for the best plan by an objective, of those that keep budgets, and prove that it is."""
        takes = heuristics_for(self.settings.solver, "astar", objective, keep)
        heuristic = self.settings.heuristic if self.settings.heuristic in takes else takes[0]
        settings = replace(self.settings, objective=objective, keep=keep, search="astar", heuristic=heuristic)
        return last_of(self._results(settings, every_plan=False))

    def improving(self, objective: Objective) -> Iterator[Result]:
        """Search as the settings say; yield better and better plans where that is `anytime`, and last how it ended."""
        settings = replace(self.settings, objective=objective)
        return self._results(settings, every_plan=settings.search == "anytime")

    def top(self, objective: Objective, k: int, distinct: DistinctName = "sequence") -> TopPlans:
        """Search for the k best plans by an objective."""
        settings = TopSettings.of(k, objective, distinct, precision=self.settings.precision)
        result = solve_top(self.session, settings, self.limits)
        self.statistics = _together(self.statistics, result.statistics)
        self.stopped = result.stopped
        self.count += 1
        return result

    def _results(self, settings: Settings, every_plan: bool) -> Iterator[Result]:
        before = self.statistics
        for result in solutions(self.session, settings, self.limits, self._told(), every_plan):
            self.statistics = _together(before, result.statistics)
            self.stopped, self.unread = result.stopped, result.unread
            yield result
        if isinstance(settings.objective, AdditiveObjective):
            self.session.forget(settings.objective)
        self.count += 1

    def _told(self) -> ProgressCallback | None:
        progress = self.progress
        if progress is None:
            return None
        before = self.statistics.search or SearchEffort()

        def tell(now: Progress) -> None:
            seconds = time.monotonic() - self.started
            progress(Progress(seconds, before + now.effort, self.bound, self.best))

        return tell


def _together(one: Statistics, more: Statistics) -> Statistics:
    """Return the effort of two runs, the second of which was later; sizes and the peak of memory are its own."""
    added = {}
    for name in (field.name for field in fields(Statistics)):
        if name == "search" or name.endswith("_seconds"):
            before, now = getattr(one, name), getattr(more, name)
            added[name] = before if now is None else now if before is None else before + now
    return replace(more, **added)
