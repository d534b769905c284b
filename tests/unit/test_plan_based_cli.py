"""The plan-based solver on problems made to ask one question each."""

from __future__ import annotations

import pytest

import statehtn
from statehtn import Status
from statehtn.core.plan_based import BRANCHES

UNORDERED = """
(define (domain d) (:predicates (here) (there) (wet)) (:functions (total-cost))
  (:task both :parameters ())
  (:method m :parameters () :task (both) :subtasks (and (a (walk)) (b (look))))
  (:action walk :parameters () :precondition (here) :effect (and (there) (not (here)) {wet}))
  (:action look :parameters () :precondition (there) :effect (when (wet) (increase (total-cost) 7))))
"""
PROBLEM = "(define (problem p) (:domain d) (:htn :subtasks (and {tasks})) (:init (here)))"


def plan(domain: str, tasks: str, **options: object) -> statehtn.Result:
    problem = statehtn.read_hddl_text(domain, PROBLEM.format(tasks=tasks))
    return statehtn.plan(problem, solver="plan", time_limit=30, **options)


@pytest.mark.parametrize("branch", BRANCHES)
def test_the_order_that_can_be_executed_is_found(branch: str) -> None:
    result = plan(UNORDERED.format(wet=""), "(both)", branch=branch)
    assert result.status is Status.OPTIMAL
    assert [step.action for step in result.plan.steps] == ["walk", "look"]


def test_costs_are_those_of_the_states_that_the_order_goes_through() -> None:
    assert plan(UNORDERED.format(wet=""), "(both)").risk_cost == 0
    assert plan(UNORDERED.format(wet="(wet)"), "(both)").risk_cost == 7


def test_no_order_can_be_executed() -> None:
    result = plan(UNORDERED.format(wet=""), "(both) (walk)")
    assert result.status is Status.UNSOLVABLE
    assert result.plan is None


def test_a_network_whose_order_costs_more_than_its_tasks_waits_for_others() -> None:
    """By its tasks alone `soak` costs nothing; it makes the street wet, and then walking costs 9; `taxi` costs 5."""
    domain = """
    (define (domain d) (:predicates (here) (wet)) (:functions (total-cost)) (:task go :parameters ())
      (:method on-foot :parameters () :task (go) :ordered-subtasks (and (soak) (walk)))
      (:method by-car :parameters () :task (go) :ordered-subtasks (and (taxi)))
      (:action soak :parameters () :effect (wet))
      (:action walk :parameters () :effect (when (wet) (increase (total-cost) 9)))
      (:action taxi :parameters () :effect (increase (total-cost) 5)))
    """
    result = plan(domain, "(go)")
    assert result.status is Status.OPTIMAL
    assert result.risk_cost == 5
    assert result.lower_bound == 5
