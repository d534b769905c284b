"""A plan that a search has found: validated independently of the search, and priced in the states it runs through."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import partial
from typing import Any

from statehtn.counted import brief
from statehtn.errors import InputError, InternalError
from statehtn.limits import ENDINGS, Limits, status_of
from statehtn.model.cost.distribution import CostDistribution
from statehtn.model.cost.law import CostLaw
from statehtn.model.cost.scenario_cost import sum_of
from statehtn.model.cost.unknown import refuse_unknown
from statehtn.model.plan import MOST_SHOWN, Plan, Step
from statehtn.model.plan_outcome import PlanOutcome
from statehtn.model.problem import Problem
from statehtn.model.status import Status
from statehtn.risk import (
    AdditiveObjective,
    Keep,
    Objective,
    SuccessUtility,
    ValueUnit,
    adds_up,
    agent_in,
    certainty_equivalent,
    plan_risk_cost,
)
from statehtn.risk.valued import value_of_total
from statehtn.validation import validate

SECONDS_TO_VALIDATE = 0.2
"""A plan that is found right before the time is over is given that long: enough for some thousands of steps."""

PRICES = ("plan", "length", "expected_cost", "risk_cost", "expected_utility", "log10_expected_utility", "value")
"""What the JSON objects say of a plan."""


@dataclass(frozen=True, slots=True)
class Kept:
    """A budget that plans have to keep with a probability, and the probability with which it is kept.

    Args:
        budget: in the domain's unit.
        probability: with which the total cost must not exceed it, at least.
        attained: with which a plan does not exceed it; where no plan keeps all budgets, the largest that was found for
            this one alone. None where that is not known.
        at_most: where no plan keeps all budgets: no plan attains more than this, which is proven and, but for rounding
            and continuous costs, what is attained; else None.
    """

    budget: float
    probability: float
    attained: float | None
    at_most: float | None = None

    def to_dict(self) -> dict[str, Any]:
        """Return the entry of `keep` in the JSON object."""
        return {name: getattr(self, name) for name in ("budget", "probability", "attained", "at_most")}


@dataclass(frozen=True, slots=True, repr=False)
class PricedStep:
    """An action of a plan and what it costs in the state in which it is executed.

    Args:
        step: the ground action.
        law: the distribution of its cost.
        expected_cost: the mean of the distribution, positive, in the domain's unit.
        risk_cost: what it adds to the value of the plan, in the same unit: for an agent that the paper knows the
            certainty equivalent of the distribution. None where such prices do not add up.
        outcome: the one that the plan counts on; None where actions have one outcome each.
    """

    step: Step
    law: CostLaw
    expected_cost: float
    risk_cost: float | None
    outcome: PlanOutcome | None = None

    @property
    def probability(self) -> float:
        """That the outcome comes which the plan counts on; 1 where the action has no other."""
        return 1.0 if self.outcome is None else float(self.outcome.probability)

    def __repr__(self) -> str:
        price = f"mean {self.expected_cost:.6g}"
        if self.risk_cost is not None:
            price = f"certainty equivalent {self.risk_cost:.6g}"
        return f"<{self.step}: {brief(str(self.law))}; {price}>"

    def to_dict(self) -> dict[str, Any]:
        """Return the entry of `plan` in the JSON object.

        `outcomes` is null for a law that is no list of outcomes; `law` then says in words what it is.
        """
        entry = {
            "action": self.step.action,
            "arguments": list(self.step.arguments),
            "expected_cost": self.expected_cost,
            "risk_cost": self.risk_cost,
            **({} if self.outcome is None or self.outcome.probability == 1 else self.outcome.to_dict()),
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
    """A plan, and what it is worth by the objective it was made for.

    Args:
        plan: the plan, with its decomposition.
        steps: its actions with their costs: as validation has them, or as the search has them where nothing validated
            the plan.
        objective: what plans are compared by.
        unchecked: what ended its validation before it had come to its end; None where the plan is valid.
        value: what the law of its total cost is worth by the objective, in its unit; the search minimises it.
        risk_cost: the certain cost that has this value, positive, in the domain's unit: the certainty equivalent; None
            where there is none, as for a probability.
        keep: the budgets that it has to keep.
    """

    plan: Plan
    steps: PricedSteps
    objective: Objective
    unchecked: Status | None
    value: float
    risk_cost: float | None
    keep: tuple[Kept, ...]

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
    def expected_utility(self) -> str | None:
        """Its expected utility as a decimal number of any size; None for an agent that the paper does not know."""
        agent = agent_in(self.objective)
        return None if agent is None else agent.expected_utility_text(self.value)

    @property
    def log10_expected_utility(self) -> float | None:
        """The paper's column: `log10 EU` of a seeking agent, `-log10 |EU|` of an averse one, None of any other."""
        agent = agent_in(self.objective)
        return None if agent is None else agent.log10_expected_utility(self.value)

    def to_dict(self) -> dict[str, Any]:
        """Return the plan with its prices as plain data."""
        return {"plan": [step.to_dict() for step in self.steps], **{name: getattr(self, name) for name in PRICES[1:]}}


