"""The planner as a whole: read, ground, search, validate; every run ends in a `Result`, whatever ends it."""

from __future__ import annotations

import os
import time
from collections.abc import Callable, Iterator
from dataclasses import replace

from statehtn.core.grounding import Grounding, ground
from statehtn.core.plan_based import search_plans
from statehtn.core.progress import Progress
from statehtn.core.search import improving_plans, last_of
from statehtn.core.staged_run import SearchOutcome
from statehtn.counted import counted
from statehtn.effort import Statistics, peak_memory_mb
from statehtn.expected import function
from statehtn.found_plan import SECONDS_TO_VALIDATE, validated_and_priced
from statehtn.hddl import read_hddl
from statehtn.interrupt import OnInterrupt, check_interrupt, returned
from statehtn.limits import ENDINGS, STOPS, Limits, status_of, watched
from statehtn.log import log
from statehtn.model.cost.unknown import MissingNumber
from statehtn.model.expect import expect_problem
from statehtn.model.problem import Problem
from statehtn.model.status import Status
from statehtn.query import BranchName, HeuristicName, Query, SearchName, SolverName
from statehtn.result import Result
from statehtn.risk import Attitude, AttitudeName, problem_class

ProgressCallback = Callable[[Progress], None]


def plan(
    problem: Problem,
    *,
    attitude: Attitude | AttitudeName = Attitude.NEUTRAL,
    alpha: float | None = None,
    solver: SolverName = "state",
    heuristic: HeuristicName | None = None,
    search: SearchName = "astar",
    weight: float | None = None,
    branch: BranchName | None = None,
    time_limit: float | None = None,
    memory_limit: float | None = None,
    progress: ProgressCallback | None = None,
    interrupt: OnInterrupt = "return",
) -> Result:
    """Find the plan with the maximum expected utility, and prove that it is.

    No plan, a limit that was reached and a Ctrl-C are values of the result's `status` and `stopped`, not exceptions.

    Args:
        problem: a problem, such as `read_hddl` returns.
        attitude: neutral, averse or seeking.
        alpha: how much an averse or a seeking agent cares about risk: positive, per unit of cost.
        solver: a name from `SOLVERS`.
        heuristic: a name from `HEURISTICS`, or `auto`, the default for all but greedy search: three searches by
            turns. The default is `ff` for greedy search, and `tdg` for the
            solver `plan`, which takes `blind` besides.
        search: `astar` returns an optimal plan, `weighted` one within a proven bound, `greedy` any plan; `anytime`
            finds one soon, and better ones until it is optimal.
        weight: the weight of the heuristic in the weighted search, at least 1 (2 where it is not given).
        branch: which tasks the solver `plan` decomposes in a network: `fewest`, the one with the fewest methods, or
            `all`, as the paper's Algorithm 3 does.
        time_limit: seconds, for grounding and search together.
        memory_limit: resident memory of the whole process in MB (10^6 bytes).
        progress: is called some ten times a second during the search.
        interrupt: what a Ctrl-C does: `return` what is known by then, or `raise` a `KeyboardInterrupt` with that as its
            argument, which ends a loop of plans, too.

    Raises:
        UsageError: an argument is out of its range.
        InputError: the cost of a reachable action is undefined, negative or no distribution, or has no finite price
            for this agent (a heavy tail, for an averse one).
        UnsupportedError: the problem asks for something that the planner does not do.
    """
    expect_problem(problem)
    query = Query.of(attitude, alpha, solver, heuristic, search, weight, branch)
    function(progress, "progress")
    check_interrupt(interrupt)
    limits = Limits.starting_now(time_limit, memory_limit)
    return returned(_solve(problem, query, limits, progress, Statistics()), interrupt)


def improving(
    problem: Problem,
    *,
    attitude: Attitude | AttitudeName = Attitude.NEUTRAL,
    alpha: float | None = None,
    heuristic: HeuristicName | None = None,
    time_limit: float | None = None,
    memory_limit: float | None = None,
    progress: ProgressCallback | None = None,
    interrupt: OnInterrupt = "return",
) -> Iterator[Result]:
    """Search as `plan` does with `search="anytime"`, and yield each better plan as soon as it is found.

    A robot takes the best plan so far when it has to go; the last result is what `plan` returns. `problem`, `attitude`,
    `alpha`, `heuristic`, `time_limit`, `memory_limit`, `progress` and `interrupt` are those of `plan`, and so are the
    errors; wrong arguments are told at once. The time that the caller takes between two results counts, too.
    """
    expect_problem(problem)
    query = Query.of(attitude, alpha, heuristic=heuristic, search="anytime")
    function(progress, "progress")
    check_interrupt(interrupt)
    limits = Limits.starting_now(time_limit, memory_limit)
    return _improving(_solutions(problem, query, limits, progress, Statistics(), every_plan=True), interrupt)


