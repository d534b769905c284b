"""What the reader understands: every construct of HDDL once, and the dialects of the competition's files."""

from __future__ import annotations

import gc
import time
from contextlib import suppress

import pytest

from statehtn.errors import InputError
from statehtn.hddl import HddlWarning, read_hddl_text
from statehtn.model import (
    TRUE,
    And,
    Atom,
    Effect,
    Equals,
    Exists,
    Forall,
    Method,
    Not,
    OfType,
    Or,
    Parameter,
    Problem,
    Signature,
    Subtask,
    TaskNetwork,
)

DOMAIN = """
; A small domain with most things in it; sections in an unusual order.
(define (domain Courier)
  (:method m-Walk
    :precondition (and (at ?r ?A) (not (broken)) (imply (icy ?a) (exists (?s - shoe) (wears ?r ?s))))
    :ordering (and (< first second))
    :subtasks (and (first (move ?r ?a ?b)) (second (rest)))
    :constraints (and (not (= ?a ?b)) (sortof ?r - walker) (or (= ?b home) (not (sortof ?a - place))))
    :task (Go ?r ?b)
    :parameters (?r - (either walker van) ?a ?b - place))
  (:method m-stay :parameters (?r ?p) :task (go ?r ?p) :subtasks ())
  (:method m-idle :task (idle))
  (:task go :parameters (?r - object ?to - place))
  (:task idle)
  (:action move
    :parameters (?r - agent ?a ?b - place)
    :precondition (forall (?x - place) (or (= ?x ?a) (not (at ?r ?x))))
    :effect (and (at ?r ?b) (not (at ?r ?a))
      (when (icy ?b) (and (broken) (not (wears ?r lucky))))
      (forall (?s - shoe) (when (wears ?r ?s) (forall (?p - place) (not (clean ?s ?p)))))))
  (:action rest :parameters () :precondition () :effect ())
  (:predicates (at ?r - agent ?p - place) (icy ?p - place) (broken) (wears ?a - agent ?s - shoe)
    (clean ?s - shoe ?p - place))
  (:constants home - place lucky - shoe)
  (:types walker van - agent amphibian - van amphibian - walker place shoe)
  (:requirements :typing :hierarchy))
"""
PROBLEM = """
(define (problem p1)
  (:domain courier)
  (:init (at bob home) (icy MALL) (not (broken)))
  (:objects bob - walker mall - place)
  (:goal (and (at bob mall)))
  (:htn :parameters (?p - place) :tasks (and (go bob ?p) (t2 (idle)) (rest)) :ordering (< t2 task0)
    :constraints (= ?p mall)))
"""
EMPTY_PROBLEM = "(define (problem p) (:domain d) (:htn :subtasks ()))"


def read(sections: str, problem: str = EMPTY_PROBLEM) -> Problem:
    return read_hddl_text(f"(define (domain d) {sections})", problem)


def method(body: str) -> Method:
    domain = f"(:predicates (p)) (:task t :parameters (?a)) (:action a :parameters (?x)) (:method m {body})"
    return read(domain).domain.methods["m"]


@pytest.fixture(scope="module")
def courier() -> Problem:
    return read_hddl_text(DOMAIN, PROBLEM, strict=True)


def test_declarations(courier: Problem) -> None:
    domain = courier.domain
    assert domain.name == "Courier"
    assert domain.types.parents == {
        "walker": ("agent",),
        "van": ("agent",),
        "agent": (),
        "amphibian": ("van", "walker"),
        "place": (),
        "shoe": (),
    }
    assert domain.constants == {"home": "place", "lucky": "shoe"}
    assert domain.tasks["go"] == Signature("go", (Parameter("?r"), Parameter("?to", ("place",))))
    assert domain.tasks["idle"] == Signature("idle")
    assert list(domain.actions) == ["move", "rest"]
    assert domain.has_unit_costs