def validated_and_priced(
    problem: Problem, plan: Plan, objective: Objective, keep: Sequence[Keep], limits: Limits
) -> FoundPlan:
    """Validate a plan that a search has found, and price its steps in the states they are executed in.

    Where a limit or Ctrl-C ends that, the plan is returned as the search has it.

    Args:
        problem: the problem.
        plan: the plan, with the costs that the search has seen.
        objective: what plans are compared by.
        keep: the budgets that plans have to keep.
        limits: they hold; a run that has used up its own may have a little grace (`SECONDS_TO_VALIDATE`).

    Raises:
        InternalError: the plan is wrong.
        MissingNumber: a cost of the plan needs a number that `:init` does not give.
    """
    try:
        validation = validate(problem, plan, limits)
    except ENDINGS as ending:
        return not_validated(plan, objective, keep, status_of(ending))
    if not validation.valid:
        raise InternalError(f"the search returned a wrong plan: {'; '.join(validation.reasons)}")
    return priced(validation.settled(plan), objective, keep)


def not_validated(plan: Plan, objective: Objective, keep: Sequence[Keep], stopped: Status) -> FoundPlan:
    """Return a plan with the prices of the search, since something ended the run before validation did.

    Raises:
        MissingNumber: a cost of the plan needs a number that `:init` does not give.
    """
    assert plan.costs is not None
    refuse_unknown(plan.costs)
    return priced(plan, objective, keep, stopped)


def priced(plan: Plan, objective: Objective, keep: Sequence[Keep] = (), unchecked: Status | None = None) -> FoundPlan:
    """Return a plan that knows what its steps cost with what it is worth.

    Raises:
        InputError: it is worth nothing finite, or that cannot be computed.
    """
    assert plan.costs is not None
    steps = _priced_steps(plan, plan.costs, objective)
    has_prices = adds_up(objective, plan.costs)
    law = None if has_prices and not keep else sum_of(plan.costs)
    prices = (step.risk_cost or 0.0 for step in steps)
    if law is None or has_prices:
        value = math.fsum(prices)
    else:
        value = value_of_total(objective, law, ((one.law, partial(str, one.step)) for one in steps))
    budgets = tuple(Kept(one.budget, one.probability, None if law is None else one.attained(law)) for one in keep)
    risk_cost: float | None = None
    if objective.unit is ValueUnit.COST and (law is None or has_prices):
        risk_cost = value
    elif law is not None:
        risk_cost = certainty_equivalent(objective, law, value)
    return FoundPlan(plan, steps, objective, unchecked, value, risk_cost, budgets)


def value_of(plan: Plan, objective: Objective) -> float:
    """Return what the total cost of a plan that knows its costs is worth: a sum of prices where they add up.

    Raises:
        InputError: it is worth nothing finite, or that cannot be computed.
    """
    assert plan.costs is not None
    if plan.outcomes is not None:  # what it counts on has a price, too
        return priced(plan, objective).value
    if isinstance(objective, AdditiveObjective) and adds_up(objective, plan.costs):
        return plan_risk_cost(plan.costs, objective)
    parts = ((law, partial(str, step)) for law, step in zip(plan.costs, plan.steps, strict=True))
    return value_of_total(objective, sum_of(plan.costs), parts)


def _priced_steps(plan: Plan, costs: Sequence[CostLaw], objective: Objective) -> PricedSteps:
    """Return the steps with their prices; a law is priced once, and equal steps of one law are one object."""
    known: dict[tuple[object, int, PlanOutcome | None], PricedStep] = {}
    prices: dict[int, tuple[float, float | None]] = {}
    is_priced = adds_up(objective, costs)
    price_of = objective.risk_cost if is_priced and isinstance(objective, AdditiveObjective) else lambda _: None
    outcomes = (None,) * len(costs) if plan.outcomes is None else plan.outcomes
    steps: list[PricedStep] = []
    for step, law, outcome in zip(plan.steps, costs, outcomes, strict=True):
        one = known.get((step, id(law), outcome))
        if one is None:
            if id(law) not in prices:
                prices[id(law)] = law.mean, price_of(law)
            mean, price = prices[id(law)]
            if outcome is not None and isinstance(objective, SuccessUtility) and price is not None:
                price += _price_of(outcome.probability, step, objective)
            one = known[step, id(law), outcome] = PricedStep(step, law, mean, price, outcome)
        steps.append(one)
    return PricedSteps(steps)


def _price_of(chance: Fraction, step: Step, objective: SuccessUtility) -> float:
    """Return the price of counting on an outcome.

    Raises:
        InputError: it cannot come.
    """
    if not chance:
        raise InputError(f"every plan counts on an outcome of {step} of probability 0, so that none is worth anything")
    return objective.outcome_price(float(chance))
