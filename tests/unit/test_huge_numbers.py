"""Weights and costs near the ends of floating point: an answer that is right, or one line that says what to do."""

from __future__ import annotations

import json
import math
from collections.abc import Callable

import pytest

import statehtn
from statehtn import CostDistribution, InputError, Problem, StateHtnError, Status, UsageError
from statehtn.model.cost.mixture import Mixture
from statehtn.model.cost.sum import CostSum

DOMAIN = """(define (domain d) (:functions (total-cost)) (:task go :parameters ())
  (:method risky :parameters () :task (go) :ordered-subtasks (and (dare)))
  (:method safe :parameters () :task (go) :ordered-subtasks (and (walk) (walk)))
  (:action dare :parameters ()
    :effect (probabilistic 0.5 (increase (total-cost) 1e{power}) 0.5 (increase (total-cost) 3e{power})))
  (:action walk :parameters () :effect (increase (total-cost) 1.25e{power})))"""
PROBLEM = "(define (problem p) (:domain d) (:htn :ordered-subtasks (and (go))) (:init))"

OBJECTIVES = [
    "neutral",
    "averse 0.1",
    "averse 1e308",
    "seeking 1e308",
    "mean-variance 1",
    "mean-variance 1e100",
    "mean-deviation 1",
    "mean-deviation 1e100",
    "mean-deviation 1e-320",
    "one-switch alpha=0.1 tradeoff=2 wealth=10",
    "exponentials linear=1 0.1:2 -0.1:1",
    "evar 0.9",
    "deadline 2",
    "overrun 2",
    "piecewise 0:0 1:-1 2:-3",
    "piecewise 0:0 1:-1e300",
    "quantile 0.9",
    "cvar 0.9",
    "success-utility alpha=0.1",
    "success-utility alpha=1e308",
]


def choice(power: int) -> Problem:
    return statehtn.read_hddl_text(DOMAIN.format(power=power), PROBLEM)


@pytest.mark.parametrize("keep", [[], ["3 0.4"], ["9e289 0.4"]])
@pytest.mark.parametrize("power", [-200, 0, 160, 289])
@pytest.mark.parametrize("objective", OBJECTIVES)
def test_every_objective_answers_or_says_what_to_do(objective: str, power: int, keep: list[str]) -> None:
    try:
        result = statehtn.plan(choice(power), objective=objective, keep=keep, time_limit=60)
    except StateHtnError as error:
        message = error.message
    else:
        message = ""
    if message:
        assert "in a larger unit" in message
        return
    assert result.status in (Status.OPTIMAL, Status.UNSOLVABLE)
    assert (result.status is Status.UNSOLVABLE) == (power > 0 and keep == ["3 0.4"])
    if result.value is not None:
        assert math.isfinite(result.value)
    json.dumps(result.to_dict(), allow_nan=False)


@pytest.mark.parametrize("name", ["mean-deviation", "mean-variance"])
@pytest.mark.parametrize("weight", ["1e101", "1e155", "1e307", "1e308"])
def test_a_weight_beside_which_means_are_nothing_is_refused(name: str, weight: str) -> None:
    with pytest.raises(UsageError, match=r"weight of the (deviation|variance) must be at most 1e\+100, found"):
        statehtn.objective(f"{name} {weight}")


@pytest.mark.parametrize("name", ["mean-deviation", "mean-variance"])
def test_the_largest_weight_chooses_the_certain_plan(name: str) -> None:
    result = statehtn.plan(choice(0), objective=f"{name} 1e100")
    assert result.status is Status.OPTIMAL
    assert result.value == 2.5


@pytest.mark.parametrize("name", ["mean-deviation", "mean-variance"])
def test_a_variance_that_is_too_large_is_said_with_its_action(name: str) -> None:
    with pytest.raises(InputError, match=r"the cost of \(dare\): .* its variance is too large .* in a larger unit"):
        statehtn.plan(choice(160), objective=f"{name} 1")
    with pytest.raises(InputError, match=r"the cost of \(dare\): .* its variance is too large .* in a larger unit"):
        statehtn.frontier(choice(160), "deviation")


def test_a_price_that_is_too_large_is_said_with_its_action() -> None:
    with pytest.raises(InputError, match=r"the cost of \(dare\): .* its price for 'mean-variance 1e\+100' is 1e\+300"):
        statehtn.plan(choice(100), objective="mean-variance 1e100")