def test_method(courier: Problem) -> None:
    read_method = courier.domain.methods["m-Walk"]
    assert read_method.parameters[0] == Parameter("?r", ("walker", "van"))
    assert (read_method.task, read_method.arguments) == ("go", ("?r", "?b"))
    assert read_method.precondition == And(
        (
            Atom("at", ("?r", "?a")),
            Not(Atom("broken")),
            Or(
                (
                    Not(Atom("icy", ("?a",))),
                    Exists((Parameter("?s", ("shoe",)),), Atom("wears", ("?r", "?s"))),
                )
            ),
        )
    )
    assert read_method.network == TaskNetwork(
        (Subtask("first", "move", ("?r", "?a", "?b")), Subtask("second", "rest")),
        ((0, 1),),
        And(
            (
                Not(Equals("?a", "?b")),
                OfType("?r", ("walker",)),
                Or((Equals("?b", "home"), Not(OfType("?a", ("place",))))),
            )
        ),
    )


def test_action(courier: Problem) -> None:
    action = courier.domain.actions["move"]
    place = Parameter("?x", ("place",))
    assert action.precondition == Forall((place,), Or((Equals("?x", "?a"), Not(Atom("at", ("?r", "?x"))))))
    icy = Atom("icy", ("?b",))
    assert action.effects == (
        Effect(Atom("at", ("?r", "?b"))),
        Effect(Atom("at", ("?r", "?a")), False),
        Effect(Atom("broken"), True, icy),
        Effect(Atom("wears", ("?r", "lucky")), False, icy),
        Effect(
            Atom("clean", ("?s", "?p")),
            False,
            Atom("wears", ("?r", "?s")),
            (Parameter("?s", ("shoe",)), Parameter("?p", ("place",))),
        ),
    )


def test_problem(courier: Problem) -> None:
    assert courier.objects == {"bob": "walker", "mall": "place"}
    assert courier.parameters == (Parameter("?p", ("place",)),)
    assert courier.network == TaskNetwork(
        (Subtask("task0", "go", ("bob", "?p")), Subtask("t2", "idle"), Subtask("task1", "rest")),
        ((1, 0),),
        Equals("?p", "mall"),
    )
    assert courier.initial_state == {("at", "bob", "home"), ("icy", "mall")}
    assert courier.goal == And((Atom("at", ("bob", "mall")),))


@pytest.mark.parametrize(
    ("body", "subtasks", "ordering"),
    [
        ("", (), ()),
        (":subtasks ()", (), ()),
        (":tasks (and)", (), ()),
        (":subtasks (a ?x)", (Subtask("task0", "a", ("?x",)),), ()),
        (":subtasks (task0 (a ?x))", (Subtask("task0", "a", ("?x",)),), ()),
        (
            ":subtasks (and (a ?x) (task0 (a ?x)))",
            (Subtask("task1", "a", ("?x",)), Subtask("task0", "a", ("?x",))),
            (),
        ),
        (
            ":ordered-tasks (and (x (a ?x)) (t ?x))",
            (Subtask("x", "a", ("?x",)), Subtask("task0", "t", ("?x",))),
            ((0, 1),),
        ),
        (
            ":ordered-subtasks (and (x (a ?x)) (y (t ?x))) :order (and (x < y))",
            (Subtask("x", "a", ("?x",)), Subtask("y", "t", ("?x",))),
            ((0, 1),),
        ),
        (
            ":subtasks (and (x (a ?x)) (y (t ?x))) :ordering (and (> x y) (< y x))",
            (Subtask("x", "a", ("?x",)), Subtask("y", "t", ("?x",))),
            ((1, 0),),
        ),
    ],
)
def test_forms_of_networks(body: str, subtasks: tuple[Subtask, ...], ordering: tuple[tuple[int, int], ...]) -> None:
    assert method(f":parameters (?x) :task (t ?x) {body}").network == TaskNetwork(subtasks, ordering)


def test_types_may_repeat_and_name_object() -> None:
    types = read("(:types object a b - object c - (either a b) c - a)").domain.types
    assert types.parents == {"a": ("object",), "b": ("object",), "c": ("a", "b")}


