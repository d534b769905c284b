"""The shortest way through everything; when this fails, look here first."""

from __future__ import annotations

import pytest

import statehtn

DOMAIN = """
(define (domain errands)
  (:predicates (home) (away))
  (:functions (total-cost) - number)
  (:task errand :parameters ())
  (:method by-train :parameters () :task (errand) :ordered-subtasks (and (take-train)))
  (:method by-car :parameters () :task (errand) :ordered-subtasks (and (take-car)))
  (:action take-train :parameters () :precondition (home)
    :effect (and (away) (not (home)) (increase (total-cost) 4)))
  (:action take-car :parameters () :precondition (home)
    :effect (and (away) (not (home))
                 (probabilistic 0.8 (increase (total-cost) 2) 0.2 (increase (total-cost) 9)))))
"""
PROBLEM = """
(define (problem p) (:domain errands) (:htn :parameters () :ordered-subtasks (and (errand)))
  (:init (home)) (:goal (and (away))))
"""


@pytest.mark.parametrize(
    ("attitude", "alpha", "action", "risk_cost"),
    [("averse", 0.9, "take-train", 4.0), ("neutral", None, "take-car", 3.4), ("seeking", 0.9, "take-car", 2.2474)],
)
def test_attitudes_choose_different_plans(attitude: str, alpha: float | None, action: str, risk_cost: float) -> None:
    problem = statehtn.read_hddl_text(DOMAIN, PROBLEM)
    result = statehtn.plan(problem, attitude=attitude, alpha=alpha)
    assert result.status is statehtn.Status.OPTIMAL
    assert [step.step.action for step in result.steps] == [action]
    assert result.risk_cost == pytest.approx(risk_cost, abs=1e-4)
    assert result.lower_bound == pytest.approx(result.risk_cost)
