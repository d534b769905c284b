"""What is trivial takes next to no effort: counted in nodes, not in seconds."""

from __future__ import annotations

import pytest

from statehtn import Status, read_hddl_text
from statehtn.core.grounding import ground
from statehtn.core.search import SEARCHES, find_plans
from statehtn.risk import utility_for

# Meetings may call further meetings, all without an order, and every one of them costs nothing but its decisions: the
# decomposition graph alone never comes to an end.
MEETINGS = """
(define (domain meetings)
  (:predicates (proposed) (decided))
  (:task meet :parameters ()) (:task settle :parameters ())
  (:method call-more :parameters () :task (meet) :subtasks (and (settle) (meet)))
  (:method adjourn :parameters () :task (meet) :subtasks ())
  (:method defer :parameters () :task (settle) :subtasks (meet))
  (:method vote :parameters () :task (settle) :ordered-subtasks (and (propose) (decide)))
  (:action propose :parameters () :effect (proposed))
  (:action decide :parameters () :precondition (proposed) :effect (decided)))
"""
DECIDE = "(define (problem p) (:domain meetings) (:htn :subtasks (and (meet))) (:init) (:goal (decided)))"


@pytest.mark.parametrize("search", SEARCHES)
def test_unordered_recursion_does_not_stall(search: str) -> None:
    grounding = ground(read_hddl_text(MEETINGS, DECIDE))
    outcome = find_plans(grounding, utility_for("neutral"), search=search, weight=2.0)
    assert outcome.status in (Status.OPTIMAL, Status.SOLVED)
    assert outcome.plan is not None
    assert len(outcome.plan.steps) == 2
    assert outcome.generated <= 1000
