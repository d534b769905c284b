"""The judge of plans: whether a plan is executable, whether its decomposition is right, and what it costs."""

from __future__ import annotations

from dataclasses import dataclass

from statehtn.display.law import brief
from statehtn.display.validation import validation_html
from statehtn.limits import Limits
from statehtn.model.expect import expect_plan, expect_problem, expect_utility
from statehtn.model.law import CostLaw
from statehtn.model.plan import Plan
from statehtn.model.problem import Problem
from statehtn.risk import Utility, plan_expected_cost, plan_risk_cost
from statehtn.validate.decomposition import match_networks
from statehtn.validate.execution import execute
from statehtn.validate.ordering import check_ordering
from statehtn.validate.tree import PlanTree
from statehtn.validate.world import World


@dataclass(frozen=True, slots=True, repr=False)
class Validation:
    """What the validation of a plan found; true where the plan is valid.

    Args:
        reasons: what is wrong, each in one sentence; steps are counted from 1. Empty for a valid plan.
        costs: the cost distribution of each step in the state it is executed in, up to the first step that cannot be
            executed.
    """

    reasons: tuple[str, ...]
    costs: tuple[CostLaw, ...]

    @property
    def valid(self) -> bool:
        """True if the plan solves the problem."""
        return not self.reasons

    def __bool__(self) -> bool:
        return self.valid

    def __str__(self) -> str:
        """Say "valid", or "invalid" and why, a reason in each line."""
        return "valid" if self.valid else "\n- ".join(("invalid:", *self.reasons))

    def __repr__(self) -> str:
        if self.valid:
            return f"<validation: valid, {len(self.costs)} steps, expected cost {self.expected_cost:.10g}>"
        more = f" (and {len(self.reasons) - 1} more reasons)" if len(self.reasons) > 1 else ""
        return f"<validation: invalid: {brief(self.reasons[0])}{more}>"

    def _repr_html_(self) -> str:
        return validation_html(self.valid, self.reasons, self.costs)

    @property
    def expected_cost(self) -> float:
        """The expected cost of the steps in `costs`: positive, in the domain's unit."""
        return plan_expected_cost(self.costs)

    def risk_cost(self, utility: Utility) -> float:
        """Return the certainty-equivalent cost of the steps in `costs` to an agent: positive, in the domain's unit."""
        expect_utility(utility)
        return plan_risk_cost(self.costs, utility)


def validate(problem: Problem, plan: Plan, limits: Limits = Limits()) -> Validation:
    """Check a plan and its decomposition against the lifted problem, and recompute its costs.

    The plan is valid if
    - every step is an instance of an action and executable in the state that the steps before it lead to, and the goal
      holds at the end;
    - the decomposition derives exactly the plan's steps from the initial network: every compound task by a method for
      it, under bindings of the right types that satisfy the method's constraints (bindings that the plan leaves open
      are solved for);
    - the order of the steps respects the ordering of every network, also across tasks that have no steps;
    - every method precondition holds in some state after everything ordered before the method's task has ended and
      before the method's first subtask starts, a parent's before its children's.

    The time is linear in the length of the plan where all networks are ordered totally.

    Args:
        problem: a problem, such as `read_hddl` returns.
        plan: a plan for it, such as `statehtn.plan(problem).plan`, or `read_plan` returns.
        limits: time and memory for it.

    Raises:
        InputError: the cost of a step is not defined (a value is missing in `:init`, say).
        LimitReached: a limit was reached before the plan was checked.
    """
    world = World(expect_problem(problem), limits)
    expect_plan(plan)
    execution = execute(plan, world)
    tree = PlanTree(plan, world)
    matching = match_networks(tree, world)
    reasons = [*execution.reasons, *matching.reasons]
    if not matching.reasons:
        reasons += check_ordering(tree, matching, world, execution.history)
    return Validation(tuple(reasons), execution.costs)
