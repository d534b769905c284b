"""The planner's optimum is the optimum: compared with exhaustive search on random small problems."""

from __future__ import annotations

from dataclasses import fields

import pytest
from hypothesis import given
from hypothesis import strategies as st

import statehtn._relax as _relax
from statehtn import Result, Status, validate
from statehtn.core.grounding import GroundingSwitches, ground
from statehtn.core.heuristics import PORTFOLIO
from statehtn.core.search import find_plans
from statehtn.core.searches import SEARCHES
from statehtn.core.switches import SearchSwitches
from statehtn.model import Problem
from statehtn.risk import Utility, utility_for
from tests.brute_force import GaveUp, optimal_risk_cost
from tests.differential.oracles import ADMISSIBLE, LIMITS, close_to, must_cost, must_have_ended, solve
from tests.shares import share_of_examples
from tests.strategies import grounding_switches, problems, utilities

HALF = share_of_examples(2)  # for each heuristic, search or refinement


def check(problem: Problem, utility: Utility, result: Result) -> None:
    """The status, the plan and the bound agree with the optimum by exhaustion."""
    optimum = optimal_risk_cost(problem, utility)
    if optimum is None:
        assert result.status in (Status.UNSOLVABLE, Status.TIME_LIMIT)
        assert result.plan is None
        must_have_ended(result.stopped)
        return
    assert result.status in (Status.OPTIMAL, Status.SOLVED, Status.TIME_LIMIT)
    assert (result.plan is None) == (result.status is Status.TIME_LIMIT)
    assert result.lower_bound is not None
    assert result.lower_bound <= optimum * (1 + 1e-9) + 1e-9
    if result.plan is not None:
        must_cost(problem, result.plan, utility, result.risk_cost)
        assert optimum <= result.risk_cost * (1 + 1e-9) + 1e-9
    if result.status is Status.OPTIMAL:
        assert result.risk_cost == close_to(optimum)
        assert result.lower_bound == close_to(optimum)
    must_have_ended(result.stopped)


@pytest.mark.parametrize("heuristic", ADMISSIBLE)
@HALF
@given(problem=problems(), utility=utilities())
def test_optimum(heuristic: str, problem: Problem, utility: Utility) -> None:
    check(problem, utility, solve(problem, utility, heuristic=heuristic))


@given(problem=problems(orders=("total",)), utility=utilities())
def test_optimum_of_totally_ordered_problems(problem: Problem, utility: Utility) -> None:
    check(problem, utility, solve(problem, utility))


@given(problem=problems(orders=("none", "partial")), utility=utilities())
def test_optimum_of_partially_ordered_problems(problem: Problem, utility: Utility) -> None:
    check(problem, utility, solve(problem, utility))


@given(problem=problems(), utility=utilities())
def test_anytime_search_ends_with_the_optimum(problem: Problem, utility: Utility) -> None:
    check(problem, utility, solve(problem, utility, search="anytime"))


@pytest.mark.parametrize("search", SEARCHES)
@HALF
@given(problem=problems(), utility=utilities())
def test_every_search_keeps_what_its_status_says(search: str, problem: Problem, utility: Utility) -> None:
    check(problem, utility, solve(problem, utility, search=search))


@pytest.mark.parametrize("switch", [field.name for field in fields(SearchSwitches)])
@HALF
@given(
    problem=problems(),
    utility=utilities(),
    heuristic=st.sampled_from([PORTFOLIO, *(name for name in ADMISSIBLE if name != "blind")]),
)
def test_optimum_without_a_refinement(switch: str, problem: Problem, utility: Utility, heuristic: str) -> None:
    optimum = optimal_risk_cost(problem, utility)
    switches = SearchSwitches(**{switch: False})
    outcome = find_plans(ground(problem), utility, heuristic=heuristic, limits=LIMITS, switches=switches)
    must_have_ended(outcome.stopped)  # without the bound, some spaces are infinite
    if optimum is None:
        assert outcome.plan is None
    else:
        assert outcome.plan is not None
        assert validate(problem, outcome.plan).risk_cost(utility) == close_to(optimum)


@pytest.mark.parametrize("search", ["astar", "greedy"])
@given(problem=problems(), utility=utilities(), switches=grounding_switches())
def test_refinements_of_grounding_keep_the_plans(
    search: str, problem: Problem, utility: Utility, switches: GroundingSwitches
) -> None:
    optimum = optimal_risk_cost(problem, utility)
    grounding = ground(problem, switches=switches)
    outcome = find_plans(grounding, utility, search=search, limits=LIMITS)
    must_have_ended(outcome.stopped)
    assert (outcome.plan is None) == (optimum is None)
    if outcome.plan is not None:
        validation = validate(problem, outcome.plan)
        assert validation.valid, validation.reasons
        if search == "astar":
            assert validation.risk_cost(utility) == close_to(optimum)


@given(problem=problems(), utility=utilities())
def test_weighted_search_keeps_its_promise(problem: Problem, utility: Utility) -> None:
    result = solve(problem, utility, search="weighted", weight=3.0)
    must_have_ended(result.stopped)
    optimum = optimal_risk_cost(problem, utility)
    assert (result.plan is None) == (optimum is None)
    if optimum is not None:
        assert result.plan is not None
        assert validate(problem, result.plan).valid
        assert result.lower_bound <= optimum * (1 + 1e-9) + 1e-9
        assert optimum - 1e-9 <= result.risk_cost * (1 + 1e-9)
        assert result.risk_cost <= 3 * optimum * (1 + 1e-9) + 1e-9


@given(problem=problems(), utility=utilities())
def test_greedy_search_finds_a_plan_where_there_is_one(problem: Problem, utility: Utility) -> None:
    result = solve(problem, utility, search="greedy")
    must_have_ended(result.stopped)
    optimum = optimal_risk_cost(problem, utility)
    assert (result.plan is None) == (optimum is None)
    if optimum is not None:
        assert result.plan is not None
        assert validate(problem, result.plan).valid
        assert result.risk_cost >= optimum * (1 - 1e-9) - 1e-9


@given(problem=problems(orders=("none", "partial")), explores=st.booleans())
def test_methods_that_wait_until_they_are_due_keep_a_plan(problem: Problem, explores: bool) -> None:
    handle = ground(problem).handle
    options = _relax.GreedyOptions()
    options.heuristic = "ff"
    options.explores = explores
    options.when_due = True
    priced = _relax.PricedProblem(handle, [1] * len(handle.action_schema), [1] * handle.cost_part_count)
    result = _relax.find_plans(priced, options, steps=LIMITS.steps)
    if result.stop is not None:
        raise GaveUp
    assert (result.cost is None) == (optimal_risk_cost(problem, utility_for("neutral")) is None)
