"""A problem for any number of runs, and the search that does what is asked of it."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace
from functools import partial
from typing import Any

from statehtn.compatible import LABEL_SWITCHES
from statehtn.core.grounding import Grounding, GroundingSwitches, ground
from statehtn.core.plan_based import search_networks
from statehtn.core.pricing import PricedProblem, price
from statehtn.core.progress import Progress, TopProgress
from statehtn.core.search import improving_plans
from statehtn.core.search_run import SearchOutcome
from statehtn.core.searches import TAKES
from statehtn.core.top_plans import find_top_plans
from statehtn.effort import Meter
from statehtn.errors import UnsupportedError, UsageError
from statehtn.limits import Limits
from statehtn.log import log
from statehtn.model.cost.scenario_cost import as_if_independent
from statehtn.model.plan import Plan
from statehtn.model.problem import Problem
from statehtn.model.status import Status
from statehtn.risk import AdditiveObjective, Neutral, SuccessUtility
from statehtn.settings import Settings, TopSettings

ProgressCallback = Callable[[Progress], None]
TopProgressCallback = Callable[[TopProgress], None]


class Session:
    """A problem for any number of runs: read once, grounded once, and priced once for each objective that has prices.

    A phase that a limit or an interruption ends is begun anew by the next run.

    Args:
        source: the problem, or a function that reads it within limits.
    """

    def __init__(self, source: Problem | Callable[[Limits], Problem]) -> None:
        self.source = source
        self.problem = source if isinstance(source, Problem) else None
        self._grounding: Grounding | None = None
        self._for_policies: Grounding | None = None
        self.valid: dict[Plan, Plan] = {}
        """Plans that were found to be valid, with what their steps cost."""
        self._priced: dict[AdditiveObjective, PricedProblem] = {}

    def read(self, limits: Limits, meter: Meter) -> Problem:
        """Return the problem."""
        if not isinstance(self.source, Problem) and self.problem is None:
            with meter.timed("parse"):
                self.problem = self.source(limits)
            log.info("reading: %.3f s, %s", meter.statistics.parse_seconds, self.problem)
        assert self.problem is not None
        return self.problem

    def ground(self, limits: Limits, meter: Meter, counts_on_outcomes: bool = False) -> Grounding:
        """Return the ground problem, and note how large it is.

        Args:
            limits: they hold.
            meter: takes the time.
            counts_on_outcomes: whether plans count on one outcome of each action, of which there may be several.

        Raises:
            UnsupportedError: an action has several outcomes.
        """
        problem = self.read(limits, meter)
        if not counts_on_outcomes:
            _refuse_outcomes(problem)
        with meter.timed("ground"):
            if self._grounding is None:
                self._grounding = ground(problem, limits)
        return _measured(self._grounding, meter)

    def ground_for_policies(self, limits: Limits, meter: Meter) -> Grounding:
        """Return the ground problem in which methods are whole, and note how large it is.

        Where a method is split, its parts are chosen one after the other: an agent could choose one after it has seen
        what came of another, which choosing the method does not allow.
        """
        problem = self.read(limits, meter)
        with meter.timed("ground"):
            if self._for_policies is None:
                self._for_policies = ground(problem, limits, GroundingSwitches(split_methods=False))
        return _measured(self._for_policies, meter)

    def price(self, objective: AdditiveObjective, limits: Limits, meter: Meter) -> PricedProblem:
        """Return the ground problem with the prices of its actions."""
        grounding = self.ground(limits, meter, isinstance(objective, SuccessUtility))
        with meter.timed("search"):
            if objective not in self._priced:
                self._priced[objective] = price(grounding, objective, limits)
        return self._priced[objective]

    def forget(self, objective: AdditiveObjective) -> None:
        """Keep the prices of an objective no longer."""
        self._priced.pop(objective, None)

    def search(
        self, settings: Settings, limits: Limits, meter: Meter, progress: ProgressCallback | None
    ) -> Iterator[SearchOutcome]:
        """Read, ground and price the problem, and return the search for a plan, which begins with its first outcome."""
        if settings.needs_labels or self._hangs_together(settings, limits, meter):
            _refuse_what_needs_prices(settings)
            if settings.search == "greedy":
                return map(_by_the_mean, self.search(replace(settings, objective=Neutral()), limits, meter, progress))
            return self._by_labels(_label_search(settings), settings, limits, meter, progress)
        problem = self.price(settings.prices, limits, meter)
        if settings.solver == "plan":
            heuristic, branch = settings.heuristic, settings.branch
            return search_networks(problem, heuristic=heuristic, branch=branch, limits=limits, progress=progress)
        by = settings.heuristic, settings.search, settings.weight
        return improving_plans(problem, *by, limits, progress, settings.switches)

    def search_top(
        self, settings: TopSettings, limits: Limits, meter: Meter, progress: TopProgressCallback | None
    ) -> Iterator[SearchOutcome]:
        """Read, ground and price the problem, and return the search for the best plans."""
        k, distinct, heuristic = settings.k, settings.distinct, settings.heuristic
        if settings.needs_labels or self._hangs_together(settings, limits, meter):
            return self._by_labels(_label_search(settings), settings, limits, meter, progress)
        problem = self.price(settings.prices, limits, meter)

        def search() -> Iterator[SearchOutcome]:  # begins when its outcome is asked for
            yield find_top_plans(problem, k, distinct=distinct, heuristic=heuristic, limits=limits, progress=progress)

        return search()

    def as_if_independent(self) -> Session | None:
        """Return a session for the same ground problem, whose costs hang together, in which they are independent.

        Each action has the law that its cost has over all scenarios. None where costs are independent anyway, or have
        no list of outcomes.
        """
        grounding = self._grounding
        if grounding is None or not grounding.has_scenarios:
            return None
        laws, part_laws = as_if_independent(grounding.laws), as_if_independent(grounding.part_laws)
        if laws is None or part_laws is None:
            return None
        session = Session(self.source)
        session.problem = self.problem
        session._grounding = replace(grounding, laws=laws, part_laws=part_laws)
        return session

    def _hangs_together(self, settings: Settings | TopSettings, limits: Limits, meter: Meter) -> bool:
        """Tell whether costs hang together, so that prices for this objective do not add up."""
        return not isinstance(settings.objective, Neutral) and self._ground_for(settings, limits, meter).has_scenarios

    def _ground_for(self, settings: Settings | TopSettings, limits: Limits, meter: Meter) -> Grounding:
        return self.ground(limits, meter, isinstance(settings.objective, SuccessUtility))

    def _by_labels(
        self,
        search: Callable[..., Iterator[SearchOutcome]],
        settings: Settings | TopSettings,
        limits: Limits,
        meter: Meter,
        progress: Any,
    ) -> Iterator[SearchOutcome]:
        grounding = self.ground(limits, meter)
        what = {"keep": settings.keep, "precision": settings.precision}
        with meter.timed("search"):
            return search(grounding, settings.objective, **what, limits=limits, progress=progress)


def _measured(found: Grounding, meter: Meter) -> Grounding:
    """Return a ground problem whose size is noted."""
    sizes = {"facts": found.fact_count, "actions": found.action_count}
    meter.note(**sizes, tasks=found.task_count, methods=found.method_count)
    log.info("grounding: %.3f s, %s", meter.statistics.ground_seconds, meter.statistics.sizes)
    return found


def _label_search(settings: Settings | TopSettings) -> Callable[..., Iterator[SearchOutcome]]:
    """Return the search over labels that is asked for."""
    from statehtn.core.label_search import search_labels, search_networks_by_labels  # most runs do without

    if isinstance(settings, TopSettings):
        return partial(search_labels, k=settings.k, distinct=settings.distinct, heuristic=settings.heuristic)
    if settings.solver == "plan":
        return partial(search_networks_by_labels, branch=settings.branch)
    takes = TAKES["state", "top"]
    heuristic = settings.heuristic if settings.heuristic in takes else takes[0]
    return partial(search_labels, heuristic=heuristic, switches=settings.label_switches)


def _refuse_what_needs_prices(settings: Settings) -> None:
    """Refuse what takes prices that add up, where an objective has them but for costs that hang together.

    Raises:
        UsageError: something does.
    """
    if settings.search == "weighted":
        raise UsageError(
            f"the weighted search adds up prices of actions, which '{settings.objective}' has none of where costs "
            f"hang together; take astar or anytime"
        )
    if lacking := [name for name in settings.without if name not in LABEL_SWITCHES]:
        raise UsageError(
            f"the search by '{settings.objective}' where costs hang together has no refinement '{lacking[0]}'"
        )


def _by_the_mean(outcome: SearchOutcome) -> SearchOutcome:
    """Return what a search by the mean says of another objective: there is a plan."""
    status = Status.SOLVED if outcome.status is Status.OPTIMAL else outcome.status
    return replace(outcome, status=status, lower_bound=None)


def _refuse_outcomes(problem: Problem) -> None:
    """Refuse actions with several outcomes: what to do next depends on what has come, which no plan can tell."""
    for action in problem.domain.actions.values():
        for block in action.outcomes:
            raise UnsupportedError(
                f"action '{action.name}' changes facts by chance, which no plan, a sequence of actions, can answer; a "
                f"policy can: statehtn.policy, or 'statehtn policy'",
                block.place,
            )