def _improving(results: Iterator[Result], interrupt: OnInterrupt) -> Iterator[Result]:
    for result in results:
        yield result
    returned(result, interrupt)


def plan_within(problem: Problem, limits: Limits) -> Result:
    """Find any plan, or prove that there is none, within limits that have begun."""
    result = _solve(problem, Query.of(search="greedy"), limits, None, Statistics())
    if result.status is Status.EXHAUSTED:
        result = _solve(problem, Query.of(), limits, None, Statistics())
    return result


def plan_files(
    domain: str | os.PathLike[str],
    problem: str | os.PathLike[str],
    query: Query,
    *,
    strict: bool = False,
    costs: str | os.PathLike[str] | None = None,
    time_limit: float | None = None,
    memory_limit: float | None = None,
    progress: ProgressCallback | None = None,
    better: Callable[[Result, Problem], None] | None = None,
) -> tuple[Result, Problem | None]:
    """Read a problem from HDDL files and plan; the limits hold for the reading, too.

    `costs` is a file with costs for the domain's actions (`read_costs`). `better` is called with each better plan when
    it is found. Returns the result, and the problem where it was read to its end. The other arguments and what it
    raises: see `plan` and `read_hddl`.
    """
    limits = Limits.starting_now(time_limit, memory_limit)
    read, statistics = measured_read(domain, problem, strict, limits, costs)
    if isinstance(read, Status):
        return no_plan(query, read, statistics), None
    if better is None:
        return _solve(read, query, limits, progress, statistics), read
    for result in _solutions(read, query, limits, progress, statistics, every_plan=True):
        if result.plan is not None:
            better(result, read)
    return result, read


def no_plan(query: Query, status: Status, statistics: Statistics, bound: float | None = None) -> Result:
    """Return the result of a run that found no plan."""
    return Result(
        status=status,
        stopped=status if status in STOPS else None,
        problem_class=str(problem_class(query.solver, query.utility)),
        utility=query.utility,
        solver=query.solver,
        heuristic=query.heuristic,
        bound=bound,
        statistics=replace(statistics, peak_memory_mb=peak_memory_mb()),
    )


def measured_read(
    domain: str | os.PathLike[str],
    problem: str | os.PathLike[str],
    strict: bool,
    limits: Limits,
    costs: str | os.PathLike[str] | None = None,
) -> tuple[Problem | Status, Statistics]:
    """Read a problem and a file with its costs, and take the time; returns the status where something ended it."""
    start = time.perf_counter()
    read: Problem | Status
    try:
        with watched(limits):
            read = read_hddl(domain, problem, strict=strict, limits=limits)
            if costs is not None:
                from statehtn.build.cost_file import read_costs  # few runs need it

                read = read_costs(costs, limits).apply(read)
    except ENDINGS as ending:
        read = status_of(ending)
    seconds = time.perf_counter() - start
    log.info("reading '%s' and '%s': %.3f s, %s", domain, problem, seconds, read)
    return read, Statistics(parse_seconds=seconds)


def measured_ground(problem: Problem, limits: Limits, statistics: Statistics) -> tuple[Grounding | Status, Statistics]:
    """Ground a problem, take the time and count; returns the status instead where something ended it."""
    start = time.perf_counter()
    try:
        grounding = ground(problem, limits)
    except ENDINGS as ending:
        log.info("grounding: %s after %.3f s", status_of(ending), time.perf_counter() - start)
        return status_of(ending), replace(statistics, ground_seconds=time.perf_counter() - start)
    statistics = replace(
        statistics,
        facts=grounding.fact_count,
        actions=grounding.action_count,
        tasks=grounding.task_count,
        methods=grounding.method_count,
        ground_seconds=time.perf_counter() - start,
    )
    log.info("grounding: %.3f s, %s", statistics.ground_seconds, statistics.sizes)
    return grounding, statistics


