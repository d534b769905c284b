"""The best plans instead of one: read, ground, search, validate; every run ends in a `TopPlans`, whatever ends it."""

from __future__ import annotations

import math
import os
import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Literal, cast

from statehtn.core.heuristics import ADMISSIBLE, why_refused
from statehtn.core.progress import TopProgress
from statehtn.core.top_plans import DISTINCT, TopOutcome, find_top_plans
from statehtn.counted import counted
from statehtn.effort import Statistics, peak_memory_mb
from statehtn.errors import UsageError
from statehtn.expected import function, one_of, whole_number
from statehtn.found_plan import SECONDS_TO_VALIDATE, FoundPlan, not_validated, validated_and_priced
from statehtn.interrupt import OnInterrupt, check_interrupt, returned
from statehtn.limits import ENDINGS, Limits, status_of
from statehtn.log import log
from statehtn.model.expect import expect_problem
from statehtn.model.problem import Problem
from statehtn.model.status import Status
from statehtn.planner import measured_ground, measured_read
from statehtn.risk import Attitude, AttitudeName, Utility, problem_class, utility_for
from statehtn.top_result import RankedPlan, TopPlans

TopProgressCallback = Callable[[TopProgress], None]

# Names for type checkers.
TopHeuristicName = Literal["blind", "tdg", "hmax", "lmcut", "potential", "potential-hmax"]
DistinctName = Literal["sequence", "multiset"]
DEFAULT_TOP_HEURISTIC = "potential"
MOST_PLANS = 1_000_000_000


@dataclass(frozen=True, slots=True)
class TopQuery:
    """Which plans are wanted, and how to find them; make one by `TopQuery.of`, which checks it."""

    k: int
    utility: Utility
    distinct: str
    heuristic: str

    @staticmethod
    def of(
        k: int,
        attitude: Attitude | str = Attitude.NEUTRAL,
        alpha: float | None = None,
        distinct: str = "sequence",
        heuristic: str | None = None,
    ) -> TopQuery:
        """Check the arguments, described at `top_plans`.

        Raises:
            UsageError: a name is unknown, or a number out of range.
        """
        utility = utility_for(cast("AttitudeName", attitude), alpha)
        if not 1 <= whole_number(k, "the number of plans") <= MOST_PLANS:
            raise UsageError(f"the number of plans must be from 1 to {MOST_PLANS}, found {k}")
        one_of(distinct, DISTINCT, "value of 'distinct'")
        heuristic = DEFAULT_TOP_HEURISTIC if heuristic is None else heuristic
        if isinstance(heuristic, str) and (reason := why_refused(heuristic, "the search for the best plans")):
            raise UsageError(reason)
        one_of(heuristic, ADMISSIBLE, "heuristic for the best plans")
        return TopQuery(k, utility, distinct, heuristic)


def top_plans(
    problem: Problem,
    k: int,
    *,
    attitude: Attitude | AttitudeName = Attitude.NEUTRAL,
    alpha: float | None = None,
    distinct: DistinctName = "sequence",
    heuristic: TopHeuristicName | None = None,
    time_limit: float | None = None,
    memory_limit: float | None = None,
    progress: TopProgressCallback | None = None,
    interrupt: OnInterrupt = "return",
) -> TopPlans:
    """Find the k plans with the highest expected utility, and prove that they are.

    Plans are different if their actions are; how they were decomposed makes no difference. Where there are fewer than
    k, all are returned. A limit that was reached and a Ctrl-C are values of the result's `status`, not exceptions: what
    was found by then is there, and `proven` says how much of it is proven.

    Args:
        problem: a problem, such as `read_hddl` returns.
        k: how many plans.
        attitude: neutral, averse or seeking.
        alpha: how much an averse or a seeking agent cares about risk: positive, per unit of cost.
        distinct: `sequence`: plans differ if their sequences of actions do; `multiset`: plans with the same actions in
            another order are one, the cheapest of them.
        heuristic: the name of an admissible heuristic in `HEURISTICS`; `potential` where none is given.
        time_limit: seconds, for grounding and search together. Every plan is validated after the search; those that
            are not two seconds after the limit, or after an interruption, are left out.
        memory_limit: resident memory of the whole process in MB (10^6 bytes).
        progress: is called some ten times a second during the search.
        interrupt: what a Ctrl-C does: `return` what is known by then, or `raise` a `KeyboardInterrupt` with that as its
            argument, which ends a loop of plans, too.

    Raises:
        UsageError: an argument is out of its range.
        InputError: the cost of a reachable action is undefined, negative or no distribution.
        UnsupportedError: the problem asks for something that the planner does not do.
    """
    expect_problem(problem)
    query = TopQuery.of(k, attitude, alpha, distinct, heuristic)
    function(progress, "progress")
    check_interrupt(interrupt)
    limits = Limits.starting_now(time_limit, memory_limit)
    return returned(_solve(problem, query, limits, progress, Statistics()), interrupt)


