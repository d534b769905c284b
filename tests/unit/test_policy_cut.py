"""Policies of one-switch agents and for sums of exponentials: closed forms, extreme parameters, infinite values."""

from __future__ import annotations

import math

import pytest

import statehtn
from statehtn import PolicyResult, Status
from statehtn.limits import Limits
from statehtn.policies.run import find_policy
from statehtn.policies.settings import PolicySettings
from statehtn.session import Session

DOMAIN = """
(define (domain retry)
 (:predicates (ok))
 (:functions (total-cost) - number)
 (:task solve :parameters ())
 (:method stop :parameters () :task (solve) :precondition (ok) :ordered-subtasks ())
 (:method go :parameters () :task (solve) :ordered-subtasks (and (try) (solve)))
 {leave}
 (:action try :parameters () :precondition (not (ok))
  :effect (and (increase (total-cost) 1) (probabilistic 0.5 (ok) 0.5 ())))
 (:action buy :parameters () :precondition () :effect (increase (total-cost) {price})))
"""
LEAVE = "(:method leave :parameters () :task (solve) :precondition (not (ok)) :ordered-subtasks (and (buy)))"
PROBLEM = "(define (problem p) (:domain retry) (:htn :ordered-subtasks (and (solve))) (:init))"


def policy(objective: str, price: float | None = None, **options: float) -> PolicyResult:
    """The best policy where each try costs 1 and is enough every other time, or all is bought at a price."""
    text = DOMAIN.format(leave=LEAVE if price else "", price=price or 1)
    problem = statehtn.read_hddl_text(text, PROBLEM)
    return statehtn.policy(problem, objective=objective, precision=1e-10, **options)


@pytest.mark.parametrize("alpha", [1e-9, 1e-3, 0.1, 0.5, 0.69])
@pytest.mark.parametrize("wealth", [-2e3, 0, 5, 1e4])
def test_one_try_after_the_other(alpha: float, wealth: float) -> None:
    """Tries are geometric: 2 in the mean, and `E e^(A C) = r / (1 - r)` with `r = e^A / 2`."""
    result = policy(f"one-switch alpha={alpha} tradeoff=2 wealth={wealth}")
    assert result.status is Status.OPTIMAL
    r = math.exp(alpha) / 2
    log_mean = math.log(r) - math.log1p(-r)
    log_weight = math.log(2 / alpha) - alpha * wealth

    def excess(cost: float) -> float:
        """The expected disutility less that of a certain cost, divided by the larger of the weights."""
        larger = max(0.0, log_weight)
        exponential = math.exp(log_weight + alpha * cost - larger) * math.expm1(log_mean - alpha * cost)
        return math.exp(-larger) * (2 - cost) + exponential

    assert excess(result.value * (1 - 1e-7)) > 0 > excess(result.value * (1 + 1e-7))


@pytest.mark.parametrize(
    "objective", ["one-switch alpha=0.7 tradeoff=1e-9 wealth=500", "exponentials linear=1 0.7:1e-30 -1:1e-9"]
)
def test_an_infinite_exponential_is_infinite_whatever_it_weighs(objective: str) -> None:
    result = policy(objective)
    assert result.status is Status.UNSOLVABLE
    assert "none has a finite value by" in result.reason
    given_up = policy(objective, failure_cost=3.0)
    assert given_up.status is Status.OPTIMAL
    assert given_up.value == pytest.approx(2, abs=1e-3)  # it tries for very long before it does
    assert policy(objective, 3.0).value == pytest.approx(given_up.value, rel=1e-9)


@pytest.mark.parametrize("objective", ["one-switch alpha={} tradeoff=1 wealth=0", "averse {}"])
def test_loops_that_are_too_close_to_call(objective: str) -> None:
    """At ln 2 the mean of the exponential becomes infinite."""
    assert policy(objective.format(0.693147)).status is Status.OPTIMAL
    for alpha in (0.6931471805, 0.6931471805599, 0.6931471806):
        result = policy(objective.format(alpha))
        assert (result.status, result.policy) == (Status.GAVE_UP, None)
        assert "too close to call" in result.reason
    assert policy(objective.format(0.69315)).status is Status.UNSOLVABLE


