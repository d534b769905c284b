"""Policies of agents to whom it matters always what they have spent: one-switch ones, and sums of exponentials.

What was spent is remembered up to a cut; beyond it, policies are taken to be as good as they can be by each term of
the disutility (relax/policies/cut_source.hpp): so there is a bound of all policies, and a policy. What that is worth
follows from its runs. The cut moves until the two meet.
"""

from __future__ import annotations

import math
import sys
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import statehtn._relax as _relax
from statehtn.core.law_grid import LawGrid
from statehtn.core.policy_disutility import MOST_LEFT
from statehtn.core.policy_laws import BranchLaws, SpendingLaws
from statehtn.core.policy_outcome import PolicyOutcome
from statehtn.core.policy_problem import PolicyProblem, Prices
from statehtn.core.policy_run import PolicyRun, Watch, effort_of
from statehtn.core.pricing import check_exponent
from statehtn.core.progress import Progress
from statehtn.counted import finite
from statehtn.limits import Limits
from statehtn.model.policy_graph import FlatPolicy
from statehtn.model.status import Status
from statehtn.risk import Attitude, Exponential, Exponentials, Neutral, OneSwitch

ROUNDING = 2.0**-38
"""Of the logarithm of an expected disutility, or of 1 if that is more."""
LEAST_TOLERANCE = 1e-15
LARGE_EXPONENT = 0.1
"""Of a cost, where risk is only sought: from there on disutilities become too much alike to be carried over."""
FINER = 64
"""By which the tolerance is divided where certainty equivalents are farther apart than logarithms."""
MOST_CUT = MOST_LEFT // 8
"""So that all cuts together have no more steps than can be told apart."""


@dataclass(frozen=True, slots=True)
class _Term:
    """A term of the disutility `sum of weight * g(C)`, `g(C) = (e^(slope C) - 1) / slope`, or C for the slope 0."""

    slope: float
    log_weight: float
    prices: Prices


