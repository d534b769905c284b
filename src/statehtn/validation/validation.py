"""The judge of plans: whether a plan is executable, whether its decomposition is right, and what it costs."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from statehtn.collector import without_collector
from statehtn.counted import brief, counted
from statehtn.errors import UsageError
from statehtn.limits import Limits
from statehtn.model.cost.law import CostLaw
from statehtn.model.expect import expect_plan, expect_problem, expect_utility
from statehtn.model.plan import Plan, Step
from statehtn.model.problem import Fact, Problem
from statehtn.model.status import Status
from statehtn.risk import Utility, plan_expected_cost, plan_risk_cost
from statehtn.semantics.execution import execute
from statehtn.semantics.outcomes import Changes
from statehtn.semantics.world import World
from statehtn.validation.decomposition import match_networks
from statehtn.validation.ordering import check_ordering
from statehtn.validation.tree import PlanTree

_STEP = re.compile(r"step (\d+) \([^()]*\): ")


@dataclass(frozen=True, slots=True, repr=False)
class Validation:
    """What the validation of a plan found; true where the plan is valid.

    Args:
        reasons: what is wrong, each in one sentence; steps are counted from 1. Empty for a valid plan.
        costs: the cost distribution of each step in the state it is executed in, up to the first step that cannot be
            executed.
        plan: the plan with the decomposition that was found for a list of actions; None for plans that had one.
        stopped: what ended the search for that before it was done: whether the actions are a plan is not known then.
    """

    reasons: tuple[str, ...]
    costs: tuple[CostLaw, ...]
    plan: Plan | None = None
    stopped: Status | None = None

    @property
    def valid(self) -> bool:
        """True if the plan solves the problem."""
        return not self.reasons

    def __bool__(self) -> bool:
        return self.valid

    def __str__(self) -> str:
        """Say "valid", or "invalid" and why, a reason in each line."""
        verdict = "invalid:" if self.stopped is None else "not decided:"
        return "valid" if self.valid else "\n- ".join((verdict, *self.reasons))

    def to_dict(self) -> dict[str, Any]:
        """Return the object that `statehtn validate --json` prints."""
        return {
            "valid": None if self.stopped is not None else self.valid,
            "reasons": list(self.reasons),
            "stopped": None if self.stopped is None else self.stopped.value,
            "executed": len(self.costs),
            "expected_cost": self.expected_cost if self.valid else None,
        }

    def __repr__(self) -> str:
        if self.valid:
            return f"<validation: valid, {counted(len(self.costs), 'step')}, expected cost {self.expected_cost:.10g}>"
        more = f" (and {counted(len(self.reasons) - 1, 'more reason')})" if len(self.reasons) > 1 else ""
        return f"<validation: invalid: {brief(self.reasons[0])}{more}>"

    def _repr_html_(self) -> str:
        from statehtn.display.validation import validation_html

        return validation_html(self)

    @property
    def expected_cost(self) -> float:
        """The expected cost of the steps in `costs`: positive, in the domain's unit."""
        return plan_expected_cost(self.costs)

    def risk_cost(self, utility: Utility) -> float:
        """Return the certainty-equivalent cost of the steps in `costs` to an agent: positive, in the domain's unit."""
        expect_utility(utility)
        return plan_risk_cost(self.costs, utility)


def validate(problem: Problem, plan: Plan, limits: Limits = Limits()) -> Validation:
    """Check a plan and its decomposition as `statehtn.validate` does, which says what makes a plan valid.

    Raises:
        InputError: the cost of a step is not defined (a value is missing in `:init`, say).
        LimitReached: a limit was reached before the plan was checked.
    """
    return _checked(expect_problem(problem), expect_plan(plan), None, None, limits)


def _checked(
    problem: Problem, plan: Plan, came: Sequence[Changes] | None, seen: frozenset[Fact] | None, limits: Limits
) -> Validation:
    world = World(problem, limits)
    with without_collector():
        execution = execute(plan, world, came, seen)
        tree = PlanTree(plan, world)
        matching = match_networks(tree, world)
        reasons = [*execution.reasons, *matching.reasons]
        if not matching.reasons:
            reasons += check_ordering(tree, matching, world, execution.history)
    return Validation(told_once(reasons), execution.costs)


def validate_trajectory(
    problem: Problem,
    plan: Plan,
    came: Sequence[Changes],
    seen: frozenset[Fact] | None = None,
    limits: Limits = Limits(),
) -> Validation:
    """Check a run in which chance has chosen: whether its steps, what came of them and its decomposition are right.

    Args:
        problem: the problem, in which actions may have several outcomes.
        plan: the actions of a run that is done, and their decomposition.
        came: for each step the facts that are true after it and those that are false; others are as before.
        seen: facts by which outcomes are told apart, such as those of the ground problem; None for all facts.
        limits: of the checking.

    Raises:
        UsageError: there is not one of `came` for each step.
        InputError: a cost or a probability is not defined.
        LimitReached: a limit was reached before the run was checked.
    """
    if len(came) != len(plan.steps):
        raise UsageError(f"a run of {counted(len(plan.steps), 'step')} needs what came of each, found {len(came)}")
    return _checked(expect_problem(problem), plan, came, seen, limits)


def execute_steps(problem: Problem, steps: Sequence[Step], limits: Limits = Limits()) -> Validation:
    """Check whether steps can be executed one after the other and reach the goal; decompositions are not looked at.

    Raises:
        InputError: the cost of a step is not defined.
        LimitReached: a limit was reached.
    """
    execution = execute(Plan(tuple(steps)), World(problem, limits))
    return Validation(told_once(execution.reasons), execution.costs)


def told_once(reasons: Sequence[str]) -> tuple[str, ...]:
    """Return reasons, each once: what is wrong with several steps is told of the first, with the numbers of others."""
    by_cause: dict[str, list[str]] = {}
    for reason in reasons:
        match = _STEP.match(reason)
        by_cause.setdefault(reason[match.end() :] if match else reason, []).append(reason)
    found = []
    for same in by_cause.values():
        others = [match[1] for reason in same[1:] if (match := _STEP.match(reason))]
        steps = f"{'steps' if len(others) > 1 else 'step'} {', '.join(others[:5])}{' ...' if len(others) > 5 else ''}"
        more = f" (likewise {len(others)} more: {steps})"
        found.append(same[0] + (more if others else ""))
    return tuple(found)
