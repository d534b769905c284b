"""Policies by utilities that are Python functions: where costs are bounded, and what is refused."""

from __future__ import annotations

import math

import pytest

import statehtn
from statehtn import PolicyResult, Problem, Status
from statehtn.errors import UnsupportedError, UsageError
from statehtn.limits import Limits
from statehtn.policies.run import find_policy
from statehtn.policies.settings import PolicySettings
from statehtn.session import Session

AV = ("domains/av/domain.hddl", "domains/av/p1.hddl")
TRIES = """
(define (domain tries)
 (:predicates (ok) (left ?i) (next ?i ?j))
 (:functions (total-cost) - number)
 (:task solve :parameters ())
 (:method stop :parameters () :task (solve) :precondition (ok) :ordered-subtasks ())
 (:method go :parameters (?i ?j) :task (solve) :precondition (and (left ?i) (next ?i ?j))
  :ordered-subtasks (and (try ?i ?j) (solve)))
 (:action try :parameters (?i ?j) :precondition (and (left ?i) (next ?i ?j) (not (ok)))
  :effect (and (increase (total-cost) {cost}) {change} (probabilistic 0.5 (ok) 0.5 ()))))
"""
PROBLEM = """
(define (problem p) (:domain tries) (:objects a b c d)
 (:htn :ordered-subtasks (and (solve))) (:init (left a) (next a b) (next b c) (next c d)))
"""


def tries(cost: float = 2, ends: bool = True) -> Problem:
    """Three tries at most; or any number of them."""
    change = "(not (left ?i)) (left ?j)" if ends else ""
    return statehtn.read_hddl_text(TRIES.format(cost=cost, change=change), PROBLEM)


def squared(cost: float) -> float:
    return -(cost**2)


def test_too_many_amounts_are_said_in_words() -> None:
    for failure_cost, shown in ((2.0**21, "1048580"), (1.5e9, "750000004")):
        with pytest.raises(UnsupportedError, match=f"there are {shown} of them, more than 1048576; round the costs"):
            policy(tries(), failure_cost=failure_cost)


def policy(problem: Problem, function: object = squared, **options: object) -> PolicyResult:
    return statehtn.policy(problem, objective=function, precision=1e-9, **options)


@pytest.mark.parametrize(
    ("function", "same"),
    [
        (lambda cost: -float(cost > 18), "deadline 18"),
        (lambda cost: -max(0.0, cost - 18), "overrun 18"),
        (lambda cost: -math.exp(0.3 * cost) / 0.3, "averse 0.3"),
    ],
)
def test_a_function_is_the_objective_that_it_is(function: object, same: str) -> None:
    problem = statehtn.read_hddl(*AV)
    one, other = policy(problem, function, adaptive=True), policy(problem, same, adaptive=True)
    assert one.status is Status.OPTIMAL
    value = math.exp(0.3 * other.value) / 0.3 if same == "averse 0.3" else other.value
    assert one.value == pytest.approx(value, rel=1e-6)
    assert one.looking.worth >= -1e-9


def test_a_bounded_number_of_tries() -> None:
    """After three tries the agent gives up: it has paid 6, and 20 for that."""
    result = policy(tries(), failure_cost=20.0)
    assert result.status is Status.OPTIMAL
    assert result.value == pytest.approx(0.5 * 4 + 0.25 * 16 + 0.125 * 36 + 0.125 * 26**2)
    assert policy(tries(), failure_cost=5.0).value == pytest.approx(25)  # at once
    assert policy(tries(), lambda cost: -float(cost > 4), failure_cost=1.0).value == pytest.approx(
        0.0
    )  # gives up first
    without = policy(tries())
    assert without.status is Status.UNSOLVABLE
    assert without.most_success == pytest.approx(0.875)


def test_what_is_refused() -> None:
    with pytest.raises(UnsupportedError, match="a loop that costs something"):
        policy(tries(ends=False))
    with pytest.raises(UnsupportedError, match="round the costs"):
        policy(tries(3.000001), failure_cost=5.0)
    with pytest.raises(UsageError, match="rises"):
        policy(tries(), lambda cost: -abs(cost - 3), failure_cost=5.0)
    with pytest.raises(UsageError, match="'never'"):
        policy(tries(), never, failure_cost=5.0)


def never(cost: float) -> float:
    raise ArithmeticError(cost)


def test_limits_hold_while_amounts_are_found_out() -> None:
    settings = PolicySettings.of(squared, failure_cost=5.0)
    result = find_policy(Session(tries()), settings, Limits(steps=5))
    assert (result.status, result.policy) == (Status.TIME_LIMIT, None)
