"""Methods as the grounder takes them: what becomes a constraint, what a guard, and which choices are parted."""

from __future__ import annotations

from statehtn import plan, read_hddl_text, validate
from statehtn.core.grounding import GroundingSwitches, ground
from statehtn.core.schemes import Scheme, method_schemes
from statehtn.model import And, Atom, Exists, Not, Parameter, Problem

DOMAIN = """
(define (domain d)
  (:types place thing)
  (:predicates (road ?a ?b - place) (at ?p - place) (held ?t - thing) (heavy ?t - thing) (near ?t - thing ?p - place))
  (:task top :parameters (?a - place ?t - thing))
  {}
  (:action move :parameters (?a ?b - place) :precondition (road ?a ?b) :effect (at ?b))
  (:action take :parameters (?t - thing) :effect (held ?t))
  (:action carry :parameters (?t - thing ?p - place) :precondition (held ?t) :effect (at ?p)))
"""
PROBLEM = """
(define (problem p) (:domain d) (:objects p1 p2 p3 - place t1 t2 t3 - thing)
  (:htn :subtasks (and (top p1 t1)))
  (:init (road p1 p1) (road p1 p2) (near t1 p1) (near t2 p1) (near t3 p2) (heavy t1)))
"""


def problem(methods: str) -> Problem:
    return read_hddl_text(DOMAIN.format(methods), PROBLEM)


def schemes(methods: str) -> list[Scheme]:
    return method_schemes(problem(methods), split=True)[1][:-1]


def subtasks(scheme: Scheme) -> list[tuple[str, ...]]:
    return [(subtask.task, *subtask.arguments) for subtask in scheme.subtasks]


UNRELATED = """
(:method m :parameters (?a ?b ?c - place ?t ?u - thing) :task (top ?a ?t) :precondition (near ?u ?a)
  :ordered-subtasks (and (move ?b ?c) (take ?u) (move ?a ?a)))
"""


def test_choices_that_nothing_ties_are_parted() -> None:
    moves, takes, whole = sorted(schemes(UNRELATED), key=lambda scheme: (not scheme.is_part, len(scheme.arguments)))
    assert {parameter.name for parameter in whole.parameters} == {"?a", "?t"}
    assert subtasks(moves) == [("move", "?b", "?c")]
    assert subtasks(takes) == [("take", "?u")]
    assert takes.arguments == ("?a",)  # the constraint that ties ?u to it has moved, too
    assert [subtask.position for subtask in whole.subtasks] == [None, None, 2]
    assert whole.ordering == ((0, 1), (1, 2))


def test_static_parts_of_a_precondition_become_constraints() -> None:
    guards, all_schemes = method_schemes(
        problem(
            "(:method m :parameters (?a - place ?t - thing) :task (top ?a ?t) "
            ":precondition (and (near ?t ?a) (not (held ?t)) (not (heavy ?t))) :ordered-subtasks (and (take ?t)))"
        ),
        split=True,
    )
    (guard,) = guards
    assert [parameter.name for parameter in guard.parameters] == ["?t"]
    assert isinstance(guard.condition, And)
    changing, *fixed = guard.condition.operands
    assert changing == Not(Atom("held", ("?t",)))
    # What the fixed parts say of its variables narrows the guard; the method demands them whole.
    assert fixed == [
        Exists((Parameter("?a", ("place",)),), Atom("near", ("?t", "?a"))),
        Not(Atom("heavy", ("?t",))),
    ]
    assert "near" in str(all_schemes[0].constraints)


def test_a_single_choice_is_not_parted() -> None:
    (whole,) = schemes(
        "(:method m :parameters (?a ?b - place ?t - thing) :task (top ?a ?t) "
        ":ordered-subtasks (and (move ?a ?b) (carry ?t ?a)))"
    )[-1:]
    # ?b depends on ?a only; of the rest, ?t would multiply it.
    assert subtasks(whole)[0] == ("part 1 of m", "?a")
    (whole,) = schemes(
        "(:method m :parameters (?a ?b - place ?t - thing) :task (top ?a ?t) "
        ":ordered-subtasks (and (carry ?t ?a) (carry ?t ?b)))"
    )[-1:]
    assert subtasks(whole)[1] == ("part 1 of m", "?t")
    (whole,) = schemes(
        "(:method m :parameters (?a ?b - place ?t - thing) :task (top ?a ?t) "
        ":precondition (not (= ?b ?a)) :ordered-subtasks (and (carry ?t ?b)))"
    )
    assert subtasks(whole) == [("carry", "?t", "?b")]


def test_several_subtasks_go_together_where_the_others_are_ordered_alike() -> None:
    method = """
    (:method m :parameters (?a ?b - place ?t ?u - thing) :task (top ?a ?t)
      :subtasks (and (s0 (take ?u)) (s1 (carry ?u ?b)) (s2 (carry ?t ?a)) (s3 (move ?a ?a)))
      :ordering (and (< s0 s1) (< s1 s2) (< s2 s3)))
    """
    _, part, whole = schemes(method)
    assert subtasks(part) == [("take", "?u"), ("part 1 of m", "?u")]
    assert part.arguments == ()
    assert part.ordering == ((0, 1),)
    assert subtasks(whole) == [("part 2 of m",), ("carry", "?t", "?a"), ("move", "?a", "?a")]
    between = method.replace("(< s0 s1) (< s1 s2) (< s2 s3)", "(< s0 s2) (< s2 s1) (< s1 s3)")
    assert [len(scheme.subtasks) for scheme in schemes(between)] == [1, 4]


def test_a_plan_speaks_of_the_whole_method() -> None:
    lifted = problem(UNRELATED)
    result = plan(lifted)
    assert result.plan is not None
    assert validate(lifted, result.plan).valid
    (decomposition,) = result.plan.roots
    assert not isinstance(decomposition, int)
    bindings = dict(zip(("?a", "?b", "?c", "?t", "?u"), decomposition.bindings, strict=True))
    assert (bindings["?a"], bindings["?t"]) == ("p1", "t1")
    assert bindings["?u"] in ("t1", "t2")
    assert decomposition.children == (0, 1, 2)


def test_what_each_refinement_saves() -> None:
    """A method with two unrelated choices: 2 roads times 2 things, or 2 and 2; and no task of a single method."""
    lifted = problem(UNRELATED.replace("(move ?a ?a)", "(carry ?t ?a)"))

    def size(split: bool, merge: bool, replace: bool) -> tuple[int, int]:
        grounding = ground(lifted, switches=GroundingSwitches(split, merge, replace))
        return grounding.task_count, grounding.method_count

    assert size(split=False, merge=False, replace=False) == (2, 5)  # with the initial task and its method
    assert size(split=True, merge=False, replace=False) == (4, 6)
    assert size(split=True, merge=False, replace=True) == (3, 5)
