"""The planner as a session for one problem, and its methods as functions."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator

from statehtn.attitudes import AttitudeComparison, compared_objectives
from statehtn.expected import function
from statehtn.interrupt import OnInterrupt, check_interrupt, returned
from statehtn.limits import Limits
from statehtn.model.expect import expect_problem
from statehtn.model.problem import Problem
from statehtn.model.status import Status
from statehtn.one_shot import one_shot
from statehtn.pipeline import solve_top
from statehtn.policies.planning import PolicyPlanner
from statehtn.result import Result
from statehtn.risk import Attitude, AttitudeName, ObjectiveLike
from statehtn.session import ProgressCallback, Session, TopProgressCallback
from statehtn.settings import (
    BranchName,
    DistinctName,
    HeuristicName,
    KeepLike,
    SearchName,
    Settings,
    SolverName,
    TopHeuristicName,
    TopSettings,
    objective_of,
)
from statehtn.sweeps import solutions, solve
from statehtn.sweeps.attitude_map import RESOLUTION, AttitudeMap, map_attitudes
from statehtn.sweeps.frontier import Frontier, find_frontier
from statehtn.top_result import TopPlans


class Planner(PolicyPlanner):
    """Plans for one problem as often as is wanted: it is grounded once, and priced once for each objective.

    The functions of the same names as its methods take a problem first, and are sessions of one call. The first call
    grounds, within its own limits; `ground_seconds` of the later ones are next to 0. A planner keeps what it has
    grounded and priced as long as it lives.

    Args:
        problem: a problem, such as `read_hddl` returns.

    Raises:
        UsageError: it is none.
    """

    def __init__(self, problem: Problem) -> None:
        self._session = Session(expect_problem(problem))

    @property
    def problem(self) -> Problem:
        """The problem that it plans for."""
        assert self._session.problem is not None
        return self._session.problem

    def __repr__(self) -> str:
        return f"<planner for {self.problem!r}>"

    def plan(
        self,
        *,
        objective: ObjectiveLike | None = None,
        attitude: Attitude | AttitudeName | None = None,
        alpha: float | None = None,
        keep: KeepLike | Iterable[KeepLike] = (),
        solver: SolverName = "state",
        heuristic: HeuristicName | None = None,
        search: SearchName = "astar",
        weight: float | None = None,
        branch: BranchName | None = None,
        precision: float | None = None,
        time_limit: float | None = None,
        memory_limit: float | None = None,
        progress: ProgressCallback | None = None,
        interrupt: OnInterrupt = "return",
    ) -> Result:
        """Find the best plan of the problem by an objective, and prove that it is.

        For a neutral, averse or seeking agent that is the plan of maximum expected utility. No plan, a limit that was
        reached and a Ctrl-C are values of the result's `status` and `stopped`, not exceptions.

        Args:
            objective: what plans are compared by: an objective of `statehtn.objective`, its text form, such as
                `cvar 0.95`, or a function that gives the utility of a total cost and does not rise. The expected cost
                where neither it nor an attitude is given.
            attitude: neutral, averse or seeking: with alpha a short form of an objective.
            alpha: how much an averse or a seeking agent cares about risk: positive, per unit of cost.
            keep: budgets that have to be kept with a probability, such as `25 0.95`: plans that do not are none.
            solver: a name from `SOLVERS`.
            heuristic: a name from `HEURISTICS`, or `auto`: three searches in turn. `auto` is the default, but for
                greedy search, whose default is `ff`, and the solver `plan`, which takes `tdg`, its default, or `blind`.
            search: `astar` returns an optimal plan, `weighted` one within a proven bound, `greedy` any plan; `anytime`
                finds one soon, and better ones until it is optimal.
            weight: the weight of the heuristic in the weighted search, at least 1 (2 where it is not given).
            branch: which tasks the solver `plan` decomposes in a network: `fewest`, the one with the fewest methods, or
                `all`, as the paper's Algorithm 3 does.
            precision: a plan counts as optimal where it is within this part of max(1, its value) of the best one; for
                objectives whose prices do not add up, and where budgets are to be kept (where it is not given 1e-6, and
                1e-9 for `one-switch`, `exponentials` and `mean-deviation` without budgets).
            time_limit: seconds, for grounding and search together.
            memory_limit: resident memory of the whole process in MB (10^6 bytes).
            progress: is called some twenty times a second during the search.
            interrupt: what a Ctrl-C does: `return` what is known by then, or `raise` a `KeyboardInterrupt` with that as
                its argument, which ends a loop of plans, too.

        Raises:
            UsageError: an argument is out of its range.
            InputError: the cost of a reachable action is undefined, negative or no distribution, or has no finite price
                by this objective (a heavy tail, for an averse agent).
            UnsupportedError: the problem asks for something that the planner does not do.
        """
        wanted = objective_of(objective, attitude, alpha)
        settings = Settings.of(wanted, solver, heuristic, search, weight, branch, keep=keep, precision=precision)
        function(progress, "progress")
        check_interrupt(interrupt)
        limits = Limits.starting_now(time_limit, memory_limit)
        return returned(solve(self._session, settings, limits, progress), interrupt)

    def improving(
        self,
        *,
        objective: ObjectiveLike | None = None,
        attitude: Attitude | AttitudeName | None = None,
        alpha: float | None = None,
        keep: KeepLike | Iterable[KeepLike] = (),
        heuristic: HeuristicName | None = None,
        precision: float | None = None,
        time_limit: float | None = None,
        memory_limit: float | None = None,
        progress: ProgressCallback | None = None,
        interrupt: OnInterrupt = "return",
    ) -> Iterator[Result]:
        """Search the problem as `plan` does with `search="anytime"`, and yield each better plan as soon as it is found.

        A robot takes the best plan so far when it has to go; the last result is what `plan` returns. `objective`,
        `attitude`, `alpha`, `keep`, `heuristic`, `precision`, `time_limit`, `memory_limit`, `progress` and `interrupt`
        are those of `plan`, and so are the errors; wrong arguments are told at once. The time that the caller takes
        between two results counts, too.
        """
        wanted = objective_of(objective, attitude, alpha)
        settings = Settings.of(wanted, heuristic=heuristic, search="anytime", keep=keep, precision=precision)
        function(progress, "progress")
        check_interrupt(interrupt)
        limits = Limits.starting_now(time_limit, memory_limit)
        return _returned_last(solutions(self._session, settings, limits, progress, every_plan=True), interrupt)

    def top_plans(
        self,
        k: int,
        *,
        objective: ObjectiveLike | None = None,
        attitude: Attitude | AttitudeName | None = None,
        alpha: float | None = None,
        keep: KeepLike | Iterable[KeepLike] = (),
        distinct: DistinctName = "sequence",
        heuristic: TopHeuristicName | None = None,
        precision: float | None = None,
        time_limit: float | None = None,
        memory_limit: float | None = None,
        progress: TopProgressCallback | None = None,
        interrupt: OnInterrupt = "return",
    ) -> TopPlans:
        """Find the k best plans of the problem by an objective, and prove that they are.

        Plans are different if their actions are; how they were decomposed makes no difference. Where there are fewer
        than k, all are returned. A limit that was reached and a Ctrl-C are values of the result's `status`, not
        exceptions: what was found by then is there, and `proven` says how much of it is proven.

        Args:
            k: how many plans.
            objective: what plans are compared by, as for `plan`; so are `attitude`, `alpha`, `keep` and `precision`.
            distinct: `sequence`: plans differ if their sequences of actions do; `multiset`: plans with the same actions
                in another order are one, the cheapest of them.
            heuristic: the name of an admissible heuristic in `HEURISTICS`; `potential` where none is given.
            time_limit: seconds, for grounding and search together. Every plan is validated after the search; those that
                are not when the time is over, or after an interruption, come with the prices of the search.
            memory_limit: resident memory of the whole process in MB (10^6 bytes).
            progress: is called some twenty times a second during the search.
            interrupt: what a Ctrl-C does: `return` what is known by then, or `raise` a `KeyboardInterrupt` with that as
                its argument, which ends a loop of plans, too.

        Raises:
            UsageError: an argument is out of its range.
            InputError: the cost of a reachable action is undefined, negative or no distribution.
            UnsupportedError: the problem asks for something that the planner does not do.
        """
        wanted = objective_of(objective, attitude, alpha)
        settings = TopSettings.of(k, wanted, distinct, heuristic, keep, precision)
        function(progress, "progress")
        check_interrupt(interrupt)
        limits = Limits.starting_now(time_limit, memory_limit)
        return returned(solve_top(self._session, settings, limits, progress), interrupt)

    def compare_attitudes(
        self,
        alpha: float | Iterable[float] | None = None,
        *,
        attitudes: Iterable[Attitude | AttitudeName] | None = None,
        objectives: Iterable[ObjectiveLike] | None = None,
        keep: KeepLike | Iterable[KeepLike] = (),
        solver: SolverName = "state",
        heuristic: HeuristicName | None = None,
        search: SearchName = "astar",
        precision: float | None = None,
        time_limit: float | None = None,
        memory_limit: float | None = None,
        progress: ProgressCallback | None = None,
        interrupt: OnInterrupt = "return",
    ) -> AttitudeComparison:
        """Plan the problem for agents of several attitudes, or by several objectives, and compare what they do.

        Args:
            alpha: how much averse and seeking agents care about risk, per unit of cost; several for as many agents; 1
                where it is not given.
            attitudes: some of averse, neutral and seeking; all where they are not given.
            objectives: what plans are compared by, in the place of attitudes and alpha: as `objective` of `plan`.
            keep: as for `plan`, for each agent; so are `solver`, `heuristic`, `search`, `precision` and `progress`.
            time_limit: seconds for each agent; the problem is grounded once, in the time of the first.
            memory_limit: resident memory of the whole process in MB (10^6 bytes).
            interrupt: what a Ctrl-C does: `return` what is known by then, or `raise` a `KeyboardInterrupt` with that as
                its argument, which ends a loop of plans, too.

        An agent without a plan has a result that says why. After an interruption no further agent is asked.

        Raises:
            UsageError: an argument is out of its range, or there are no agents.
            InputError, UnsupportedError: as `plan`.
        """
        check_interrupt(interrupt)
        compared = compared_objectives(alpha, attitudes, objectives)
        how = solver, heuristic, search
        wanted = [Settings.of(objective, *how, keep=keep, precision=precision) for objective in compared]
        function(progress, "progress")
        results: list[Result] = []
        for settings in wanted:
            limits = Limits.starting_now(time_limit, memory_limit)
            results.append(solve(self._session, settings, limits, progress))
            if results[-1].stopped is Status.INTERRUPTED:
                break
        return returned(AttitudeComparison(tuple(results)), interrupt)

    def attitude_map(
        self,
        low: float = -math.inf,
        high: float = math.inf,
        *,
        eps: float | None = None,
        resolution: float = RESOLUTION,
        solver: SolverName = "state",
        heuristic: HeuristicName | None = None,
        time_limit: float | None = None,
        memory_limit: float | None = None,
        progress: ProgressCallback | None = None,
        interrupt: OnInterrupt = "return",
    ) -> AttitudeMap:
        """Find the best plan of the problem for every exponential agent of an interval of alpha, to a given loss.

        Alpha is signed here: negative for seeking agents, 0 for the neutral one, positive for averse ones. Between the
        alphas that are searched, bounds say how far from optimal a plan may be.

        Args:
            low: the least alpha; `-math.inf`, the default: the agent to whom the least possible cost counts alone.
            high: the largest, above it; `math.inf`, the default: the agent to whom the largest possible cost counts
                alone.
            eps: how much worse than the best one a plan may be, as a certainty equivalent, in the domain's unit; where
                it is not given, a thousandth of what the least certainty equivalent gains on the interval.
            resolution: the width of the intervals in which the best plan changes, as a part of the alpha.
            solver: as for `plan`; so are `heuristic` and `progress`, which is told of one search after the other.
            time_limit: seconds, for grounding and all searches together.
            memory_limit: resident memory of the whole process in MB (10^6 bytes).
            interrupt: what a Ctrl-C does: `return` what is known by then, or `raise` a `KeyboardInterrupt` with that as
                its argument.

        Raises:
            UsageError: an argument is out of its range.
            InputError: as `plan`; a cost has no finite price for the agent of `high`.
            UnsupportedError: as `plan`; costs hang together by hidden facts or joint samples.
        """
        settings = Settings.of(solver=solver, heuristic=heuristic)
        function(progress, "progress")
        check_interrupt(interrupt)
        limits = Limits.starting_now(time_limit, memory_limit)
        found = map_attitudes(self._session, low, high, eps, resolution, settings, limits, progress)
        return returned(found, interrupt)

    def frontier(
        self,
        risk: str,
        *,
        precision: float | None = None,
        time_limit: float | None = None,
        memory_limit: float | None = None,
        progress: ProgressCallback | None = None,
        interrupt: OnInterrupt = "return",
    ) -> Frontier:
        """Find the plans of the problem of which no other one has a lower expected cost and a lower risk.

        Args:
            risk: `cvar 0.95`, the mean of the worst 5 %; `deadline 25`, the probability that the cost is above 25; or
                `deviation`, the standard deviation.
            precision: of each search, as for `plan`; so is `progress`, which is told of one search after the other.
            time_limit: seconds, for grounding and all searches together.
            memory_limit: resident memory of the whole process in MB (10^6 bytes).
            interrupt: what a Ctrl-C does: `return` what is known by then, or `raise` a `KeyboardInterrupt` with that as
                its argument.

        Raises:
            UsageError: there is no such risk, or an argument is out of its range.
            InputError, UnsupportedError: as `plan`.
        """
        settings = Settings.of(precision=precision)
        function(progress, "progress")
        check_interrupt(interrupt)
        limits = Limits.starting_now(time_limit, memory_limit)
        return returned(find_frontier(self._session, risk, settings, limits, progress), interrupt)


def _returned_last(results: Iterator[Result], interrupt: OnInterrupt) -> Iterator[Result]:
    for result in results:
        yield result
    returned(result, interrupt)


plan = one_shot(Planner, Planner.plan)
"""`Planner.plan` for a problem of one's own: see there."""
improving = one_shot(Planner, Planner.improving)
"""`Planner.improving` for a problem of one's own: see there."""
top_plans = one_shot(Planner, Planner.top_plans)
"""`Planner.top_plans` for a problem of one's own: see there."""
compare_attitudes = one_shot(Planner, Planner.compare_attitudes)
"""`Planner.compare_attitudes` for a problem of one's own: see there."""
attitude_map = one_shot(Planner, Planner.attitude_map)
"""`Planner.attitude_map` for a problem of one's own: see there."""
frontier = one_shot(Planner, Planner.frontier)
"""`Planner.frontier` for a problem of one's own: see there."""
policy = one_shot(Planner, Planner.policy)
"""`Planner.policy` for a problem of one's own: see there."""
