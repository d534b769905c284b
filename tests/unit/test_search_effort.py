"""What is trivial takes next to no effort: counted in nodes, not in seconds."""

from __future__ import annotations

import pytest

from statehtn import Problem, Status, read_hddl_text, validate
from statehtn.core.grounding import ground
from statehtn.core.pricing import price
from statehtn.core.search import find_plans, improving_plans
from statehtn.core.searches import SEARCHES
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
    assert outcome.effort.generated <= 1000


def errands(number: int, order: str = "subtasks") -> Problem:
    """Calls at as many doors, in any order; each begins where the one before has ended."""
    doors = [f"door{index}" for index in range(number)]
    domain = """
    (define (domain errands)
      (:types door)
      (:predicates (at ?d - door) (served ?d - door))
      (:task call :parameters (?d - door)) (:task reach :parameters (?d - door))
      (:method call :parameters (?d - door) :task (call ?d) :ordered-subtasks (and (reach ?d) (serve ?d)))
      (:method stay :parameters (?d - door) :task (reach ?d) :precondition (at ?d) :ordered-subtasks ())
      (:method move :parameters (?e ?d - door) :task (reach ?d) :precondition (at ?e) :ordered-subtasks (walk ?e ?d))
      (:action walk :parameters (?e ?d - door) :precondition (at ?e) :effect (and (not (at ?e)) (at ?d)))
      (:action serve :parameters (?d - door) :precondition (at ?d) :effect (served ?d)))
    """
    problem = f"""(define (problem p) (:domain errands) (:objects {" ".join(doors)} - door)
        (:htn :{order} (and {" ".join(f"(call {door})" for door in doors)})) (:init (at door0)))"""
    return read_hddl_text(domain, problem)


# Each visitor rings; someone inside opens, which one is free to do at any time; then the visitor enters, and whoever
# opened closes. No order of whole tasks is a plan: the visitors' and the porter's parts alternate.
DOORMAN = """
(define (domain doorman)
  (:types guest)
  (:predicates (rung ?g - guest) (open) (inside ?g - guest))
  (:task visit :parameters (?g - guest)) (:task attend :parameters (?g - guest))
  (:method visit :parameters (?g - guest) :task (visit ?g) :ordered-subtasks (and (ring ?g) (enter ?g)))
  (:method attend :parameters (?g - guest) :task (attend ?g) :ordered-subtasks (and (unlock ?g) (lock ?g)))
  (:action ring :parameters (?g - guest) :precondition (not (open)) :effect (rung ?g))
  (:action unlock :parameters (?g - guest) :precondition (and (rung ?g) (not (open))) :effect (open))
  (:action enter :parameters (?g - guest) :precondition (and (rung ?g) (open))
    :effect (and (inside ?g) (not (rung ?g))))
  (:action lock :parameters (?g - guest) :precondition (and (inside ?g) (open)) :effect (not (open))))
"""


def doorman(number: int) -> Problem:
    guests = [f"g{index}" for index in range(number)]
    tasks = " ".join(f"(visit {guest}) (attend {guest})" for guest in guests)
    problem = f"""(define (problem p) (:domain doorman) (:objects {" ".join(guests)} - guest)
        (:htn :subtasks (and {tasks})) (:init))"""
    return read_hddl_text(DOORMAN, problem)


def chain(number: int) -> Problem:
    """Errands of which each needs that the next one has been done: the only order is the domain's turned round."""
    doors = [f"door{index}" for index in range(number)]
    domain = """
    (define (domain chain)
      (:types door)
      (:predicates (at ?d - door) (served ?d - door) (needs ?d ?e - door))
      (:task call :parameters (?d - door)) (:task reach :parameters (?d - door))
      (:method call :parameters (?d ?e - door) :task (call ?d) :precondition (needs ?d ?e)
        :ordered-subtasks (and (reach ?d) (serve ?d ?e)))
      (:method stay :parameters (?d - door) :task (reach ?d) :precondition (at ?d) :ordered-subtasks ())
      (:method move :parameters (?e ?d - door) :task (reach ?d) :precondition (at ?e) :ordered-subtasks (walk ?e ?d))
      (:action walk :parameters (?e ?d - door) :precondition (at ?e) :effect (and (not (at ?e)) (at ?d)))
      (:action serve :parameters (?d ?e - door) :precondition (and (at ?d) (needs ?d ?e) (served ?e))
        :effect (served ?d)))
    """
    needs = " ".join(f"(needs {one} {other})" for one, other in zip(doors, [*doors[1:], "office"], strict=True))
    problem = f"""(define (problem p) (:domain chain) (:objects {" ".join(doors)} office - door)
        (:htn :subtasks (and {" ".join(f"(call {door})" for door in doors)}))
        (:init (at door0) (served office) {needs}))"""
    return read_hddl_text(domain, problem)


