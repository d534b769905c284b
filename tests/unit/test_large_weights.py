"""Weighted search with weights so large that g + weight h is no number of the core: the order changes, and no more."""

from __future__ import annotations

import pytest

import statehtn
from statehtn import Problem, Status

# One token for as many errands as there are; to work without a token costs much more.
DOMAIN = """(define (domain d) (:predicates (token)) (:functions (total-cost))
  (:task errand :parameters ())
  (:method cheap :parameters () :task (errand) :ordered-subtasks (and (take) (work)))
  {dear}
  (:action take :parameters () :precondition (token) :effect (and (not (token)) (increase (total-cost) {low})))
  (:action work :parameters () :effect (increase (total-cost) {high}))
  (:action toil :parameters () :effect (increase (total-cost) {highest})))"""
DEAR = "(:method dear :parameters () :task (errand) :ordered-subtasks (and (toil)))"
WEIGHTS = [4.0, 1e6, 1e9, 1e300]
COSTS = [1, 10**6, 10**15]


def errands(dear: str, scale: int) -> Problem:
    domain = DOMAIN.format(dear=dear, low=1, high=scale, highest=4 * scale)
    network = "(:htn :ordered-subtasks (and (errand) (errand) (errand)))"
    return statehtn.read_hddl_text(domain, f"(define (problem p) (:domain d) {network} (:init (token)))")


@pytest.mark.parametrize("heuristic", ["auto", "hmax", "tdg"])
@pytest.mark.parametrize("scale", COSTS)
@pytest.mark.parametrize("weight", WEIGHTS)
def test_a_plan_is_found_and_the_promise_kept(weight: float, scale: int, heuristic: str) -> None:
    problem = errands(DEAR, scale)
    result = statehtn.plan(problem, search="weighted", weight=weight, heuristic=heuristic, time_limit=60)
    assert result.status in (Status.OPTIMAL, Status.SOLVED)
    assert result.stopped is None
    assert result.risk_cost is not None
    assert result.lower_bound is not None
    least = 9 * scale + 1
    assert least * (1 - 1e-9) <= result.risk_cost <= weight * result.lower_bound * (1 + 1e-9)
    assert result.lower_bound <= least * (1 + 1e-9)


@pytest.mark.parametrize("heuristic", ["auto", "hmax", "tdg"])
@pytest.mark.parametrize("scale", COSTS)
@pytest.mark.parametrize("weight", WEIGHTS)
def test_that_there_is_no_plan_is_proven(weight: float, scale: int, heuristic: str) -> None:
    problem = errands("", scale)
    result = statehtn.plan(problem, search="weighted", weight=weight, heuristic=heuristic, time_limit=60)
    assert result.status is Status.UNSOLVABLE
