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


LOOP = """
(define (domain d) (:predicates (here)) (:functions (total-cost)) (:task t :parameters ())
  (:method again :parameters () :task (t) :ordered-subtasks (and (wait) (t)))
  (:method done :parameters () :task (t) :ordered-subtasks (and (walk)))
  (:action wait :parameters () :effect (and))
  (:action walk :parameters () :effect (probabilistic 0.5 (increase (total-cost) 3) 0.5 (increase (total-cost) 7))))
"""


@pytest.mark.parametrize(("objective", "value"), [("deadline 5", 0.5), ("overrun 5", 1), ("piecewise 0:0 5:0 6:-1", 1)])
def test_a_loop_whose_bound_is_lower_by_a_rounding_error_does_not_go_on_for_ever(objective: str, value: float) -> None:
    result = plan(LOOP, "(t)", objective=objective)
    assert result.status is Status.OPTIMAL
    assert result.value == pytest.approx(value)
    assert (result.statistics.expanded or 0) < 10
