"""Objectives whose labels are several sums against an exhaustive search, every rule and bound left out in turn."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from statehtn import Problem, Status, objective, validate
from statehtn.core.finite_labels import SWITCHES
from statehtn.core.grounding import ground
from statehtn.core.label_run import PRECISION
from statehtn.core.label_search import search_labels
from statehtn.core.search import last_of
from statehtn.core.switches import LabelSwitches
from statehtn.model.cost.scenario_cost import total_of
from tests.all_laws import best_plans
from tests.differential.oracles import ADMISSIBLE, LIMITS, must_have_ended
from tests.exact_objectives import exact_objective
from tests.lotteries import FINITE, lottery_problems
from tests.shares import share_of_examples
from tests.strategies import problems

SHARE = share_of_examples(5)

ALL = st.one_of(*FINITE.values())
NO_SHORT_CUT = {"one_price_first": False}


def check(problem: Problem, text: str, **options: object) -> None:
    """The plan is valid, and the best of all; nothing is proven that is not so."""
    wanted, judge = objective(text), exact_objective(text)
    outcome = last_of(search_labels(ground(problem), wanted, limits=LIMITS, **options))  # type: ignore[arg-type]
    expected = best_plans(problem, judge)
    if not expected:
        must_have_ended(outcome.stopped)
        assert outcome.status is Status.UNSOLVABLE
        return
    best = float(expected[0].value)
    slack = PRECISION * max(1.0, abs(best))
    assert outcome.status is not Status.UNSOLVABLE
    if outcome.lower_bound is not None:
        assert outcome.lower_bound <= best * (1 + 1e-12)
    must_have_ended(outcome.stopped)
    assert outcome.status is Status.OPTIMAL
    assert outcome.plan is not None
    validation = validate(problem, outcome.plan)
    assert validation.valid, validation.reasons
    value = wanted.value(total_of(validation.costs))
    assert best * (1 - 1e-9) <= value <= best + slack
    assert outcome.lower_bound is not None
    assert value - outcome.lower_bound <= slack


@pytest.mark.parametrize("family", FINITE)
@SHARE
@given(data=st.data())
def test_the_best_plan(family: str, data: st.DataObject) -> None:
    check(data.draw(lottery_problems()), data.draw(FINITE[family]))


@pytest.mark.parametrize("family", FINITE)
@SHARE
@given(data=st.data())
def test_the_best_plan_of_any_problem(family: str, data: st.DataObject) -> None:
    check(data.draw(problems()), data.draw(FINITE[family]))


@pytest.mark.parametrize("left_out", [None, *SWITCHES, "inherit_h", "tdg_bound", "limits_labels", "forget_facts"])
@SHARE
@given(problem=lottery_problems(), text=ALL, heuristic=st.sampled_from(ADMISSIBLE))
def test_label_search_alone(left_out: str | None, problem: Problem, text: str, heuristic: str) -> None:
    switches = LabelSwitches(**NO_SHORT_CUT, **({} if left_out is None else {left_out: False}))
    check(problem, text, switches=switches, heuristic=heuristic)


@SHARE
@given(problem=lottery_problems(), text=ALL, left_out=st.sampled_from(SWITCHES))
def test_label_search_with_incumbents(problem: Problem, text: str, left_out: str) -> None:
    check(problem, text, switches=LabelSwitches(**{left_out: False}))


@pytest.mark.parametrize("distinct", ["multiset", "sequence"])
@SHARE
@given(problem=lottery_problems(), text=ALL, k=st.integers(2, 6))
def test_several_plans(distinct: str, problem: Problem, text: str, k: int) -> None:
    outcome = last_of(search_labels(ground(problem), objective(text), k=k, distinct=distinct, limits=LIMITS))
    expected = [float(best.value) for best in best_plans(problem, exact_objective(text), k, distinct)]
    must_have_ended(outcome.stopped)
    values = [objective(text).value(total_of(validate(problem, plan).costs)) for plan in outcome.plans]
    assert values == pytest.approx(expected, rel=2 * PRECISION, abs=2 * PRECISION)


@SHARE
@given(problem=lottery_problems(), alpha=st.sampled_from(["0.1", "0.5", "2"]))
def test_an_agent_of_one_switch_is_neutral_when_it_is_rich_and_exponential_when_it_is_poor(
    problem: Problem, alpha: str
) -> None:
    """As D e^(-A W) tends to 0 and to infinity."""
    for wealth, limit in (("1000", "neutral"), ("-1000", f"averse {alpha}")):
        text = f"one-switch alpha={alpha} tradeoff=1 wealth={wealth}"
        outcome = last_of(search_labels(ground(problem), objective(text), limits=LIMITS))
        must_have_ended(outcome.stopped)
        expected = best_plans(problem, exact_objective(limit))
        assert (outcome.plan is None) == (not expected)
        if outcome.plan is not None:
            value = objective(limit).value(total_of(validate(problem, outcome.plan).costs))
            assert value == pytest.approx(float(expected[0].value), rel=1e-5)