def test_the_switch() -> None:
    """A rich agent tries, a poor one buys; one in between tries until it has become poor."""
    poor, between, rich = (policy(f"one-switch alpha=0.5 tradeoff=1 wealth={wealth}", 2.5) for wealth in (0, 4, 40))
    assert poor.value == pytest.approx(2.5, rel=1e-9)
    assert rich.value == pytest.approx(2, abs=1e-3)
    drawn = [between.policy.trajectory(seed) for seed in range(30)]
    assert {taken.step.action for run in drawn for taken in run.steps} == {"try", "buy"}
    for run in drawn:
        asks_on_the_way(between, run.branches)


def asks_on_the_way(result: PolicyResult, branches: tuple[int, ...]) -> None:
    """Asked with what was spent, the policy decides as it does."""
    graph, node, spent = result.policy.graph, 0, 0.0
    for branch in branches:
        here = graph.nodes[node]
        assert result.policy.decide(here.facts, result.policy.network_of(here), spent) == here.decision
        node, spent = graph.flat.successors[branch], spent + graph.flat.laws[branch].mean


@pytest.mark.parametrize("alpha", [5, 100, 3000])
def test_large_alphas(alpha: float) -> None:
    """Beyond the range of floating point the agent goes by the largest cost."""
    result = policy(f"exponentials linear=1 {alpha}:1", 7)
    assert result.status is Status.OPTIMAL
    assert result.value == pytest.approx(7, rel=1e-9)
    assert policy(f"exponentials linear=1 {alpha}:1 -{alpha}:1", 500).status is Status.OPTIMAL


def test_nothing_is_remembered_where_one_policy_is_best_for_all_terms() -> None:
    result = policy("one-switch alpha=0.1 tradeoff=1 wealth=5")
    assert {node.left for node in result.policy.graph.nodes} == {None}


@pytest.mark.parametrize("slope", [1e-13, -1e-13, 1e-7])
def test_slopes_of_nearly_nothing(slope: float) -> None:
    """ln E[e^(a C)] / a is the mean and half of a times the variance, which is 2 here as the mean is."""
    law = policy("neutral").policy.cost_distribution()
    assert law.exponential_mean(slope) == pytest.approx(2 + slope, rel=1e-14)


@pytest.mark.parametrize(
    ("objective", "same"), [("exponentials linear=0 0.3:2", "averse 0.3"), ("exponentials linear=3", "neutral")]
)
def test_one_term_alone(objective: str, same: str) -> None:
    assert policy(objective, 5).value == pytest.approx(policy(same, 5).value, rel=1e-9)


@pytest.mark.parametrize(
    ("objective", "status"),
    [
        ("exponentials linear=0 -1:1 -2:1", Status.OPTIMAL),
        ("exponentials linear=0 -10:1", Status.OPTIMAL),
        ("exponentials linear=0 -1e-9:1 -1e-7:3", Status.OPTIMAL),
        ("exponentials linear=1e-300 -1:1", Status.SOLVED),  # more than 37 are as bad as 37, to 16 digits
    ],
)
def test_who_seeks_risk_minds_large_costs_too(objective: str, status: Status) -> None:
    """All that can be done costs 60: nothing of that is lost in the differences of exponentials."""
    text = DOMAIN.format(leave=LEAVE, price=60).replace("(increase (total-cost) 1)", "(increase (total-cost) 100)")
    result = statehtn.policy(statehtn.read_hddl_text(text, PROBLEM), objective=objective)
    assert result.status is status
    assert result.value == pytest.approx(60, rel=1e-9)
    assert result.lower_bound <= 60


@pytest.mark.parametrize("steps", [1, 500, 2000, 5000])
def test_limits_leave_bounds(steps: int) -> None:
    problem = statehtn.read_hddl("domains/gripper-robot/domain.hddl", "domains/gripper-robot/p2.hddl")
    settings = PolicySettings.of("exponentials linear=1 0.1:1 -0.1:3")
    result = find_policy(Session(problem), settings, Limits(steps=steps))
    assert result.stopped is Status.TIME_LIMIT
    assert result.status is (Status.TIME_LIMIT if result.policy is None else Status.SOLVED)
    assert (result.lower_bound or 0) <= 12.0042633472 <= (result.value or math.inf) + 1e-9
