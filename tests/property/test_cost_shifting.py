"""Shifting costs from parts to their action: never more in any state, and nothing lost where one part is always due."""

from __future__ import annotations

import itertools

import pytest
from hypothesis import given
from hypothesis import strategies as st

from statehtn.core.grounding import ground
from statehtn.core.heuristics import HeuristicEvaluator
from statehtn.model import CostDistribution, GroundCostPart, Problem
from statehtn.risk import Utility, utility_for
from statehtn.risk.cost_shifting import shifted_prices
from tests.strategies import problems, utilities

FACTS = 4
NEUTRAL = utility_for("neutral")


def alternatives() -> st.SearchStrategy[tuple[frozenset[int], frozenset[int]]]:
    values = st.dictionaries(st.integers(0, FACTS - 1), st.booleans(), min_size=1, max_size=3)
    return values.map(
        lambda chosen: (
            frozenset(fact for fact, value in chosen.items() if value),
            frozenset(fact for fact, value in chosen.items() if not value),
        )
    )


def cost_parts() -> st.SearchStrategy[GroundCostPart]:
    conditions = st.lists(alternatives(), min_size=1, max_size=3).map(tuple)
    laws = st.integers(0, 9).map(lambda cost: CostDistribution.certain(float(cost)))
    return st.builds(GroundCostPart, conditions, laws)


def states(facts: int = FACTS) -> list[frozenset[int]]:
    chosen = itertools.product((False, True), repeat=facts)
    return [frozenset(itertools.compress(range(facts), values)) for values in chosen]


@given(st.integers(0, 5), st.lists(cost_parts(), max_size=5))
def test_no_state_costs_more(own: int, parts: list[GroundCostPart]) -> None:
    shifted, left = shifted_prices(CostDistribution.certain(float(own)), parts, NEUTRAL)
    assert min(left, default=0) >= 0
    for state in states():
        due = [number for number, part in enumerate(parts) if part.is_due(state)]
        before = own + sum(parts[number].cost.mean for number in due)
        after = shifted + sum(left[number] for number in due)
        assert shifted <= after <= before
    assert shifted >= own


@given(st.integers(0, 5), st.lists(cost_parts(), max_size=2))
def test_two_parts_give_what_is_due_in_any_case(own: int, parts: list[GroundCostPart]) -> None:
    shifted, _ = shifted_prices(CostDistribution.certain(float(own)), parts, NEUTRAL)
    assert shifted == min(own + sum(part.cost.mean for part in parts if part.is_due(state)) for state in states())


@given(st.lists(st.integers(0, 9), min_size=8, max_size=8))
def test_nothing_is_lost_where_exactly_one_part_is_due(costs: list[int]) -> None:
    parts = [
        GroundCostPart(((state, frozenset(range(3)) - state),), CostDistribution.certain(float(cost)))
        for state, cost in zip(states(3), costs, strict=True)
    ]
    shifted, left = shifted_prices(CostDistribution.certain(0.0), parts, NEUTRAL)
    assert shifted == min(costs)
    assert [shifted + price for price in left] == costs


@given(problems(), utilities())
def test_the_core_shifts_as_this_does(problem: Problem, utility: Utility) -> None:
    grounding = ground(problem)
    model = grounding.to_model()
    bound = HeuristicEvaluator(grounding, utility, "tdg")
    for number, action in enumerate(model.actions):
        expected, _ = shifted_prices(action.cost, action.cost_parts, utility)
        assert bound((), [number]) == pytest.approx(expected, rel=1e-9, abs=1e-9)
