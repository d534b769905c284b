"""Errors of the reader: every mistake names its place, what was found, and what was expected."""

from __future__ import annotations

import pytest

from statehtn.errors import InputError, StateHtnError, UnsupportedError
from statehtn.hddl import read_hddl_text

DOMAIN = """(define (domain d)
(:types car boat - vehicle place)
(:constants home - place)
(:predicates (at ?v - vehicle ?p - place) (late))
(:task go :parameters (?v - vehicle ?p - place))
(:action move :parameters (?v - vehicle ?p - place) :precondition (late) :effect (at ?v ?p))
(:method m :parameters (?v - vehicle ?p - place) :task (go ?v ?p) :subtasks (and (a (move ?v ?p)) (b (move ?v ?p))) :ordering (< a b))
)"""  # noqa: E501
PROBLEM = """(define (problem p)
(:domain d)
(:objects c1 - car b1 - boat)
(:htn :parameters (?p - place) :subtasks (t1 (go c1 ?p)))
(:init (at c1 home) (late))
(:goal (at c1 home))
)"""


def error_of(domain: str, problem: str) -> StateHtnError:
    with pytest.raises(StateHtnError) as caught:
        read_hddl_text(domain, problem)
    return caught.value


def test_the_unchanged_text_is_fine() -> None:
    assert read_hddl_text(DOMAIN, PROBLEM, strict=True).name == "p"


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        # types
        (
            "car boat - vehicle",
            "car - vehicle vehicle - car boat",
            "2:9: the types are in a cycle: car - vehicle - car",
        ),
        ("place)", "place object - place)", "2:34: 'object' is above all types"),
        ("place)", "place - )", "2:34: expected a type after '-'"),
        ("place)", "- place)", "2:28: expected a name before '-'"),
        ("place)", "(place))", "2:28: expected a name or '-', found '(place ...)'"),
        ("place)", "place - (or a b))", "2:36: expected a type or '(either <types>)', found '(or ...)'"),
        ("place)", "?place)", "2:28: expected the name of a type, found '?place'"),
        ("(at ?v - vehicle", "(at ?v - vehicel", "4:23: unknown type 'vehicel'; did you mean 'vehicle'?"),
        ("home - place", "home - plaice", "3:20: unknown type 'plaice'; did you mean 'place'?"),
        # declarations
        ("(late))", "(late) (at))", "4:51: there is a predicate 'at' already"),
        ("(late))", "late)", "4:43: expected '(<predicate> <parameters>)', found 'late'"),
        ("(late))", "(and))", "4:44: 'and' is a word of HDDL and cannot name a predicate"),
        ("(late))", "(late l))", "4:49: expected a variable such as '?x', found 'l'"),
        ("(:task go :parameters", "(:task", "5:8: expected the name of a task, found '(?v ...)'"),
        ("(:task go", "(:task move", "6:10: there is a task 'move' already"),
        ("\n)", "\n(:task go :parameters ()))", "8:8: there is a task 'go' already"),
        ("\n)", "\n(:action move :parameters ()))", "8:10: there is an action 'move' already"),
        ("(late))", "(late) (late ?x))", "4:51: there is a predicate 'late' already"),
        ("(:task go", "(:task", "5:8: expected the name of a task, found ':parameters'"),
        ("(:constants", "(:constant", "3:1: unknown section ':constant'; did you mean ':constants'?"),
        ("(:types car", "((:types) car", "2:1: expected a section such as '(:action ...)', found '(('"),
        # actions
        (":effect (at", ":effects (at", "6:74: unknown keyword ':effects'; did you mean ':effect'?"),
        (":precondition (late)", ":precondition", "6:67: expected a value in parentheses after ':precondition'"),
        (
            ":precondition (late)",
            ":precondition late",
            "6:67: expected parentheses after ':precondition', found 'late'",
        ),
        (
            ":precondition (late)",
            "(late)",
            "6:53: expected one of :parameters, :precondition, :effect, found '(late ...)'",
        ),
        (":precondition (late)", ":effect ()", "6:64: ':effect' stands twice"),
        ("(?v - vehicle ?p - place) :pre", "(?v - vehicle ?v - place) :pre", "6:41: variable '?v' is declared twice"),
        ("(late) :effect", "(lat) :effect", "6:68: unknown predicate 'lat'; did you mean 'late'?"),
        ("(late) :effect", "(late ?v) :effect", "6:67: predicate 'late' takes no arguments, found 1"),
        ("(late) :effect", "(not) :effect", "6:67: expected 1 operand of 'not', found 0"),
        ("(late) :effect", "(and late) :effect", "6:72: expected a formula in parentheses, found 'late'"),
        (
            "(late) :effect",
            "((late)) :effect",
            "6:67: expected a predicate or a word such as 'and', found '(late ...)'",
        ),
        ("(late) :effect", "(forall ?x (late)) :effect", "6:75: expected variables in parentheses, found '?x'"),
        ("(late) :effect", "(exists (?x - care) (late)) :effect", "6:81: unknown type 'care'"),
        ("(late) :effect", "(= ?v ?q) :effect", "6:73: unknown variable '?q'"),
        ("(late) :effect", "(sortof ?v car) :effect", "6:67: expected '(sortof ?x - <type>)', one variable and its"),
        ("(late) :effect", "(sortof ?v ?p - car) :effect", "6:67: expected '(sortof ?x - <type>)', one variable"),
        ("(late) :effect", "(sortof ?v - care) :effect", "6:80: unknown type 'care'; did you mean 'car'?"),
        (":effect (at ?v ?p)", ":effect (att ?v ?p)", "6:83: unknown predicate 'att'; did you mean 'at'?"),
        (
            ":effect (at ?v ?p)",
            ":effect (at ?v)",
            "6:82: predicate 'at' takes 2 arguments, found 1 (declared with ?v - ve",
        ),
        (
            ":effect (at ?v ?p)",
            ":effect (at ?v ?v)",
            "6:89: variable '?v' is of type 'vehicle', but predicate 'at' expects",
        ),
        (
            ":effect (at ?v ?p)",
            ":effect (at home ?p)",
            "6:86: object 'home' is of type 'place', but predicate 'at' expect",
        ),
        (":effect (at ?v ?p)", ":effect (at ?v hame)", "6:89: unknown object 'hame'; did you mean 'home'?"),
        (":effect (at ?v ?p)", ":effect (at ?v c9)", "6:89: unknown object 'c9'"),
        (":effect (at ?v ?p)", ":effect (at ?v (home))", "6:89: expected a variable or an object, found '(home ...)'"),
        (":effect (at ?v ?p)", ":effect (not late)", "6:87: expected '(<predicate> ...)', found 'late'"),
        (":effect (at ?v ?p)", ":effect (when (late))", "6:82: expected '(when <condition> <effect>)'"),
        (
            ":effect (at ?v ?p)",
            ":effect (forall (?v - car ?v - car) (late))",
            "6:100: variable '?v_1' is declared twice",
        ),
        (":effect (at ?v ?p)", ":effect (or (late))", "6:82: 'or' cannot be an effect"),
        # methods
        ("(:method m", "(:method", "7:10: expected the name of a method, found ':parameters'"),
        (":task (go ?v ?p)", "", "7:1: method 'm' must say which task it decomposes"),
        (
            ":task (go ?v ?p)",
            ":task (goo ?v ?p)",
            "7:57: method 'm' decomposes an unknown task 'goo'; did you mean 'go'?",
        ),
        (":task (go ?v ?p)", ":task (move ?v ?p)", "7:57: method 'm' cannot decompose 'move', which is an action"),
        (":task (go ?v ?p)", ":task (go ?v ?x)", "7:63: unknown variable '?x'"),
        (
            ":task (go ?v ?p)",
            ":task (go ?p ?v)",
            "7:60: variable '?p' is of type 'place', but task 'go' expects 'vehic",
        ),
        ("(a (move", "(a (mov", "7:86: unknown task 'mov'; did you mean 'move'?"),
        ("(a (move ?v ?p))", "(a (move ?v))", "7:85: action 'move' takes 2 arguments, found 1"),
        ("(a (move ?v ?p))", "()", "7:82: expected a subtask, found '()'"),
        ("(a (move ?v ?p))", "(a ())", "7:85: expected '(<task> <arguments>)', found '()'"),
        ("(a (move ?v ?p))", "a", "7:82: expected a subtask in parentheses, found 'a'"),
        ("(a (move ?v ?p))", "(b (move ?v ?p))", "7:100: label 'b' stands twice in one network"),
        ("(< a b)", "(< a c)", "7:132: unknown label 'c'"),
        ("(< a b)", "(and (< a b) (< b a))", "7:127: the ordering of the subtasks is cyclic: a < b < a"),
        ("(< a b)", "(< a a)", "7:127: the ordering of the subtasks is cyclic: a < a"),
        ("(< a b)", "(before a b)", "7:127: expected '(< <label> <label>)', found '(before ...)'"),
        (":ordering (< a b)", ":tasks ()", "7:117: ':tasks' and ':subtasks' exclude each other"),
        (":ordering (< a b)", ":constraints (late)", "7:130: expected a constraint ('=', "),
        (":ordering (< a b)", ":constraints (exists (?x) (= ?x ?v))", "7:130: expected a constraint on variables"),
        ("\n)", "\n(:method m :task (go c1 home)))", "8:10: there is a method 'm' already"),
        # the file
        (
            "(domain d)",
            "(problem d)",
            "1:9: expected '(domain <name>)', found '(problem'; this is a problem file where the d",
        ),
        ("(domain d)", "(domain)", "1:9: expected '(domain <name>)' with one name"),
    ],
)
def test_mistakes_in_the_domain(old: str, new: str, message: str) -> None:
    assert old in DOMAIN
    error = error_of(DOMAIN.replace(old, new, 1), PROBLEM)
    assert isinstance(error, InputError)
    assert str(error)[: len(message) + 7] == f"domain:{message}"


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("(:objects c1 - car", "(:objects c1 - cart", "3:16: unknown type 'cart'; did you mean 'car'?"),
        ("(:htn :param", "(:hnt :param", "4:1: unknown section ':hnt'; did you mean ':htn'?"),
        ("(:htn :parameters (?p - place)", "(:htn", "4:28: unknown variable '?p'"),
        ("(go c1 ?p)", "(go c1 home home)", "4:46: task 'go' takes 2 arguments, found 3"),
        (
            "(go c1 ?p)",
            "(go home ?p)",
            "4:50: object 'home' is of type 'place', but task 'go' expects 'vehicle' for '?v'",
        ),
        ("(:init (at c1 home)", "(:init (at c1 hom)", "5:15: unknown object 'hom'; did you mean 'home'?"),
        ("(:init (at c1 home)", "(:init (att c1 home)", "5:9: unknown predicate 'att'; did you mean 'at'?"),
        ("(:init (at c1 home)", "(:init (at home c1)", "5:12: object 'home' is of type 'place', but predicate 'at' ex"),
        ("(:init (at c1 home)", "(:init (at c1)", "5:8: predicate 'at' takes 2 arguments, found 1"),
        ("(:init (at c1 home)", "(:init at (at c1 home)", "5:8: expected a fact in parentheses, found 'at'"),
        ("(:init (at c1 home)", "(:init ()", "5:8: expected '(<predicate> <objects>)', found '()'"),
        ("(:init (at c1 home)", "(:init ((at c1 home))", "5:8: expected '(<predicate> <objects>)', found '((...'"),
        ("(:init (at c1 home)", "(:init (at c1 ?p)", "5:15: unknown variable '?p'"),
        ("(:init (at c1 home)", "(:init (at (c1) home)", "5:12: expected a variable or an object, found '(c1 ...)'"),
        ("(:init (at c1 home)", "(:init (late) (not (late))", "5:15: the fact (late) is stated as true and as false"),
        ("(:init (at c1 home)", "(:init (not late)", "5:8: expected '(not (<predicate> ...))'"),
        ("(:goal (at c1 home))", "(:goal (at c1 ?p))", "6:15: unknown variable '?p'"),
        ("(:goal (at c1 home))", "(:goal (late) (late))", "6:15: expected one formula in ':goal'"),
        ("(:goal (at c1 home))", "(:goal ()) (:goal ())", "6:12: a second section ':goal'"),
        ("(:goal (at c1 home))", "(:metric (total-cost))", "6:1: expected '(:metric minimize (total-cost))'"),
        ("(:domain d)", "(:domain)", "2:1: expected '(:domain <name>)'"),
        ("(problem p)", "(domain p)", "1:9: expected '(problem <name>)', found '(domain'; this is a domain file"),
        (
            "(:htn :parameters (?p - place) :subtasks (t1 (go c1 ?p)))",
            "",
            "1:1: the problem has no initial task network",
        ),
    ],
)
def test_mistakes_in_the_problem(old: str, new: str, message: str) -> None:
    assert old in PROBLEM
    error = error_of(DOMAIN, PROBLEM.replace(old, new, 1))
    assert isinstance(error, InputError)
    assert str(error)[: len(message) + 8] == f"problem:{message}"


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("(late) :effect", "(>= (fuel ?v) 3) :effect", "domain:6:67: comparing numbers"),
        ("(late) :effect", "(= (fuel ?v) 3) :effect", "domain:6:67: comparing the values of functions"),
        ("(late) :effect", "(preference a (late)) :effect", "domain:6:67: preferences and trajectory constraints"),
        ("(:action move", "(:durative-action move", "domain:6:1: actions with durations"),
        ("\n)", "\n(:derived (late) ()))", "domain:8:1: derived predicates"),
        ("\n)", "\n(:functions (pos ?v) - place))", "domain:8:24: functions have the type 'number', found 'place'"),
        ("home - place", "home - (either place car)", "domain:3:34: object 'home' must have one type"),
        (
            "(at c1 home) (late))\n(:goal",
            "(oneof (late) (late)))\n(:goal",
            "problem:5:8: 'oneof' is not supported in ':init'",
        ),
        ("(:goal (at c1 home))", "(:metric maximize (total-cost))", "problem:6:1: the only metric is"),
        ("(:goal (at c1 home))", "(:metric minimize (+ (total-cost) 1))", "problem:6:1: the only metric is"),
        ("(:goal (at c1 home))", "(:constraints (always (late)))", "problem:6:1: trajectory constraints"),
        ("(:goal (at c1 home))", "(:utility (= (late) 3))", "problem:6:1: utilities of facts"),
        ("(:goal (at c1 home))", "(:bound 12)", "problem:6:1: bounds on the cost"),
        ("(:htn :param", "(:tihtn :param", "problem:4:1: inserting tasks that the hierarchy does not ask for"),
        ("(:htn :param", "(:htn-ti :param", "problem:4:1: inserting tasks that the hierarchy does not ask for"),
        ("\n)", "\n(:include more))", "domain:8:1: including other files"),
        ("\n)", "\n(:requirements :typing :typeof-predicate))", "domain:8:24: facts about the types of objects"),
        (":subtasks (and", ":effect (and (late)) :subtasks (and", "domain:7:75: effects of methods"),
    ],
)
def test_what_is_not_supported(old: str, new: str, message: str) -> None:
    domain = DOMAIN.replace(old, new, 1)
    problem = PROBLEM if domain != DOMAIN else PROBLEM.replace(old, new, 1)
    error = error_of(domain, problem)
    assert isinstance(error, UnsupportedError)
    assert str(error).startswith(message)


def test_a_long_cycle_of_types_is_found_quickly() -> None:
    size = 20_000
    types = " ".join(f"t{i} - t{(i + 1) % size}" for i in range(size))
    assert "the types are in a cycle" in str(error_of(f"(define (domain d) (:types {types}))", PROBLEM))
