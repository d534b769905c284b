"""The way of every run: read, ground, price, search, validate. Whatever ends it, it ends in a result."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace

from statehtn.core.grounding import Grounding, ground
from statehtn.core.plan_based import search_networks
from statehtn.core.pricing import PricedProblem, price
from statehtn.core.progress import Progress, TopProgress
from statehtn.core.search import improving_plans, last_of
from statehtn.core.search_run import SearchOutcome
from statehtn.core.top_plans import find_top_plans
from statehtn.counted import counted
from statehtn.effort import Meter, Statistics
from statehtn.found_plan import SECONDS_TO_VALIDATE, FoundPlan, not_validated, validated_and_priced
from statehtn.limits import ENDINGS, SECONDS_TO_READ, Limits, status_of
from statehtn.log import log
from statehtn.model.cost.unknown import MissingNumber
from statehtn.model.problem import Problem
from statehtn.model.status import Status
from statehtn.result import Result
from statehtn.risk import Utility
from statehtn.settings import Settings, TopSettings
from statehtn.top_result import RankedPlan, TopPlans

ProgressCallback = Callable[[Progress], None]
TopProgressCallback = Callable[[TopProgress], None]


class Session:
    """A problem for any number of runs: read once, grounded once, and priced once for each agent.

    A phase that a limit or an interruption ends is begun anew by the next run.

    Args:
        source: the problem, or a function that reads it within limits.
    """

    def __init__(self, source: Problem | Callable[[Limits], Problem]) -> None:
        self.source = source
        self.problem = source if isinstance(source, Problem) else None
        self._grounding: Grounding | None = None
        self._priced: dict[Utility, PricedProblem] = {}

    def read(self, limits: Limits, meter: Meter) -> Problem:
        """Return the problem."""
        if not isinstance(self.source, Problem) and self.problem is None:
            with meter.timed("parse"):
                self.problem = self.source(limits)
            log.info("reading: %.3f s, %s", meter.statistics.parse_seconds, self.problem)
        assert self.problem is not None
        return self.problem

    def ground(self, limits: Limits, meter: Meter) -> Grounding:
        """Return the ground problem, and note how large it is."""
        problem = self.read(limits, meter)
        with meter.timed("ground"):
            if self._grounding is None:
                self._grounding = ground(problem, limits)
        found = self._grounding
        sizes = {"facts": found.fact_count, "actions": found.action_count}
        meter.note(**sizes, tasks=found.task_count, methods=found.method_count)
        log.info("grounding: %.3f s, %s", meter.statistics.ground_seconds, meter.statistics.sizes)
        return found

    def price(self, objective: Utility, limits: Limits, meter: Meter) -> PricedProblem:
        """Return the ground problem with the prices of its actions for an agent."""
        grounding = self.ground(limits, meter)
        with meter.timed("search"):
            if objective not in self._priced:
                self._priced[objective] = price(grounding, objective, limits)
        return self._priced[objective]


@dataclass(frozen=True, slots=True)
class Reached:
    """How far a run has come, or how it ended.

    Args:
        status: how it ended; `SOLVED` where it goes on from a plan.
        stopped: what ended it before it was done; None for nothing.
        statistics: the effort.
        outcome: what the search has found and proven; None where nothing.
        found: the plans, validated and priced.
        unread: more plans were found, or a better one, that could not be put together before the run was stopped.
    """

    status: Status
    stopped: Status | None
    statistics: Statistics
    outcome: SearchOutcome | None = None
    found: tuple[FoundPlan, ...] = ()
    unread: bool = False

    @property
    def bound(self) -> float | None:
        """What the search has proven of the risk cost of every plan, or of every other one."""
        return None if self.outcome is None else self.outcome.lower_bound


def solutions(
    session: Session,
    settings: Settings,
    limits: Limits,
    progress: ProgressCallback | None = None,
    every_plan: bool = False,
) -> Iterator[Result]:
    """Search for a plan; yield better and better ones, if `every_plan`, and last how the run ended."""

    def search(problem: PricedProblem) -> Iterator[SearchOutcome]:
        if settings.solver == "plan":
            heuristic, branch = settings.heuristic, settings.branch
            found = search_networks(problem, heuristic=heuristic, branch=branch, limits=limits, progress=progress)
        else:
            how = settings.heuristic, settings.search, settings.weight
            found = improving_plans(problem, *how, limits, progress, settings.switches)
        return found if every_plan else _last_alone(found)

    for reached in _run(session, settings.objective, search, limits):
        found = reached.found[0] if reached.found else None
        how = reached.status, settings, reached.statistics, reached.stopped, reached.unread
        result = Result(*how, found, reached.bound)
        _tell(result)
        yield result


def solve(session: Session, settings: Settings, limits: Limits, progress: ProgressCallback | None = None) -> Result:
    """Search for a plan; return how the run ended."""
    return last_of(solutions(session, settings, limits, progress))


def any_plan(problem: Problem, limits: Limits) -> Result:
    """Find any plan, or prove that there is none."""
    session = Session(problem)
    result = solve(session, Settings.of(search="greedy"), limits)
    return solve(session, Settings.of(), limits) if result.status is Status.GAVE_UP else result


def solve_top(
    session: Session, settings: TopSettings, limits: Limits, progress: TopProgressCallback | None = None
) -> TopPlans:
    """Search for the best plans; return how the run ended."""

    def search(problem: PricedProblem) -> Iterator[SearchOutcome]:
        k, distinct, heuristic = settings.k, settings.distinct, settings.heuristic
        yield find_top_plans(problem, k, distinct=distinct, heuristic=heuristic, limits=limits, progress=progress)

    reached = last_of(_run(session, settings.objective, search, limits))
    proven = 0 if reached.outcome is None else reached.outcome.proven
    plans = tuple(_ranked(reached.found, proven))
    is_all = reached.outcome is not None and reached.outcome.is_all and reached.stopped is None
    bound = reached.bound
    if plans and bound is not None:  # equal to the last plan's, rounding aside
        bound = min(bound, plans[-1].risk_cost)
    elif reached.unread:
        bound = None
    how = reached.status, settings, reached.statistics, reached.stopped, reached.unread
    result = TopPlans(*how, plans, is_all, bound)
    found, seconds = counted(len(plans), "plan"), reached.statistics.search_seconds or 0.0
    log.info("search: %s, %d proven, %.3f s", found, proven, seconds)
    return result


def _run(
    session: Session,
    objective: Utility,
    search: Callable[[PricedProblem], Iterator[SearchOutcome]],
    limits: Limits,
) -> Iterator[Reached]:
    """Go through all phases; yield what is reached with every outcome of the search, and last how the run ended.

    A limit or an interruption ends it with what was reached by then, in whichever phase, or between two of them.
    """
    meter = Meter()
    latest = Reached(Status.INTERRUPTED, None, meter.statistics)
    try:
        for latest in _phases(session, objective, search, limits, meter):
            yield latest
    except ENDINGS as ending:
        by = status_of(ending)
        status = Status.SOLVED if latest.found else by
        log.info("the run ended: %s", by)
        yield replace(latest, status=status, stopped=by, statistics=meter.read())


def _phases(
    session: Session,
    objective: Utility,
    search: Callable[[PricedProblem], Iterator[SearchOutcome]],
    limits: Limits,
    meter: Meter,
) -> Iterator[Reached]:
    priced = session.price(objective, limits, meter)
    problem = session.read(limits, meter)
    outcomes = search(priced)
    traces: Sequence[object] = []
    found: tuple[FoundPlan, ...] = ()
    unpriced: MissingNumber | None = None
    while True:
        with meter.timed("search"):
            outcome = next(outcomes, None)
        if outcome is None:
            break
        meter.note(search=outcome.effort)
        unread: Status | None = None
        if outcome.plans.results != traces:  # the last outcome mostly has the plan of the one before
            try:
                with meter.timed("validate"):
                    read, unread = _validated(problem, outcome, objective, limits)
            except MissingNumber as error:
                unpriced = error  # a better plan may do without the number
                continue
            traces, unpriced = outcome.plans.results, None
            found = read or found
        stop = unread or (found[-1].unchecked if found else None)
        status = outcome.status if stop is None else Status.SOLVED if found else stop
        is_unread = outcome.unread or unread is not None
        yield Reached(status, outcome.stopped or stop, meter.read(), outcome, found, is_unread)
        if unread is not None:
            break
    if unpriced is not None:
        raise unpriced


def _validated(
    problem: Problem, outcome: SearchOutcome, objective: Utility, limits: Limits
) -> tuple[tuple[FoundPlan, ...], Status | None]:
    """Put plans together, validate and price them; return them, and what ended that before all were put together.

    Once something has ended validation, the others come as the search has them.

    Raises:
        InternalError: a plan is wrong.
        MissingNumber: a cost needs a number that `:init` does not give.
    """
    is_over = outcome.stopped is not None
    left = limits.with_grace(SECONDS_TO_VALIDATE, is_over=is_over)
    found: list[FoundPlan] = []
    stopped: Status | None = None
    try:
        for plan in outcome.plans.read(limits.with_grace(SECONDS_TO_READ, is_over=is_over)):
            if stopped is None:
                found.append(validated_and_priced(problem, plan, objective, left))
                stopped = found[-1].unchecked
            else:
                found.append(not_validated(plan, objective, stopped))
    except ENDINGS as ending:
        return tuple(found), status_of(ending)
    return tuple(found), None


def _last_alone(outcomes: Iterable[SearchOutcome]) -> Iterator[SearchOutcome]:
    yield last_of(outcomes)


def _ranked(found: Sequence[FoundPlan], proven: int) -> Iterator[RankedPlan]:
    """Yield the plans in their order.

    The core compares costs that are rounded down, so that plans that are equally good come in any order.
    """

    def place(one: FoundPlan) -> tuple[float, int, list[str]]:
        return float(f"{one.risk_cost:.14g}"), one.length, [str(step.step) for step in one.steps]

    in_order = sorted(found[:proven], key=place) + sorted(found[proven:], key=place)
    for index, one in enumerate(in_order):
        yield RankedPlan(one.plan, one.steps, one.utility, one.unchecked, index + 1, index < proven)


def _tell(result: Result) -> None:
    """Log how far a search has come."""
    plan = "no plan"
    if result.found is not None:
        plan = f"a plan of {counted(result.found.length, 'step')} for {result.found.risk_cost:.10g}"
    bound = "no bound" if result.lower_bound is None else f"bound {result.lower_bound:.10g}"
    seconds = result.statistics.search_seconds or 0.0
    log.info("search: %s, %s, %s after %.3f s", result.status, plan, bound, seconds)
