"""The best plans are the best plans: compared with exhaustive search on random small problems."""

from __future__ import annotations

from dataclasses import fields

import pytest
from hypothesis import given
from hypothesis import strategies as st

from statehtn import Status, TopPlans, validate
from statehtn.core.grounding import GroundingSwitches, ground
from statehtn.core.pricing import price
from statehtn.core.switches import TopSwitches
from statehtn.core.top_plans import find_top_plans
from statehtn.model import Plan, Problem
from statehtn.risk import Utility
from tests.brute_force import LARGEST_NETWORK, all_plans, best_risk_costs
from tests.differential.oracles import ADMISSIBLE, LIMITS, close_to, must_cost, must_have_ended, solve_top
from tests.shares import share_of_examples
from tests.strategies import grounding_switches, problems, utilities

DISTINCT = ("sequence", "multiset")
HALF = share_of_examples(2)
SLACK = 1e-9


def key(plan: Plan, distinct: str) -> tuple[str, ...]:
    """What no two plans may have in common."""
    actions = tuple(map(str, plan.steps))
    return actions if distinct == "sequence" else tuple(sorted(actions))


def check(problem: Problem, utility: Utility, k: int, distinct: str, result: TopPlans) -> None:
    """The plans are valid and distinct, and those that are claimed to be the best are."""
    expected = best_risk_costs(problem, utility, k + 1, distinct)
    costs = [ranked.risk_cost for ranked in result]
    assert len({key(ranked.plan, distinct) for ranked in result}) == len(result) <= k
    for rank, ranked in enumerate(result, 1):
        must_cost(problem, ranked.plan, utility, ranked.risk_cost)
        assert ranked.rank == rank
        assert ranked.is_proven == (rank <= result.proven)
    assert costs[: result.proven] == close_to(expected[: result.proven])
    if result.stopped is None:
        assert costs == close_to(expected[:k])
        assert result.proven == len(result)
        assert result.status is (Status.OPTIMAL if expected else Status.UNSOLVABLE)
        if len(expected) != k:
            assert result.is_all == (len(expected) < k)
        if result.is_all:
            assert len(expected) <= k
            assert result.lower_bound is None
        else:
            assert result.lower_bound == close_to(costs[-1])
    elif result.lower_bound is not None:
        cheap = result.lower_bound * (1 - SLACK) - SLACK
        assert [cost for cost in costs if cost < cheap] == close_to([cost for cost in expected[:k] if cost < cheap])
    must_have_ended(result.stopped)


@pytest.mark.parametrize("distinct", DISTINCT)
@pytest.mark.parametrize("orders", [("total",), ("none", "partial")])
@given(data=st.data(), utility=utilities(), k=st.integers(1, 12))
def test_the_best_plans(distinct: str, orders: tuple[str, ...], data: st.DataObject, utility: Utility, k: int) -> None:
    problem = data.draw(problems(orders))
    result = solve_top(problem, utility, k, distinct=distinct)
    check(problem, utility, k, distinct, result)


@pytest.mark.parametrize("distinct", DISTINCT)
@HALF
@given(problem=problems(), utility=utilities())
def test_all_plans(distinct: str, problem: Problem, utility: Utility) -> None:
    plans = all_plans(problem, most=1500, largest_network=LARGEST_NETWORK)
    keys = {key(plan, distinct) for plan in plans}
    outcome = find_top_plans(price(ground(problem), utility), len(keys) + 1, distinct=distinct)
    assert outcome.is_all
    assert len(outcome.plans) == len(keys)
    assert {key(plan, distinct) for plan in outcome.plans} == keys
    cheapest: dict[tuple[str, ...], float] = {}
    for plan in plans:
        cost = validate(problem, plan).risk_cost(utility)
        cheapest[key(plan, distinct)] = min(cost, cheapest.get(key(plan, distinct), cost))
    for plan in outcome.plans:
        assert validate(problem, plan).risk_cost(utility) == close_to(cheapest[key(plan, distinct)])


@pytest.mark.parametrize("distinct", DISTINCT)
@HALF
@given(
    problem=problems(),
    utility=utilities(),
    k=st.integers(1, 8),
    heuristic=st.sampled_from(ADMISSIBLE),
    grounding=grounding_switches(),
    switch=st.sampled_from([field.name for field in fields(TopSwitches)]),
)
def test_refinements_keep_the_best_plans(
    distinct: str,
    problem: Problem,
    utility: Utility,
    k: int,
    heuristic: str,
    grounding: GroundingSwitches,
    switch: str,
) -> None:
    outcome = find_top_plans(
        price(ground(problem, switches=grounding), utility),
        k,
        distinct=distinct,
        heuristic=heuristic,
        limits=LIMITS,
        switches=TopSwitches(**{switch: False}),
    )
    must_have_ended(outcome.stopped)
    costs = [validate(problem, plan).risk_cost(utility) for plan in outcome.plans]
    assert costs == close_to(best_risk_costs(problem, utility, k, distinct))