def _solve(
    problem: Problem, query: Query, limits: Limits, progress: ProgressCallback | None, statistics: Statistics
) -> Result:
    """Ground, search and validate; return how it ended."""
    return last_of(_solutions(problem, query, limits, progress, statistics, every_plan=False))


def _solutions(
    problem: Problem,
    query: Query,
    limits: Limits,
    progress: ProgressCallback | None,
    statistics: Statistics,
    every_plan: bool,
) -> Iterator[Result]:
    """Ground and search; validate and yield plans, each better than those before, and last how the run ended.

    An interruption between two phases, which none of them sees, ends the run as one within them does.
    """
    latest = no_plan(query, Status.INTERRUPTED, statistics)
    found = _uninterrupted(problem, query, limits, progress, statistics, every_plan)
    try:
        for latest in found:
            yield latest
    except KeyboardInterrupt:
        yield _stopped(latest, Status.INTERRUPTED)


def _stopped(result: Result, by: Status) -> Result:
    """Return the best result so far as that of a run that something has ended."""
    return replace(result, status=by if result.plan is None else Status.SOLVED, stopped=by)


def _uninterrupted(
    problem: Problem,
    query: Query,
    limits: Limits,
    progress: ProgressCallback | None,
    statistics: Statistics,
    every_plan: bool,
) -> Iterator[Result]:
    grounding, statistics = measured_ground(problem, limits, statistics)
    if isinstance(grounding, Status):
        yield no_plan(query, grounding, statistics)
        return
    start = time.perf_counter()
    validating = 0.0
    latest: Result | None = None
    unpriced: MissingNumber | None = None
    outcomes = _search(grounding, query, limits, progress, every_plan)
    while True:
        try:
            outcome = next(outcomes, None)
        except ENDINGS as ending:
            spent = replace(statistics, search_seconds=time.perf_counter() - start - validating)
            yield _stopped(latest or no_plan(query, status_of(ending), spent), status_of(ending))
            return
        if outcome is None:
            if unpriced is not None:
                raise unpriced
            return
        spent = replace(
            statistics,
            expanded=outcome.expanded,
            generated=outcome.generated,
            evaluated=outcome.evaluated,
            dead_ends=outcome.dead_ends,
            search_seconds=time.perf_counter() - start - validating,
        )
        found = None
        if outcome.plan is not None:
            begin = time.perf_counter()
            left = limits.with_grace(SECONDS_TO_VALIDATE)
            try:
                found = validated_and_priced(problem, outcome.plan, query.utility, left)
            except MissingNumber as error:
                unpriced = error  # a better plan may do without the number
                continue
            unpriced = None
            validating += time.perf_counter() - begin
            spent = replace(spent, validate_seconds=validating)
        latest = replace(no_plan(query, outcome.status, spent, outcome.lower_bound), stopped=outcome.stopped)
        if found is not None:
            status = latest.status if found.validated else Status.SOLVED
            latest = replace(
                latest,
                status=status,
                plan=found.plan,
                steps=found.steps,
                validated=found.validated,
                stopped=outcome.stopped or found.stopped,
            )
        _tell(latest)
        yield latest


def _tell(result: Result) -> None:
    """Log how far a search has come."""
    plan = "no plan"
    if result.length is not None:
        plan = f"a plan of {counted(result.length, 'step')} for {result.risk_cost:.10g}"
    bound = "no bound" if result.lower_bound is None else f"bound {result.lower_bound:.10g}"
    seconds = result.statistics.search_seconds or 0.0
    log.info("search: %s, %s, %s after %.3f s", result.status, plan, bound, seconds)


def _search(
    grounding: Grounding, query: Query, limits: Limits, progress: ProgressCallback | None, every_plan: bool
) -> Iterator[SearchOutcome]:
    """Run the solver that is asked for; yield every better plan, or how the run ended only."""
    if query.solver == "plan":
        yield search_plans(
            grounding,
            query.utility,
            heuristic=query.heuristic,
            branch=query.branch,
            limits=limits,
            progress=progress,
        )
        return
    outcomes = improving_plans(
        grounding,
        query.utility,
        heuristic=query.heuristic,
        search=query.search,
        weight=query.weight,
        limits=limits,
        progress=progress,
    )
    if every_plan:
        yield from outcomes
    else:
        yield last_of(outcomes)
