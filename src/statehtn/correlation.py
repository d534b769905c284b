"""What a plan costs in each scenario, and what it is worth to know that costs hang together."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from statehtn.found_plan import FoundPlan
from statehtn.model.chance import Scenario
from statehtn.model.cost.distribution import CostDistribution
from statehtn.model.cost.law import CostLaw
from statehtn.model.cost.scenario_cost import ScenarioCost, as_if_independent, sum_of, total_by_scenario
from statehtn.model.plan import Plan
from statehtn.risk import Objective

MOST_LISTED = 100
"""Outcomes of a scenario in the JSON object."""


@dataclass(frozen=True, slots=True)
class ScenarioLaw:
    """What a plan costs in a scenario.

    Args:
        scenario: what is hidden, and how likely it is.
        law: of the total cost where it is so.
    """

    scenario: Scenario
    law: CostLaw

    def to_dict(self) -> dict[str, Any]:
        """Return the entry of `scenarios` in the JSON object."""
        outcomes = self.law.outcomes if isinstance(self.law, CostDistribution) else ()
        return {
            "name": self.scenario.name,
            "probability": self.scenario.probability,
            "expected_cost": self.law.mean,
            "least": self.law.least,
            "most": self.law.most,
            "outcomes": [list(pair) for pair in outcomes] if 0 < len(outcomes) <= MOST_LISTED else None,
        }


@dataclass(frozen=True, slots=True)
class Correlation:
    """What it is worth to know that costs hang together.

    Args:
        plan: the plan that is best if each action's cost is taken as independent of the others, with its true worth.
        believed: its value if that were so.
        difference: by how much its true value exceeds that of the plan that was found, in the objective's unit.
    """

    plan: FoundPlan
    believed: float
    difference: float

    def to_dict(self) -> dict[str, Any]:
        """Return the entry `correlation` of the JSON object."""
        return {
            "plan": [str(step.step) for step in self.plan.steps],
            "value": self.plan.value,
            "believed": self.believed,
            "difference": self.difference,
        }


def scenario_laws(plan: Plan) -> tuple[ScenarioLaw, ...]:
    """Return what a plan that knows its costs costs in each scenario; empty where no cost depends on one."""
    costs = plan.costs or ()
    if not any(isinstance(law, ScenarioCost) for law in costs):
        return ()
    total = total_by_scenario(costs)
    assert isinstance(total, ScenarioCost)
    return tuple(map(ScenarioLaw, total.scenarios, total.laws))


def value_as_if_independent(plan: Plan, objective: Objective) -> float | None:
    """Return what a plan would be worth if its actions' costs were independent; None where that cannot be told."""
    laws = as_if_independent(plan.costs or ())
    return None if laws is None else objective.value(sum_of(laws))
