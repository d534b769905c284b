"""A plan that a search has found: validated independently of the search, and priced in the states it runs through."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from statehtn.errors import InternalError
from statehtn.limits import ENDINGS, Limits, status_of
from statehtn.model.cost.law import CostLaw
from statehtn.model.cost.unknown import refuse_unknown
from statehtn.model.plan import Plan
from statehtn.model.problem import Problem
from statehtn.model.status import Status
from statehtn.result import PricedStep, PricedSteps
from statehtn.risk import Utility
from statehtn.validation import validate

SECONDS_TO_VALIDATE = 0.2
"""A plan that is found right before the time is over is given that long: enough for some thousands of steps."""


@dataclass(frozen=True, slots=True)
class FoundPlan:
    """A plan and its steps with their prices.

    Args:
        plan: the plan.
        steps: its actions with their costs: as validation has them, or as the search has them where nothing validated
            the plan.
        stopped: what ended validation before it had come to its end; None where the plan is valid.
    """

    plan: Plan
    steps: PricedSteps
    stopped: Status | None

    @property
    def validated(self) -> bool:
        """Whether the plan was validated."""
        return self.stopped is None


def validated_and_priced(problem: Problem, plan: Plan, utility: Utility, limits: Limits) -> FoundPlan:
    """Validate a plan that a search has found, and price its steps in the states they are executed in.

    Where a limit or Ctrl-C ends that, the plan is returned as the search has it.

    Args:
        problem: the problem.
        plan: the plan, with the costs that the search has seen.
        utility: the agent's.
        limits: they hold; a run that has used up its own may have a little grace (`SECONDS_TO_VALIDATE`).

    Raises:
        InternalError: the plan is wrong.
        MissingNumber: a cost of the plan needs a number that `:init` does not give.
    """
    try:
        validation = validate(problem, plan, limits)
    except ENDINGS as ending:
        return not_validated(plan, utility, status_of(ending))
    if not validation.valid:
        raise InternalError(f"the search returned a wrong plan: {'; '.join(validation.reasons)}")
    costs = validation.costs
    return FoundPlan(plan.with_costs(costs), _priced(plan, costs, utility), None)


def not_validated(plan: Plan, utility: Utility, stopped: Status) -> FoundPlan:
    """Return a plan with the prices of the search, since something ended the run before validation did.

    Raises:
        MissingNumber: a cost of the plan needs a number that `:init` does not give.
    """
    assert plan.costs is not None
    refuse_unknown(plan.costs)
    return FoundPlan(plan, _priced(plan, plan.costs, utility), stopped)


def _priced(plan: Plan, costs: Sequence[CostLaw], utility: Utility) -> PricedSteps:
    """Return the steps with their prices; a law is priced once, and equal steps of one law are one object."""
    known: dict[tuple[object, int], PricedStep] = {}
    prices: dict[int, tuple[float, float]] = {}
    steps: list[PricedStep] = []
    for step, law in zip(plan.steps, costs, strict=True):
        priced = known.get((step, id(law)))
        if priced is None:
            if id(law) not in prices:
                prices[id(law)] = law.mean, utility.risk_cost(law)
            priced = known[step, id(law)] = PricedStep(step, law, *prices[id(law)])
        steps.append(priced)
    return PricedSteps(steps)
