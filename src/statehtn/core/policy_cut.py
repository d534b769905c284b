"""Policies of agents to whom it matters always what they have spent: one-switch ones, and sums of exponentials.

What was spent is remembered up to a cut; beyond it, policies are taken to be as good as they can be by each term of
the disutility (relax/policies/cut_source.hpp): so there is a bound of all policies, and a policy. What that is worth
follows from its runs. The cut moves until the two meet.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property

import statehtn._relax as _relax
from statehtn.core.law_grid import LawGrid
from statehtn.core.policy_laws import SpendingLaws
from statehtn.core.policy_outcome import PolicyOutcome
from statehtn.core.policy_problem import PolicyProblem, Prices
from statehtn.core.policy_run import PolicyRun, Watch
from statehtn.core.policy_spending import MOST_LEFT
from statehtn.limits import Limits
from statehtn.model.policy_graph import FlatPolicy
from statehtn.model.status import Status
from statehtn.risk import Attitude, Exponential, Exponentials, Neutral, OneSwitch

ROUNDING = 2.0**-38
"""Of the logarithm of an expected disutility, or of 1 if that is more."""
LEAST_TOLERANCE = 1e-15
FINER = 64
"""By which the tolerance is divided where certainty equivalents are farther apart than logarithms."""


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

    recursion = _relax.Recursion.LogExpected

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
        self.failure_cost = failure_cost
        self.grid = grid
        self.value_of = value_of
        self.tolerance = precision / 16
        """How far apart the bounds of the core may be: logarithms, relative to the larger, or to 1."""
        self.run: _relax.PolicyRun

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
        """Search with one cut after the other, and return what was found.

        At first nothing is remembered: one policy may be best for all terms. Then it is as much as that one is worth.
        """
        cut, bound, value = 0, -math.inf, math.inf
        best: PolicyOutcome | None = None
        while True:
            found = self._up_to(cut, limits)
            bound = max(bound, -math.inf if found.lower is None else found.lower)
            if found.graph is None:
                break
            assert found.upper is not None
            worth = self.value_of(found.graph.flat)
            if best is None or worth < value:
                best, value = found, worth
            slack = self.precision * max(1.0, abs(value))
            if value - bound <= slack or self.stopped is not None:
                break
            if found.upper - bound > slack / 2:
                if self.tolerance < LEAST_TOLERANCE:
                    break
                self.tolerance /= FINER
            elif cut == MOST_LEFT:
                break
            else:
                cut = min(2 * cut + 1 if cut else self._steps(value), MOST_LEFT)
        if best is None:
            return found
        is_optimal = value - bound <= self.precision * max(1.0, abs(value))
        status = Status.OPTIMAL if is_optimal else Status.SOLVED
        stopped = None if is_optimal else self.stopped
        low, high = (end if math.isfinite(end) else None for end in (bound, value))
        return PolicyOutcome(status, stopped, low, high, best.graph, self.effort, plan_of=best.plan_of)

    def _steps(self, cost: float) -> int:
        return math.ceil(min(cost / float(self.grid.grid.step), MOST_LEFT))

    def _up_to(self, cut: int, limits: Limits) -> PolicyOutcome:
        """Search for the best policy that remembers so many steps.

        The lower bound is one of all policies. The upper bound is none of them, but what the policy would be worth if
        beyond the cut all terms were as small as they can be.
        """
        is_sure = self.failure_cost is None
        handle = self.terms[0].prices.handle
        self.run = run = self.problem.run(self.options, handle, only_done_runs_pay=is_sure, sees_costs=True)
        for term in self.terms:
            prices = term.prices
            run.add_term(term.slope, term.log_weight, prices.actions, prices.parts, prices.handle, prices.unit)
        failure = math.inf if self.failure_cost is None else self.failure_cost
        run.take_terms(self.grid.costs, float(self.grid.grid.step), failure, self.problem.heuristic)
        before = self.effort
        found = self.start(run, limits, cut)
        self.effort += before
        return self.finished(found.lower, found.upper, run, SpendingLaws(self.grid), found.upper < math.inf)

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
        return low, None if high == math.inf else high


def _agent(slope: float) -> Neutral | Exponential:
    if slope == 0:
        return Neutral()
    return Exponential(Attitude.AVERSE if slope > 0 else Attitude.SEEKING, abs(slope))


def _log_sum(logs: Sequence[float]) -> float:
    largest = max(logs)
    return largest + math.log(math.fsum(math.exp(log - largest) for log in logs))