@pytest.mark.parametrize("search", ["greedy", "anytime"])
@pytest.mark.parametrize(
    ("problem", "actions"), [(errands(30), 59), (doorman(8), 32), (chain(8), 16)], ids=["errands", "doorman", "chain"]
)
def test_unordered_tasks_are_done_one_after_the_other(search: str, problem: Problem, actions: int) -> None:
    first = next(improving_plans(price(ground(problem), utility_for("neutral")), search=search))
    assert first.plan is not None
    assert validate(problem, first.plan).valid
    assert len(first.plan.steps) == actions
    assert first.effort.generated <= 20_000


def balls(number: int) -> Problem:
    """Gripper, wrapped in a task that may become nothing: the decomposition graph knows no bound."""
    names = [f"b{index}" for index in range(number)]
    domain = """
    (define (domain balls)
      (:types room ball hand)
      (:predicates (robot ?r - room) (at ?b - ball ?r - room) (free ?h - hand) (holds ?h - hand ?b - ball))
      (:task work :parameters ())
      (:method stop :parameters () :task (work) :ordered-subtasks ())
      (:method move :parameters (?a ?b - room) :task (work) :ordered-subtasks (and (go ?a ?b) (work)))
      (:method pick :parameters (?b - ball ?r - room ?h - hand) :task (work)
        :ordered-subtasks (and (take ?b ?r ?h) (work)))
      (:method drop :parameters (?b - ball ?r - room ?h - hand) :task (work)
        :ordered-subtasks (and (put ?b ?r ?h) (work)))
      (:action go :parameters (?a ?b - room) :precondition (robot ?a) :effect (and (robot ?b) (not (robot ?a))))
      (:action take :parameters (?b - ball ?r - room ?h - hand) :precondition (and (robot ?r) (at ?b ?r) (free ?h))
        :effect (and (holds ?h ?b) (not (at ?b ?r)) (not (free ?h))))
      (:action put :parameters (?b - ball ?r - room ?h - hand) :precondition (and (robot ?r) (holds ?h ?b))
        :effect (and (at ?b ?r) (free ?h) (not (holds ?h ?b)))))
    """
    problem = f"""(define (problem p) (:domain balls)
        (:objects x y - room {" ".join(names)} - ball left right - hand) (:htn :ordered-subtasks (work))
        (:init (robot x) (free left) (free right) {" ".join(f"(at {name} x)" for name in names)})
        (:goal (and {" ".join(f"(at {name} y)" for name in names)})))"""
    return read_hddl_text(domain, problem)


def test_weighted_search_asks_several_heuristics_by_default() -> None:
    grounding = ground(balls(14))
    by_default, by_cuts = (
        find_plans(grounding, utility_for("neutral"), search="weighted", weight=2.0, heuristic=heuristic)
        for heuristic in ("auto", "lmcut")
    )
    assert by_default.plan is not None
    assert by_cuts.plan is not None
    assert len(by_default.plan.steps) <= 2 * by_default.lower_bound
    assert by_default.lower_bound >= by_cuts.lower_bound
    assert by_default.effort.generated <= 20 * by_cuts.effort.generated


@pytest.mark.parametrize("search", SEARCHES)
def test_searches_for_a_plan_take_turns_with_one_that_proves(search: str) -> None:
    """Pairs of facts tell A* that nobody can hold both keys, whatever is done; greedy search alone never ends."""
    domain = """
    (define (domain keys)
      (:predicates (red) (blue) (seen))
      (:task work :parameters ()) (:task job :parameters ())
      (:method more :parameters () :task (work) :ordered-subtasks (and (job) (work)))
      (:method stop :parameters () :task (work) :ordered-subtasks ())
      (:method job :parameters () :task (job) :ordered-subtasks (and (work) (job)))
      (:method swap :parameters () :task (job) :ordered-subtasks (and (lend) (look)))
      (:action lend :parameters () :effect (and (blue) (not (red))))
      (:action look :parameters () :precondition (blue) :effect (seen)))
    """
    problem = """(define (problem p) (:domain keys) (:htn :ordered-subtasks (work)) (:init (red))
        (:goal (and (seen) (red))))"""
    grounding = ground(read_hddl_text(domain, problem))
    outcome = find_plans(grounding, utility_for("neutral"), search=search, weight=2.0)
    assert outcome.status is Status.UNSOLVABLE