class CutPolicies(PolicyRun):
    """The best policy for an agent to whom it matters always what it has spent.

    Args:
        problem: the ground problem.
        objective: the agent.
        failure_cost: what giving up adds to what was spent; None where it is not allowed.
        precision: see `PolicyRun`.
        watch: likewise.
        grid: the laws of all actions, exact, with what giving up costs.
        value_of: what a policy is worth by the objective, worked out from its runs; may be infinite.
    """

    sign = 1.0
    """Of logarithms of disutilities as worths: -1 where these are of sums that fall as costs rise."""
    first_cut: int | None = None
    """How many steps are remembered at first. None: nothing; one policy may be best for all terms."""

    def __init__(
        self,
        problem: PolicyProblem,
        objective: OneSwitch | Exponentials,
        failure_cost: float | None,
        precision: float,
        watch: Watch,
        grid: LawGrid,
        value_of: Callable[[FlatPolicy], float],
    ) -> None:
        super().__init__(problem, precision, watch)
        self.objective = objective
        self.grid = grid
        self.step = float(grid.grid.step)
        self.value_of = value_of
        self.tolerance = precision / 16
        """How far apart the bounds of the core may be: logarithms, relative to the larger, or to 1."""
        self.bound, self.value = -math.inf, math.inf
        slopes = [term.slope for term in self.terms]
        check_exponent(objective, max(slopes, key=abs), grid.largest)
        is_only_sought = slopes[0] < 0 and -slopes[0] * grid.largest > LARGE_EXPONENT
        self.recursion = _relax.Recursion.Seeking if is_only_sought else _relax.Recursion.LogExpected
        self.sign = -1.0 if is_only_sought else 1.0
        handle = self.terms[0].prices.handle
        self.run = problem.run(self.options, handle, only_done_runs_pay=failure_cost is None, sees_costs=True)
        for term in self.terms:
            prices = term.prices
            self.run.add_term(term.slope, term.log_weight, prices.actions, prices.parts, prices.handle, prices.unit)
        failure = math.inf if failure_cost is None else failure_cost
        self.run.take_terms(grid.costs, self.step, failure, is_only_sought, problem.heuristic)

    @cached_property
    def terms(self) -> list[_Term]:
        """The terms, that of the largest slope first; weights at no cost sum to 1."""
        weights = {term.slope: term.log_weight + math.log(abs(term.slope)) for term in self.objective.terms}
        if self.objective.linear > 0:
            weights[0.0] = math.log(self.objective.linear)
        whole = _log_sum(list(weights.values()))
        return [
            _Term(slope, weights[slope] - whole, self.problem.priced(_agent(slope)))
            for slope in sorted(weights, reverse=True)
        ]

    def outcome(self, limits: Limits) -> PolicyOutcome:
        """Search with one cut after the other, and return what was found."""
        cut = self.first_cut
        best: tuple[PolicyOutcome, int | None] | None = None
        while True:
            found = self._up_to(cut, limits)
            self.bound = max(self.bound, -math.inf if found.lower is None else found.lower)
            if found.graph is None:
                break
            worth = self.value_of(found.graph.flat)
            if math.isinf(worth):  # the core has found it to be finite: a spectral radius of nearly 1
                self.is_undecided = True
                found = replace(found, status=Status.UNSOLVABLE, graph=None, upper=None)
                break
            if best is None or worth < self.value:
                best, self.value = (found, cut), worth
            if self._is_optimal or self.stopped is not None:
                break
            if found.upper is not None and found.upper - self.bound > self._slack / 2:
                if self.tolerance < LEAST_TOLERANCE:
                    break
                self.tolerance /= FINER
                self.run.set_precision(self.tolerance)
            elif cut == MOST_CUT:
                break
            else:
                cut = min(math.ceil(min(self.value / self.step, MOST_CUT)) if cut is None else 2 * cut + 1, MOST_CUT)
        return found if best is None else self._closed(*best, cut, limits)

    @property
    def _slack(self) -> float:
        return self.precision * max(1.0, abs(self.value))

    @property
    def _is_optimal(self) -> bool:
        return self.value - self.bound <= self._slack

    def _closed(self, best: PolicyOutcome, its_cut: int | None, cut: int | None, limits: Limits) -> PolicyOutcome:
        """Return the best outcome; where it is not that of the last run, its policy is found again, to be read."""
        stopped = None if self._is_optimal else self.stopped
        if its_cut != cut:
            again = self._up_to(its_cut, limits.with_grace(1.0, is_over=self.stopped is not None))
            best = best if again.graph is None else again
        status = Status.OPTIMAL if self._is_optimal else Status.SOLVED
        low, high = finite(self.bound), finite(self.value)
        return replace(best, status=status, stopped=stopped, lower=low, upper=high, effort=self.effort)

    def _up_to(self, cut: int | None, limits: Limits) -> PolicyOutcome:
        """Search for the best policy that remembers so many steps, or nothing at all.

        The lower bound is one of all policies. The upper bound is none of them, but what the policy would be worth if
        beyond the cut all terms were as small as they can be.
        """
        if cut is not None:
            found = self.start(self.run, limits, cut)
            return self.finished(found.lower, found.upper, self.run, SpendingLaws(self.grid), found.upper < math.inf)
        lower, upper, stopped = list[float](), list[float](), None
        for number, term in reversed(list(enumerate(self.terms))):
            found = self.start(self.run, limits.with_grace(1.0, is_over=True) if stopped else limits, -1 - number)
            lower.append(term.log_weight + self.sign * found.lower)
            upper.append(term.log_weight + self.sign * (found.upper if found.upper < math.inf else found.lower))
            stopped = stopped or self.stopped
        self.stopped = stopped
        laws, has_policy = BranchLaws(self.problem.grounding), found.upper < math.inf
        low, high = (math.inf if found.lower == math.inf else self.sign * _log_sum(logs) for logs in (lower, upper))
        return self.finished(low, high, self.run, laws, has_policy)

    @property
    def options(self) -> _relax.PolicySearchOptions:
        """What the core is asked for."""
        options = super().options
        options.precision = self.tolerance
        return options

    def values(self, lower: float, upper: float) -> tuple[float | None, float | None]:
        """Return the certainty equivalents of bounds."""
        low, high = (
            None if math.isinf(worth) else self.run.certain_cost(worth + slack * max(1.0, abs(worth)))
            for worth, slack in ((lower, -ROUNDING), (upper, ROUNDING))
        )
        return low, None if high is None else min(high, sys.float_info.max)

    def _report(self, statistics: _relax.PolicyStatistics) -> None:
        assert self.watch is not None
        seconds, effort = time.monotonic() - self.started, effort_of(statistics)
        self.watch(Progress(seconds, effort, finite(self.bound), finite(self.value)))


def _agent(slope: float) -> Neutral | Exponential:
    if slope == 0:
        return Neutral()
    return Exponential(Attitude.AVERSE if slope > 0 else Attitude.SEEKING, abs(slope))


def _log_sum(logs: Sequence[float]) -> float:
    largest = max(logs)
    if math.isinf(largest):
        return largest
    return largest + math.log(math.fsum(math.exp(log - largest) for log in logs))