def test_names_of_different_kinds_may_be_equal() -> None:
    problem = read(
        "(:types a) (:predicates (a ?a - a)) (:constants a - a) (:action a :parameters (?a - a) :effect (a ?a))",
        "(define (problem a) (:domain d) (:init (a a)) (:htn :subtasks (a (a a))))",
    )
    assert problem.initial_state == {("a", "a")}
    assert problem.network.subtasks == (Subtask("a", "a", ("a",)),)


def test_a_wider_and_an_overlapping_type_are_fine() -> None:
    """Methods narrow by their constraints or by the binding: only what can never hold is an error."""
    domain = """(:types car boat - vehicle amphibian - car amphibian - boat)
      (:predicates (swims ?b - boat))
      (:action wash :parameters (?v - car)) (:task t :parameters (?c - car))
      (:method m :parameters (?v - vehicle) :task (t ?v) :subtasks (wash ?v))
      (:method n :parameters (?c - car) :task (t ?c) :precondition (swims ?c))"""
    assert list(read(domain).domain.methods) == ["m", "n"]


def test_empty_goal_and_missing_sections() -> None:
    problem = read("", "(define (problem p) (:goal ()) (:htn :subtasks ()))")
    assert problem.goal == TRUE
    assert problem.network == TaskNetwork()
    assert read("", "(define (problem p) (:goal) (:htn :subtasks ()))").goal == TRUE


@pytest.mark.parametrize(
    ("sections", "problem", "message"),
    [
        ("(:constants c)", "(define (problem p) (:objects c) (:htn))", "problem:1:31: object 'c' is declared again"),
        ("(:constants c e e c)", EMPTY_PROBLEM, "domain:1:36: object 'e' is declared again, and 1 more like it"),
        ("", "(define (problem p) (:domain e) (:htn))", "problem:1:30: the problem is for domain 'e'"),
        ("(:predicates (p)) (:predicates (q))", EMPTY_PROBLEM, "domain:1:38: a second section ':predicates'"),
        ("(:predicates (= ?x ?y))", EMPTY_PROBLEM, "domain:1:33: '=' is built in"),
        ("(:predicates (p ?x ?x))", EMPTY_PROBLEM, "domain:1:39: variable '?x' is declared twice"),
    ],
)
def test_sloppy_input_warns_and_strict_refuses(sections: str, problem: str, message: str) -> None:
    domain = f"(define (domain d) {sections})"
    with pytest.warns(HddlWarning) as caught:
        read_hddl_text(domain, problem)
    assert [str(warning.message)[: len(message)] for warning in caught] == [message]
    assert caught[0].filename == __file__
    with pytest.raises(InputError) as error:
        read_hddl_text(domain, problem, strict=True)
    assert str(error.value).startswith(message)


@pytest.mark.parametrize("problem", [EMPTY_PROBLEM, ")"])
def test_the_collector_of_cycles_is_on_again_afterwards(problem: str) -> None:
    with suppress(InputError):
        read("", problem)
    assert gc.isenabled()


@pytest.mark.parametrize("kind", ["facts", "values"])
def test_large_problems_are_read_fast(kind: str) -> None:
    domain = """(:types place) (:predicates (road ?a ?b - place)) (:functions (length ?a ?b - place) - number)"""
    size = 300
    form = "(road place{} place{})" if kind == "facts" else "(= (length place{} place{}) 2.5)"
    statements = "\n".join(form.format(i, j) for i in range(size) for j in range(size))
    places = " ".join(f"place{i}" for i in range(size))
    text = f"(define (problem p) (:objects {places} - place) (:init {statements}) (:htn :subtasks ()))"
    start = time.process_time()
    problem = read(domain, text)
    seconds = time.process_time() - start
    assert len(problem.initial_state) + len(problem.function_values) == size * size
    assert seconds < 10  # of CPU: twenty times what it takes; anything quadratic takes hours
