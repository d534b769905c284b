"""Policies of agents who mind what they have spent: deadlines, overruns, piecewise linear utilities and levels."""

from __future__ import annotations

import heapq
import math
from dataclasses import replace

import statehtn._relax as _relax
from statehtn.core.law_grid import LawGrid
from statehtn.core.policy_disutility import MOST_LEFT, Disutility
from statehtn.core.policy_laws import SpendingLaws
from statehtn.core.policy_outcome import PolicyOutcome
from statehtn.core.policy_prices import SuccessPolicies
from statehtn.core.policy_problem import PolicyProblem
from statehtn.core.policy_run import PolicyRun, Watch
from statehtn.errors import UnsupportedError
from statehtn.limits import Limits
from statehtn.model.status import Status
from statehtn.risk import ConditionalValueAtRisk, MeanCvar, Objective, Quantile

TOO_UNLIKELY = 1e-9
"""Probabilities closer than that are not told apart."""


class SpendingPolicies(PolicyRun):
    """The best policy by an objective of the total cost, from one amount, or from the best one of all.

    Args:
        problem: the ground problem.
        objective: of the total cost.
        failure_cost: what giving up adds to what was spent; None where it is not allowed.
        precision: see `PolicyRun`.
        watch: likewise.
        grid: the laws of all actions, exact, with what giving up costs.
        disutility: the objective's.
    """

    def __init__(
        self,
        problem: PolicyProblem,
        objective: Objective,
        failure_cost: float | None,
        precision: float,
        watch: Watch,
        grid: LawGrid,
        disutility: Disutility,
    ) -> None:
        super().__init__(problem, precision, watch)
        self.objective = objective
        self.grid = grid
        self.step = grid.grid.step
        self.disutility = disutility
        self.may_fail_for_ever = failure_cost == math.inf
        only_done_runs_pay = failure_cost is None or self.may_fail_for_ever
        self.run = problem.run(self.options, self.grid.least, only_done_runs_pay=only_done_runs_pay, sees_costs=True)
        failure = None if failure_cost is None else failure_cost / float(self.step)
        self.run.take_laws(
            self.grid.costs,
            self.grid.means,
            self.grid.units_per_step,
            list(self.disutility.of_left),
            self.disutility.gain,
            self.disutility.beyond,
            self.disutility.slope,
            failure,
            problem.heuristic,
        )

    def outcome(self, limits: Limits) -> PolicyOutcome:
        """Search, and return what was found."""
        match self.objective:
            case Quantile(level=level):
                return self._out_of_reach(level, limits) or self._quantile(level, limits)
            case ConditionalValueAtRisk() | MeanCvar():
                return self._mean_cvar(self.objective, limits)
        assert self.disutility.first is not None
        if self.disutility.first > MOST_LEFT:
            raise UnsupportedError(
                f"a policy by '{self.objective}' depends on what was spent, in steps of {float(self.step):g}: more than"
                f" {MOST_LEFT} of them are to be remembered, which is too many"
            )
        return self.finish(self.search(self.disutility.first, limits))

    def search(self, left: int, limits: Limits) -> _relax.PolicyStatistics:
        """Search from an amount, in steps."""
        return self.start(self.run, limits, left)

    def finish(self, found: _relax.PolicyStatistics) -> PolicyOutcome:
        """Return the outcome of the last search."""
        return self.finished(found.lower, found.upper, self.run, SpendingLaws(self.grid), found.upper < math.inf)

    def _to_read(self, limits: Limits) -> Limits:
        """Return the limits of a search for a policy that was found before, to read it; short once a run is over."""
        return limits.with_grace(1.0, is_over=self.stopped is not None)

    def _out_of_reach(self, level: float, limits: Limits) -> PolicyOutcome | None:
        """Return that no amount is enough, where runs may fail for ever and too many of them do; None elsewhere."""
        if not self.may_fail_for_ever:
            return None
        found = SuccessPolicies(self.problem, TOO_UNLIKELY, None).outcome(limits)
        if found.upper is None or found.upper >= level - TOO_UNLIKELY:
            return None
        reason = f"no policy is done with probability {level:g}, whatever it spends"
        return PolicyOutcome(Status.UNSOLVABLE, None, None, None, None, found.effort, reason, found.lower)

    def _quantile(self, level: float, limits: Limits) -> PolicyOutcome:
        """Find the least amount that is enough with the level's probability; more is enough, too."""
        most_late = 1 - level + 1e-12
        below, amount = -1, 0  # the largest amount that is known to be too small; one to try
        enough: int | None = None
        while enough is None or enough - below > 1:
            found = self.search(amount, limits)
            if found.lower == math.inf:
                return self.finish(found)
            if found.upper <= most_late:
                enough = amount
            elif found.lower > most_late:
                below = amount
            else:
                break  # a limit, or too near to tell
            if self.stopped is not None:
                break
            amount = 2 * amount + 1 if enough is None else (below + enough) // 2
            if amount > MOST_LEFT:
                break
        low = float(self.step * (below + 1))
        if enough is None:
            status = self.stopped or Status.GAVE_UP
            return PolicyOutcome(status, self.stopped, low, None, None, self.effort)
        stopped = self.stopped
        outcome = self.finish(self.search(enough, self._to_read(limits)))
        if outcome.graph is None:
            return replace(outcome, lower=low, upper=None, status=stopped or Status.GAVE_UP, stopped=stopped)
        high = float(self.step * enough)
        if low == high:
            return replace(outcome, lower=low, upper=high, status=Status.OPTIMAL, stopped=None)
        return replace(outcome, lower=low, upper=high, status=Status.SOLVED, stopped=stopped or self.stopped)

    def _mean_cvar(self, objective: ConditionalValueAtRisk | MeanCvar, limits: Limits) -> PolicyOutcome:
        """Find the best amount by branch and bound over intervals of amounts.

        Let V(t) be the least mean of `(1 - weight) C + weight max(C - t, 0) / (1 - level)`, and `weight t + V(t)` what
        is minimised. V falls, and by at most `rate = weight / (1 - level)` per unit, as it does for each policy. So
        between t1 and t2 it is at least `max(V(t2), V(t1) - rate (t - t1))`, and what is minimised is least, by this,
        where the two are equal. From an amount on that is itself as much as the best value, nothing is better.
        """
        step, weight = float(self.step), objective.weight
        rate = weight / (1 - objective.level)
        known: dict[int, tuple[float, float]] = {}  # by amount: bounds of V
        searched: dict[int, _relax.PolicyStatistics] = {}
        best, best_amount = math.inf, 0

        def look(amount: int) -> None:
            nonlocal best, best_amount
            if self.stopped is not None:
                known[amount] = 0.0, math.inf
                return
            found = searched[amount] = self.search(amount, limits)
            shift = (1 - weight) * amount * step
            known[amount] = (found.lower + shift, found.upper + shift)
            value = weight * amount * step + known[amount][1]
            if value < best:
                best, best_amount = value, amount

        def bound(low: int, high: int) -> tuple[float, int]:
            (least, _), (lowest, _) = known[low], known[high]
            fall = max(0.0, least - lowest) / rate if rate > 0 else 0.0
            meeting = min(low + round(fall / step), high - 1)
            return weight * (low * step + min(fall, (high - low) * step)) + lowest, max(meeting, low + 1)

        look(0)
        if known[0][0] == math.inf or best == math.inf or weight == 0:
            outcome = self.finish(searched[0])
            if weight == 0 or known[0][0] == math.inf:
                return outcome
            # V falls by at most `rate`, and not below 0.
            return replace(outcome, lower=self.values(known[0][0] * (1 - objective.level), best)[0])
        most = min(math.ceil(best / (weight * step)) if step else 0, MOST_LEFT)
        if most > 0:
            look(most)
        open_intervals = [(*bound(0, most), 0, most)] if most > 1 else []
        least_closed = min(weight * amount * step + low for amount, (low, _) in known.items())
        while open_intervals and self.stopped is None:
            least, meeting, low, high = open_intervals[0]
            if least >= best - self.precision / 2 * max(1.0, abs(best)):
                break
            heapq.heappop(open_intervals)
            look(meeting)
            least_closed = min(least_closed, weight * meeting * step + known[meeting][0])
            for one, other in ((low, meeting), (meeting, high)):
                if other - one > 1:
                    heapq.heappush(open_intervals, (*bound(one, other), one, other))
        lower = min([least_closed, *(interval[0] for interval in open_intervals)])
        stopped = self.stopped
        is_last = best_amount == next(reversed(searched))
        outcome = self.finish(searched[best_amount] if is_last else self.search(best_amount, self._to_read(limits)))
        low_value, high_value = self.values(lower, best)
        if outcome.graph is None:
            return replace(outcome, lower=low_value, upper=None, status=stopped or Status.GAVE_UP, stopped=stopped)
        is_optimal = low_value is not None and best - low_value <= self.precision * max(1.0, abs(best))
        status = Status.OPTIMAL if is_optimal else Status.SOLVED
        stopped = None if is_optimal else stopped or self.stopped
        return replace(outcome, lower=low_value, upper=high_value, status=status, stopped=stopped)
