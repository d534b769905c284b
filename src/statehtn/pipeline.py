"""The way of every run: read, ground, price, search, validate. Whatever ends it, it ends in a result."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass, fields, replace

from statehtn.core.search import last_of
from statehtn.core.search_run import SearchOutcome
from statehtn.correlation import Correlation, value_as_if_independent
from statehtn.counted import counted
from statehtn.effort import Meter, Statistics
from statehtn.found_plan import SECONDS_TO_VALIDATE, FoundPlan, Kept, not_validated, priced, validated_and_priced
from statehtn.limits import ENDINGS, SECONDS_TO_READ, Limits, status_of, watched
from statehtn.log import log
from statehtn.model.cost.unknown import MissingNumber
from statehtn.model.problem import Problem
from statehtn.model.status import Status
from statehtn.result import Result
from statehtn.risk import Deadline, Neutral
from statehtn.session import ProgressCallback, Session, TopProgressCallback
from statehtn.settings import Settings, TopSettings
from statehtn.top_result import RankedPlan, TopPlans

Search = Callable[[Meter], Iterator[SearchOutcome]]
"""Reads, grounds, prices, and begins to search; the meter takes the time."""
MOST_VALID = 100
"""Plans of a session that are not validated again."""


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
        """What the search has proven of the value of every plan, or of every other one."""
        return None if self.outcome is None else self.outcome.lower_bound


def solutions(
    session: Session,
    settings: Settings,
    limits: Limits,
    progress: ProgressCallback | None = None,
    every_plan: bool = False,
) -> Iterator[Result]:
    """Search for a plan; yield better and better ones, if `every_plan`, and last how the run ended."""

    def search(meter: Meter) -> Iterator[SearchOutcome]:
        found = session.search(settings, limits, meter, progress)
        return found if every_plan else _last_alone(found)

    for reached in _run(session, settings, search, limits):
        found = reached.found[0] if reached.found else None
        largest: tuple[Kept, ...] = ()
        correlation: Correlation | None = None
        statistics = reached.statistics
        with suppress(*ENDINGS):  # what was found stays, also where this is not known
            largest, statistics = _largest(session, settings, limits, reached)
            correlation, statistics = _correlation(session, settings, limits, replace(reached, statistics=statistics))
        how = reached.status, settings, statistics, reached.stopped, reached.unread, largest
        result = Result(*how, found, reached.bound, correlation)
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

    def search(meter: Meter) -> Iterator[SearchOutcome]:
        return session.search_top(settings, limits, meter, progress)

    reached = last_of(_run(session, settings, search, limits))
    proven = 0 if reached.outcome is None else reached.outcome.proven
    plans = tuple(_ranked(reached.found, proven))
    is_all = reached.outcome is not None and reached.outcome.is_all and reached.stopped is None
    bound = reached.bound
    if plans and bound is not None:  # equal to the last plan's, rounding aside
        bound = min(bound, plans[-1].value)
    elif reached.unread:
        bound = None
    largest, statistics = _largest(session, settings, limits, reached)
    how = reached.status, settings, statistics, reached.stopped, reached.unread, largest
    result = TopPlans(*how, plans, is_all, bound)
    found, seconds = counted(len(plans), "plan"), reached.statistics.search_seconds or 0.0
    log.info("search: %s, %d proven, %.3f s", found, proven, seconds)
    return result


def _largest(
    session: Session, settings: Settings | TopSettings, limits: Limits, reached: Reached
) -> tuple[tuple[Kept, ...], Statistics]:
    """Return how well each budget can be kept by itself where no plan keeps all of them, and the effort with that.

    Nothing is known of a budget for which a limit ended the search. Empty where there is a plan, or none whatever the
    budgets.
    """
    statistics = reached.statistics
    if reached.status is not Status.UNSOLVABLE:
        return (), statistics
    largest: list[Kept] = []
    for keep in settings.keep:
        if largest and largest[-1].attained is None:  # a limit was reached, or Ctrl-C was pressed
            largest.append(Kept(keep.budget, keep.probability, None))
            continue
        on_time = Settings.of(Deadline(keep.budget), heuristic=settings.heuristic, precision=settings.precision)
        best = solve(session, on_time, limits)
        statistics = statistics.and_search(best.statistics)
        if best.status is Status.UNSOLVABLE:
            return (), statistics
        attained = at_most = None
        if best.plan is not None and best.lower_bound is not None and best.stopped is None:
            attained = keep.attained(best.plan.cost_distribution())
            at_most = max(attained, 1 - best.lower_bound)
        largest.append(Kept(keep.budget, keep.probability, attained, at_most))
    return tuple(largest), statistics


def _correlation(
    session: Session, settings: Settings, limits: Limits, reached: Reached
) -> tuple[Correlation | None, Statistics]:
    """Return what it is worth to know that costs hang together, and the effort with that.

    None where they do not, where that makes no difference to the mean, or where a limit left it unknown.
    """
    independent = session.as_if_independent()
    is_known = reached.status is Status.OPTIMAL and reached.found and not isinstance(settings.objective, Neutral)
    if independent is None or not is_known:
        return None, reached.statistics

    def search(meter: Meter) -> Iterator[SearchOutcome]:
        return _last_alone(independent.search(settings, limits, meter, None))

    other = last_of(_run(independent, settings, search, limits))
    statistics = reached.statistics.and_search(other.statistics)
    chosen = other.found[0] if other.found and other.status is Status.OPTIMAL else None
    believed = None if chosen is None else value_as_if_independent(chosen.plan, settings.objective)
    if chosen is None or believed is None:
        return None, statistics
    return Correlation(chosen, believed, chosen.value - reached.found[0].value), statistics


def _run(session: Session, settings: Settings | TopSettings, search: Search, limits: Limits) -> Iterator[Reached]:
    """Go through all phases; yield what is reached with every outcome of the search, and last how the run ended.

    A limit or an interruption ends it with what was reached by then, in whichever phase, or between two of them.
    """
    meter = Meter()
    latest = Reached(Status.INTERRUPTED, None, meter.statistics)
    try:
        for latest in _phases(session, settings, search, limits, meter):
            yield latest
    except ENDINGS as ending:
        by = status_of(ending)
        status = Status.SOLVED if latest.found else by
        log.info("the run ended: %s", by)
        yield replace(latest, status=status, stopped=by, statistics=meter.read())


def _phases(
    session: Session, settings: Settings | TopSettings, search: Search, limits: Limits, meter: Meter
) -> Iterator[Reached]:
    outcomes = search(meter)
    problem = session.read(limits, meter)
    traces: Sequence[object] = []
    found: tuple[FoundPlan, ...] = ()
    unpriced: MissingNumber | None = None
    stop: Status | None = None
    while True:
        with meter.timed("search"):
            outcome = next(outcomes, None)
        if outcome is None:
            break
        meter.note(search=outcome.effort)
        is_unread = outcome.unread
        if outcome.plans.results != traces:  # the last outcome mostly has the plan of the one before
            try:
                with meter.timed("validate"):
                    read, stop = _validated(session, problem, outcome, settings, limits)
            except MissingNumber as error:
                unpriced = error  # a better plan may do without the number
                continue
            traces, unpriced = outcome.plans.results, None
            found = read or found
            is_unread = is_unread or len(read) < len(outcome.plans)
        status = outcome.status if stop is None else Status.SOLVED if found else stop
        yield Reached(status, outcome.stopped or stop, meter.read(), outcome, found, is_unread)
        if stop is not None:
            break
    if unpriced is not None:
        raise unpriced


def _validated(
    session: Session, problem: Problem, outcome: SearchOutcome, settings: Settings | TopSettings, limits: Limits
) -> tuple[tuple[FoundPlan, ...], Status | None]:
    """Put plans together, validate and price them; return as many as were put together, and what ended that.

    Once something has ended validation, the others come as the search has them. What comes from outside ends no more
    than that at first: the rest is put together within another second, unless the search was interrupted already.

    Raises:
        InternalError: a plan is wrong.
        MissingNumber: a cost needs a number that `:init` does not give.
    """
    is_over = outcome.stopped is not None
    left = limits.with_grace(SECONDS_TO_VALIDATE, is_over=is_over)
    wanted = settings.objective, settings.keep
    found: list[FoundPlan] = []
    stopped: Status | None = None
    try:
        for plan in outcome.plans.read(limits.with_grace(SECONDS_TO_READ, is_over=is_over)):
            if plan in session.valid:  # a sweep finds the same plan again and again
                found.append(priced(session.valid[plan], *wanted))
                continue
            found.append(validated_and_priced(problem, plan, *wanted, left))
            stopped = found[-1].unchecked
            if stopped is not None:
                break
            if len(session.valid) < MOST_VALID:
                session.valid[plan] = found[-1].plan
    except ENDINGS as ending:
        stopped = status_of(ending)
        if stopped is not Status.INTERRUPTED or outcome.stopped is Status.INTERRUPTED:
            return tuple(found), stopped
    if stopped is not None:
        left = limits.with_grace(SECONDS_TO_READ, is_over=True)
        with suppress(*ENDINGS), watched(left):
            found += (not_validated(plan, *wanted, stopped) for plan in outcome.plans.read(left, len(found)))
    return tuple(found), stopped


def _last_alone(outcomes: Iterable[SearchOutcome]) -> Iterator[SearchOutcome]:
    yield last_of(outcomes)


def _ranked(found: Sequence[FoundPlan], proven: int) -> Iterator[RankedPlan]:
    """Yield the plans in their order.

    The core compares costs that are rounded down, so that plans that are equally good come in any order.
    """

    def place(one: FoundPlan) -> tuple[float, int, list[str]]:
        return float(f"{one.value:.14g}"), one.length, [str(step.step) for step in one.steps]

    in_order = sorted(found[:proven], key=place) + sorted(found[proven:], key=place)
    for index, one in enumerate(in_order):
        known = {field.name: getattr(one, field.name) for field in fields(FoundPlan)}
        yield RankedPlan(**known, rank=index + 1, is_proven=index < proven)


def _tell(result: Result) -> None:
    """Log how far a search has come."""
    plan = "no plan"
    if result.found is not None:
        plan = f"a plan of {counted(result.found.length, 'step')} for {result.found.value:.10g}"
    bound = "no bound" if result.lower_bound is None else f"bound {result.lower_bound:.10g}"
    seconds = result.statistics.search_seconds or 0.0
    log.info("search: %s, %s, %s after %.3f s", result.status, plan, bound, seconds)