def top_plans_files(
    domain: str | os.PathLike[str],
    problem: str | os.PathLike[str],
    query: TopQuery,
    *,
    strict: bool = False,
    costs: str | os.PathLike[str] | None = None,
    time_limit: float | None = None,
    memory_limit: float | None = None,
    progress: TopProgressCallback | None = None,
) -> tuple[TopPlans, Problem | None]:
    """Read a problem from HDDL files and find its best plans; the limits hold for the reading, too.

    `costs` is a file with costs for the domain's actions (`read_costs`). Returns the result, and the problem where it
    was read to its end. The other arguments and what it raises: see `top_plans` and `read_hddl`.
    """
    limits = Limits.starting_now(time_limit, memory_limit)
    read, statistics = measured_read(domain, problem, strict, limits, costs)
    if isinstance(read, Status):
        return no_plans(query, read, statistics), None
    return _solve(read, query, limits, progress, statistics), read


def no_plans(query: TopQuery, status: Status, statistics: Statistics) -> TopPlans:
    """Return the result of a run that something ended before the search had anything to show."""
    return TopPlans(
        status=status,
        stopped=status,
        k=query.k,
        distinct=query.distinct,
        problem_class=str(problem_class("state", query.utility)),
        utility=query.utility,
        heuristic=query.heuristic,
        statistics=replace(statistics, peak_memory_mb=peak_memory_mb()),
    )


def _solve(
    problem: Problem, query: TopQuery, limits: Limits, progress: TopProgressCallback | None, statistics: Statistics
) -> TopPlans:
    """Ground, search and validate."""
    grounding, statistics = measured_ground(problem, limits, statistics)
    if isinstance(grounding, Status):
        return no_plans(query, grounding, statistics)
    start = time.perf_counter()
    try:
        outcome = find_top_plans(
            grounding,
            query.utility,
            query.k,
            distinct=query.distinct,
            heuristic=query.heuristic,
            limits=limits,
            progress=progress,
        )
    except ENDINGS as ending:
        return no_plans(query, status_of(ending), replace(statistics, search_seconds=time.perf_counter() - start))
    statistics = replace(
        statistics,
        expanded=outcome.expanded,
        generated=outcome.generated,
        evaluated=outcome.evaluated,
        dead_ends=outcome.dead_ends,
        search_seconds=time.perf_counter() - start,
    )
    plans_found = counted(len(outcome.plans), "plan")
    log.info("search: %s, %d proven, %.3f s", plans_found, outcome.proven, statistics.search_seconds)
    begin = time.perf_counter()
    found, stopped = _validated(problem, query.utility, outcome, limits)
    plans = tuple(_ranked(found, outcome.proven, query.utility))
    statistics = replace(statistics, validate_seconds=time.perf_counter() - begin)
    if plans:
        is_proven = outcome.is_all or outcome.proven == len(outcome.plans)
        status = Status.OPTIMAL if is_proven and stopped is None else Status.SOLVED
    else:
        status = stopped or Status.UNSOLVABLE
    return replace(
        no_plans(query, status, statistics),
        stopped=stopped,
        plans=plans,
        is_all=outcome.is_all and stopped is None,
        lower_bound=_bound(outcome, plans),
    )


def _validated(
    problem: Problem, utility: Utility, outcome: TopOutcome, limits: Limits
) -> tuple[list[FoundPlan], Status | None]:
    """Validate and price the plans that were found, and say what ended that, or the search before.

    Raises:
        InternalError: a plan is wrong.
    """
    left = limits.with_grace(SECONDS_TO_VALIDATE)
    found: list[FoundPlan] = []
    stopped: Status | None = None
    for plan in outcome.plans:
        if stopped is None:
            found.append(validated_and_priced(problem, plan, utility, left))
            stopped = found[-1].stopped
        else:
            found.append(not_validated(plan, utility, stopped))
    return found, outcome.stopped or stopped


def _ranked(found: Sequence[FoundPlan], proven: int, utility: Utility) -> Iterator[RankedPlan]:
    """Yield the plans in their order.

    The core compares costs that are rounded down, so that plans that are equally good come in any order.
    """

    def place(one: FoundPlan) -> tuple[float, int, list[str]]:
        cost = math.fsum(step.risk_cost for step in one.steps)
        return float(f"{cost:.14g}"), len(one.steps), [str(step.step) for step in one.steps]

    in_order = sorted(found[:proven], key=place) + sorted(found[proven:], key=place)
    for index, one in enumerate(in_order):
        yield RankedPlan(index + 1, index < proven, one.plan, one.steps, utility, one.validated)


def _bound(outcome: TopOutcome, plans: Sequence[RankedPlan]) -> float | None:
    """Return what every plan costs that is not among these; at most as much as the last one, rounding aside."""
    if not plans:
        return None if outcome.plans else outcome.lower_bound
    return None if outcome.lower_bound is None else min(outcome.lower_bound, plans[-1].risk_cost)
