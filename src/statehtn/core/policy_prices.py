"""Policies of agents who do not mind what they have spent: neutral and exponential ones, and those after success."""

from __future__ import annotations

import math
from dataclasses import replace

import statehtn._relax as _relax
from statehtn.core.policy_chord import ExploredPolicies
from statehtn.core.policy_laws import BranchLaws
from statehtn.core.policy_outcome import PolicyOutcome
from statehtn.core.policy_problem import PolicyProblem
from statehtn.core.policy_run import PolicyRun, Watch
from statehtn.core.pricing import check_exponent
from statehtn.limits import Limits
from statehtn.risk.exponential import Exponential
from statehtn.risk.neutral import Neutral
from statehtn.risk.utility import Attitude


class PricedPolicies(PolicyRun):
    """The best policy by an objective whose certainty equivalents of independent costs add up.

    Args:
        problem: the ground problem.
        objective: the agent.
        failure_cost: what giving up adds to what was spent; None where it is not allowed.
        precision: see `PolicyRun`.
        watch: likewise.
    """

    def __init__(
        self,
        problem: PolicyProblem,
        objective: Neutral | Exponential,
        failure_cost: float | None,
        precision: float,
        watch: Watch,
    ) -> None:
        super().__init__(problem, precision, watch)
        self.objective = objective
        self.slope = objective.slope if isinstance(objective, Exponential) else 1.0
        self.failure_cost = failure_cost
        self.worth_unit = 1 / abs(self.slope)
        if isinstance(objective, Exponential):
            is_averse = objective.attitude == Attitude.AVERSE
            self.recursion = _relax.Recursion.Averse if is_averse else _relax.Recursion.Seeking

    def outcome(self, limits: Limits) -> PolicyOutcome:
        """Search, and return what was found.

        Raises:
            UsageError: alpha times a cost is too large to be added up along a run.
        """
        prices = self.problem.priced(self.objective)
        largest = max([*prices.actions, *prices.parts, self.failure_cost or 0.0])
        check_exponent(self.objective, self.slope, largest)
        actions, parts = ([self.slope * price for price in amounts] for amounts in (prices.actions, prices.parts))
        none = [0.0] * len(actions), [0.0] * len(parts)
        stop = math.inf if self.failure_cost is None else abs(self.slope) * self.failure_cost
        run = self.problem.run(self.options, prices.handle, only_done_runs_pay=self.failure_cost is None)
        run.take_amounts(actions, parts, *none, stop, abs(self.slope) * prices.unit, self.problem.heuristic)
        found = self.start(run, limits)
        laws = BranchLaws(self.problem.grounding)
        outcome = self.finished(found.lower, found.upper, run, laws, found.upper < math.inf)
        if self.recursion != _relax.Recursion.Averse or found.expanded == 0:
            return outcome
        return replace(outcome, explored=ExploredPolicies(self.problem, run, 1 / self.slope))


class SuccessPolicies(PolicyRun):
    """The largest probability of being done; of the policies that have it, the one of least expected cost.

    The core minimises the probability of not being done: stopping is worth 1, and no step costs anything.
    """

    breaks_ties = True

    def outcome(self, limits: Limits) -> PolicyOutcome:
        """Search, and return what was found; values are probabilities of being done."""
        prices = self.problem.means
        none = [0.0] * len(prices.actions), [0.0] * len(prices.parts)
        run = self.problem.run(self.options, prices.handle, only_done_runs_pay=False)
        run.take_amounts(*none, prices.actions, prices.parts, 1.0, 0.0, self.problem.heuristic)
        found = self.start(run, limits)
        outcome = self.finished(found.lower, found.upper, run, BranchLaws(self.problem.grounding), found.upper <= 1)
        return replace(outcome, lower=max(0.0, 1 - min(found.upper, 1.0)), upper=min(1.0, 1 - found.lower))


def most_success(problem: PolicyProblem, limits: Limits) -> float | None:
    """Return the largest probability of being done, as far as it was found within the limits; None where none was."""
    outcome = SuccessPolicies(problem, 1e-9, None).outcome(limits)
    return None if outcome.graph is None else outcome.lower
