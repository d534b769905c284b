"""Utilities that are Python functions: what they are asked about, where they may fail, and that they must not rise."""

from __future__ import annotations

import math
from collections.abc import Callable
from itertools import pairwise

import pytest
from hypothesis import given
from hypothesis import strategies as st

import statehtn
from statehtn import CostDistribution, Problem, Status, UsageError
from statehtn.risk import CallableUtility

AIRPORT = ("domains/airport/domain.hddl", "domains/airport/p1.hddl")
DEAREST = 142
"""No plan of the airport problem costs more."""

DOMAIN = """(define (domain d) (:functions (total-cost)) (:task go :parameters ())
  (:method one :parameters () :task (go) :ordered-subtasks (and (dare)))
  (:method two :parameters () :task (go) :ordered-subtasks (and (walk)))
  (:action dare :parameters () :effect (probabilistic 0.5 (increase (total-cost) 0) 0.5 (increase (total-cost) 100)))
  (:action walk :parameters () :effect (increase (total-cost) 10)))"""
PROBLEM = "(define (problem p) (:domain d) (:htn :ordered-subtasks (and (go))) (:init))"


@pytest.fixture(scope="module")
def airport() -> Problem:
    return statehtn.read_hddl(*AIRPORT)


@pytest.mark.parametrize("end", [DEAREST + 1, 150, 260, 300, 10_000])
def test_a_function_may_fail_beyond_the_dearest_plan(airport: Problem, end: int) -> None:
    result = statehtn.plan(airport, objective=lambda cost: math.log(end - cost))
    assert result.status is Status.OPTIMAL
    assert result.value is not None
    same = statehtn.plan(airport, objective=lambda cost: math.log(max(end - cost, 1e-9)))
    assert result.value == pytest.approx(same.value, abs=1e-5)
    assert statehtn.policy(airport, objective=lambda cost: math.log(end - cost)).value <= result.value + 1e-5


@pytest.mark.parametrize("start", [0, 10, 20])
def test_a_function_may_fail_below_the_cheapest_plan(airport: Problem, start: int) -> None:
    result = statehtn.plan(airport, objective=lambda cost: -math.log(cost - start))
    assert result.status is Status.OPTIMAL
    same = statehtn.plan(airport, objective=lambda cost: -math.log(max(cost - start, 1e-9)))
    assert result.value == pytest.approx(same.value, abs=1e-5)


@pytest.mark.parametrize(("end", "cost"), [(60, 67), (100, 122), (DEAREST, DEAREST)])
def test_that_it_fails_for_a_plan_is_an_error(airport: Problem, end: int, cost: int) -> None:
    with pytest.raises(UsageError, match=f"fails for a cost of {cost} with ValueError"):
        statehtn.plan(airport, objective=lambda cost: math.log(end - cost))


def test_a_plan_so_good_that_the_function_fails_is_found_and_an_error() -> None:
    """The cheapest plan on average is another one, and a utility of minus log 1 for free days would not be enough."""
    problem = statehtn.read_hddl_text(DOMAIN, PROBLEM)
    with pytest.raises(UsageError, match="fails for a cost of 0 with ValueError"):
        statehtn.plan(problem, objective=lambda cost: -math.log(cost))
    assert statehtn.plan(problem, objective=lambda cost: -math.log(cost + 1)).status is Status.OPTIMAL


@pytest.mark.parametrize("at", [46, 70, DEAREST])
def test_a_rise_at_the_cost_of_a_plan_is_found(airport: Problem, at: int) -> None:
    with pytest.raises(UsageError, match=rf"rises: 0 for a cost of [\d.]+, 100 for {at};"):
        statehtn.plan(airport, objective=lambda cost: 100.0 * (cost == at))


def test_a_rise_from_one_law_to_another_is_found() -> None:
    utility = CallableUtility(lambda cost: 100.0 * (cost == 70.5))
    assert utility.value(CostDistribution.certain(70)) == 0
    with pytest.raises(UsageError, match=r"rises: 0 for a cost of 70, 100 for 70\.5"):
        utility.value(CostDistribution.certain(70.5))


@given(st.lists(st.tuples(st.integers(0, 9), st.integers(-3, 3)), min_size=1, max_size=8))
def test_any_rise_between_what_was_asked_is_found(answers: list[tuple[int, int]]) -> None:
    table = dict(answers)
    utility = CallableUtility(lambda cost: table[int(cost)])
    rises = any(later > earlier for (_, earlier), (_, later) in pairwise(sorted(table.items())))

    def ask() -> None:
        for cost in table:
            utility.utilities([float(cost)])

    if rises:
        with pytest.raises(UsageError, match="rises"):
            ask()
    else:
        ask()
        assert utility == CallableUtility(utility.function)


@given(
    st.lists(st.one_of(st.none(), st.integers(-5, 5)), min_size=1, max_size=8).filter(
        lambda answers: any(answer is not None for answer in answers)
    )
)
def test_bounds_are_bounds(answers: list[int | None]) -> None:
    """A utility that fails somewhere is bounded there by what it can be at most if it does not rise."""
    known = iter(sorted((answer for answer in answers if answer is not None), reverse=True))
    table = [None if answer is None else next(known) for answer in answers]

    def function(cost: float) -> float:
        answer = table[int(cost)]
        if answer is None:
            raise KeyError(cost)
        return answer

    bounds = CallableUtility(function).bounds(map(float, range(len(table))))
    assert all(later <= earlier for earlier, later in pairwise(bounds))
    first = next(at for at, answer in enumerate(table) if answer is not None)
    assert all(bound > (table[first] or 0) + 100 for bound in bounds[:first])
    last = table[first]
    for bound, answer in zip(bounds[first:], table[first:], strict=True):
        last = last if answer is None else answer
        assert bound == last


def test_a_function_that_always_fails_is_an_error() -> None:
    def never(cost: float) -> float:
        raise KeyError(cost)

    with pytest.raises(UsageError, match="the utility 'never' fails for a cost of 0 with KeyError"):
        CallableUtility(never).bounds([0.0, 1.0])


def test_a_certain_cost_is_not_asked_where_the_function_fails() -> None:
    table: Callable[[float], float] = {0.0: 0.0, 10.0: -10.0}.__getitem__
    law = CostDistribution.of([(0.5, 0.0), (0.5, 10.0)])
    assert CallableUtility(table).value(law) == 5
    assert CallableUtility(table).certainty_equivalent(law) is None


def test_several_lambdas_are_told_apart(airport: Problem) -> None:
    functions = [lambda cost: -cost, lambda cost: -float(cost > 75)]
    compared = statehtn.compare_attitudes(airport, objectives=[*functions, "neutral"])
    assert compared.agents == ("utility <lambda> (1)", "utility <lambda> (2)", "neutral")
    assert "utility <lambda> (1) instead of utility <lambda> (2)" in str(compared)
