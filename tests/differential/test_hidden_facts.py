"""Costs that hang together by hidden facts: what plans cost in each scenario, and the plan of least mean cost."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from statehtn import CostDistribution, CostLaw, Plan, validate
from statehtn.core.grounding import GroundingSwitches, ground
from statehtn.core.pricing import price
from statehtn.core.top_plans import find_top_plans
from statehtn.model import Problem
from statehtn.risk import Neutral
from tests.brute_force import LARGEST_NETWORK, all_plans
from tests.differential.oracles import LIMITS, close_to, must_have_ended, solve
from tests.scenarios import correlated_problems, mixture, totals
from tests.shares import share_of_examples
from tests.strategies import grounding_switches

SHARE = share_of_examples(3)


def must_equal(law: CostLaw, expected: CostDistribution) -> None:
    assert isinstance(law, CostDistribution)
    merged: dict[float, float] = {}  # convolutions round costs that are equal otherwise
    for given_law, sign in ((law, 1), (expected, -1)):
        for probability, cost in given_law.outcomes:
            merged[round(cost, 9)] = merged.get(round(cost, 9), 0) + sign * probability
    assert all(abs(rest) < 1e-9 for rest in merged.values()), (law.outcomes, expected.outcomes)


def must_cost_in_each_scenario(problem: Problem, plan: Plan) -> None:
    expected = totals(problem, plan)
    must_equal(plan.cost_distribution(), mixture(expected))
    for scenario, (_, law) in zip(problem.scenarios, expected, strict=True):
        must_equal(plan.cost_distribution_given(scenario), law)


@SHARE
@given(problem=correlated_problems())
def test_plans_cost_what_they_cost_in_each_scenario(problem: Problem) -> None:
    for plan in all_plans(problem, most=1500, largest_network=LARGEST_NETWORK)[:20]:
        validation = validate(problem, plan)
        assert validation.valid, validation.reasons
        must_cost_in_each_scenario(problem, plan.with_costs(validation.costs))


@SHARE
@given(problem=correlated_problems(), switches=grounding_switches())
def test_ground_costs_are_those_of_each_scenario(problem: Problem, switches: GroundingSwitches) -> None:
    outcome = find_top_plans(price(ground(problem, switches=switches), Neutral()), 3, limits=LIMITS)
    for plan in outcome.plans:
        must_cost_in_each_scenario(problem, plan)
    must_have_ended(outcome.stopped)


@pytest.mark.parametrize("solver", ["state", "plan"])
@pytest.mark.parametrize("orders", [("total",), ("none", "partial")])
@SHARE
@given(data=st.data())
def test_the_plan_of_least_mean_cost(solver: str, orders: tuple[str, ...], data: st.DataObject) -> None:
    problem = data.draw(correlated_problems(orders))
    plans = all_plans(problem, most=1500, largest_network=LARGEST_NETWORK)
    result = solve(problem, Neutral(), solver=solver)
    must_have_ended(result.stopped)
    means = [mixture(totals(problem, plan)).mean for plan in plans]
    assert bool(result) == bool(plans)
    if result.plan is not None:
        assert result.plan.cost_distribution().mean == close_to(min(means))
        assert result.risk_cost == close_to(min(means))
