"""A plan that a search has found: validated independently of the search, and priced in the states it runs through."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from statehtn.counted import brief
from statehtn.errors import InternalError
from statehtn.limits import ENDINGS, Limits, status_of
from statehtn.model.cost.distribution import CostDistribution
from statehtn.model.cost.law import CostLaw
from statehtn.model.cost.unknown import refuse_unknown
from statehtn.model.plan import MOST_SHOWN, Plan, Step
from statehtn.model.problem import Problem
from statehtn.model.status import Status
from statehtn.risk import Utility
from statehtn.validation import validate

SECONDS_TO_VALIDATE = 0.2
"""A plan that is found right before the time is over is given that long: enough for some thousands of steps."""

PRICES = ("plan", "length", "expected_cost", "risk_cost", "expected_utility", "log10_expected_utility")
"""What the JSON objects say of a plan."""


@dataclass(frozen=True, slots=True, repr=False)
class PricedStep:
    """An action of a plan and what it costs in the state in which it is executed.

    Args:
        step: the ground action.
        law: the distribution of its cost.
        expected_cost: the mean of the distribution, positive, in the domain's unit.
        risk_cost: the certainty equivalent of the distribution for this agent, in the same unit.
    """

    step: Step
    law: CostLaw
    expected_cost: float
    risk_cost: float

    def __repr__(self) -> str:
        return f"<{self.step}: {brief(str(self.law))}; certainty equivalent {self.risk_cost:.6g}>"

    def to_dict(self) -> dict[str, Any]:
        """Return the entry of `plan` in the JSON object.

        `outcomes` is null for a law that is no list of outcomes; `law` then says in words what it is.
        """
        entry = {
            "action": self.step.action,
            "arguments": list(self.step.arguments),
            "expected_cost": self.expected_cost,
            "risk_cost": self.risk_cost,
        }
        if isinstance(self.law, CostDistribution):
            return entry | {"outcomes": [list(outcome) for outcome in self.law.outcomes]}
        return entry | {"outcomes": None, "law": str(self.law)}


class PricedSteps(tuple[PricedStep, ...]):
    """The steps of a plan in the order of their execution: a tuple that shows itself in short."""

    __slots__ = ()

    def __repr__(self) -> str:
        shown = " ".join(str(priced.step) for priced in self[:MOST_SHOWN])
        return f"<{len(self)} priced steps{': ' if self else ''}{shown}{' ...' if len(self) > MOST_SHOWN else ''}>"

    def _repr_html_(self) -> str:
        from statehtn.display.result import steps_html

        return steps_html(self)


@dataclass(frozen=True, slots=True, repr=False)
class FoundPlan:
    """A plan, and what it is worth to the agent it was made for.

    Args:
        plan: the plan, with its decomposition.
        steps: its actions with their costs: as validation has them, or as the search has them where nothing validated
            the plan.
        utility: the agent's utility function.
        unchecked: what ended its validation before it had come to its end; None where the plan is valid.
    """

    plan: Plan
    steps: PricedSteps
    utility: Utility
    unchecked: Status | None

    @property
    def validated(self) -> bool:
        """Whether the plan was checked independently of the search; a limit or an interruption may come first."""
        return self.unchecked is None

    @property
    def length(self) -> int:
        """The number of its actions; those of the domain only."""
        return len(self.steps)

    @property
    def expected_cost(self) -> float:
        """Its expected cost, positive, in the domain's unit."""
        return math.fsum(step.expected_cost for step in self.steps)

    @property
    def risk_cost(self) -> float:
        """Its certainty-equivalent cost, positive, in the domain's unit; the search minimises it."""
        return math.fsum(step.risk_cost for step in self.steps)

    @property
    def expected_utility(self) -> str:
        """Its expected utility as a decimal number of any size."""
        return self.utility.expected_utility_text(self.risk_cost)

    @property
    def log10_expected_utility(self) -> float | None:
        """The paper's column: `log10 EU` of a seeking agent, `-log10 |EU|` of an averse one, None of a neutral one."""
        return self.utility.log10_expected_utility(self.risk_cost)

    def to_dict(self) -> dict[str, Any]:
        """Return the plan with its prices as plain data."""
        return {"plan": [step.to_dict() for step in self.steps], **{name: getattr(self, name) for name in PRICES[1:]}}


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
    return FoundPlan(plan.with_costs(costs), _priced(plan, costs, utility), utility, None)


def not_validated(plan: Plan, utility: Utility, stopped: Status) -> FoundPlan:
    """Return a plan with the prices of the search, since something ended the run before validation did.

    Raises:
        MissingNumber: a cost of the plan needs a number that `:init` does not give.
    """
    assert plan.costs is not None
    refuse_unknown(plan.costs)
    return FoundPlan(plan, _priced(plan, plan.costs, utility), utility, stopped)


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