def test_deviations_are_right_where_variances_are_no_floats() -> None:
    for size in (1e-200, 1.0, 1e160, 1e290):
        law = CostDistribution.of([(0.5, size), (0.5, 3 * size)])
        assert law.standard_deviation == pytest.approx(size, rel=1e-14)
        assert CostSum((law, law)).standard_deviation == pytest.approx(size * math.sqrt(2), rel=1e-14)
        mixture = Mixture((0.5, 0.5), (law, CostDistribution.certain(2 * size)))
        assert mixture.standard_deviation == pytest.approx(size / math.sqrt(2), rel=1e-14)
    assert CostDistribution.of([(0.5, 0.0), (0.5, 1e200)]).variance == math.inf
    law = CostDistribution.of([(0.5, 0.0), (0.5, 2e154)])
    assert law.variance == pytest.approx(1e308)
    assert CostSum((law, law)).variance == math.inf


def test_a_logarithm_that_is_no_float_is_left_out() -> None:
    result = statehtn.plan(choice(0), objective="averse 1e308")
    assert result.log10_expected_utility is None
    assert result.risk_cost == 2.5


def test_utilities_that_are_no_floats_are_refused() -> None:
    for steep in ("piecewise 0:1e308 1e-300:-1e308", "piecewise 0:1e308 200:-1e308"):
        with pytest.raises(UsageError, match="falls too steeply for floating-point numbers, from 1e"):
            statehtn.objective(steep)
    with pytest.raises(UsageError, match=r"the utility of a cost of \de\+160 is too large .* in a larger unit"):
        statehtn.plan(choice(160), objective="piecewise 0:0 1:-1e300")


@pytest.mark.parametrize("power", [-200, -9, 160])
@pytest.mark.parametrize("objective", ["piecewise 0:0 1:-1e300", "piecewise 0:0 1:-1 2:-3", "deadline 2", "overrun 2"])
def test_policies_answer_or_say_what_is_too_much(objective: str, power: int) -> None:
    """The steps from 0 to the last point of a utility are as many as costs are small beside it."""
    try:
        result = statehtn.policy(choice(power), objective=objective, time_limit=60)
    except StateHtnError as error:
        message = error.message
    else:
        message = ""
        assert result.status is Status.OPTIMAL
    assert not message or "too many" in message or "in a larger unit" in message


@pytest.mark.parametrize("objective", ["averse 1e308", "seeking 1e308"])
def test_policies_of_an_alpha_that_is_too_large_are_refused(objective: str) -> None:
    """Not as unsolvable: one of the policies has the worst case, or the best, that is least."""
    with pytest.raises(UsageError, match=r"adds up alpha times each cost, which is .*; take a smaller alpha"):
        statehtn.policy(choice(0), objective=objective)
    result = statehtn.policy(choice(0), objective=objective.replace("308", "280"))
    assert result.status is Status.OPTIMAL
    assert result.value == (2.5 if "averse" in objective else 1)


@pytest.mark.parametrize(
    "objective",
    [
        "one-switch alpha=1e308 tradeoff=1 wealth=0",
        "exponentials linear=1 1e308:1",
        "exponentials linear=0 1e308:1 1:1",
    ],
)
@pytest.mark.parametrize("search", [statehtn.plan, statehtn.policy])
def test_other_exponents_that_are_too_large_are_refused(objective: str, search: Callable[..., object]) -> None:
    with pytest.raises(UsageError, match=r"adds up alpha times each cost, which is .*; take a smaller alpha"):
        search(choice(0), objective=objective)


IMPOSSIBLE = """(define (domain d) (:predicates (p) (q)) (:functions (total-cost)) (:task go :parameters ())
  (:method one :parameters () :task (go) :ordered-subtasks (and (a) (c)))
  (:method two :parameters () :task (go) :ordered-subtasks (and (b)))
  (:action a :parameters () :effect (probabilistic 1 (q) 0 (p)))
  (:action c :parameters () :precondition (p) :effect (q))
  (:action b :parameters () :effect (and (probabilistic 0.9 (q) 0.1 (p)) (increase (total-cost) 5))))"""


@pytest.mark.parametrize("alpha", ["1", "1e8", "1e10", "1e100"])
def test_no_plan_counts_on_what_cannot_come_however_dear_the_others_are(alpha: str) -> None:
    problem = statehtn.read_hddl_text(IMPOSSIBLE, PROBLEM)
    result = statehtn.plan(problem, objective=f"success-utility alpha={alpha}")
    assert result.status is Status.OPTIMAL
    assert [str(priced.step) for priced in result.steps] == ["(b)"]
