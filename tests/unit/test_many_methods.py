"""A task of many methods, which are found by facts: a walk on a square, one method for each way."""

from __future__ import annotations

import statehtn
from tests.benchmarks.policy_cases import grid

WIDTH = 6
DOMAIN = """
(define (domain walk)
  (:predicates (at ?c) (last ?c) (next ?a ?b))
  (:task go)
  (:method there :parameters (?c) :task (go) :precondition (and (at ?c) (last ?c)) :ordered-subtasks ())
  (:method one-more :parameters (?a ?b) :task (go) :ordered-subtasks (and (step ?a ?b) (go)))
  (:action step :parameters (?a ?b) :precondition (and (at ?a) (next ?a ?b)) :effect (and (not (at ?a)) (at ?b))))"""


def walk() -> statehtn.Problem:
    """From one corner to the other; one way leads to the right, or down."""
    cells = {(x, y): f"c{x}-{y}" for x in range(WIDTH) for y in range(WIDTH)}
    ways = [
        f"(next {name} {cells[x + dx, y + dy]})"
        for (x, y), name in cells.items()
        for dx, dy in ((0, 1), (1, 0))
        if (x + dx, y + dy) in cells
    ]
    problem = f"""(define (problem p) (:domain walk) (:objects {" ".join(cells.values())})
      (:htn :ordered-subtasks (and (go))) (:init (at c0-0) (last c{WIDTH - 1}-{WIDTH - 1}) {" ".join(ways)}))"""
    return statehtn.read_hddl_text(DOMAIN, problem)


def test_a_walk_is_found() -> None:
    for search in ("astar", "greedy"):
        result = statehtn.plan(walk(), search=search)
        assert result.length == 2 * (WIDTH - 1)
    assert len(statehtn.top_plans(walk(), 300).plans) == 252  # 10 over 5


def test_a_policy_is_found() -> None:
    case = grid(4, 1)
    result = statehtn.policy(statehtn.read_hddl_text(case.domain, case.problem))
    assert result.status is statehtn.Status.OPTIMAL
