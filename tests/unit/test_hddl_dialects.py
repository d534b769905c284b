"""HDDL as people write it: forms beyond the standard, and slips whose meaning is clear, which are warnings."""

from __future__ import annotations

import pytest

from statehtn.errors import InputError
from statehtn.hddl import HddlWarning, read_hddl_text, write_hddl
from statehtn.hddl.diagnostics import MAX_WARNINGS
from statehtn.hddl.typed_lists import MAX_TYPES
from statehtn.model import (
    TRUE,
    And,
    Atom,
    Effect,
    Equals,
    Exists,
    Forall,
    Not,
    OfType,
    Or,
    Parameter,
    Problem,
    Signature,
)

EMPTY_PROBLEM = "(define (problem p) (:domain d) (:htn :subtasks ()))"
NETWORK = "(:task t) (:action a) (:method m :task (t) :subtasks (and (x (a)) (y (a)) (z (a)))"


def read(sections: str, problem: str = EMPTY_PROBLEM) -> Problem:
    """Read without a warning."""
    return read_hddl_text(f"(define (domain d) {sections})", problem, strict=True)


def read_sloppy(sections: str, message: str, problem: str = EMPTY_PROBLEM) -> Problem:
    """Read with one warning, which strict reading turns into an error."""
    domain = f"(define (domain d) {sections})"
    with pytest.warns(HddlWarning) as caught:
        found = read_hddl_text(domain, problem)
    assert [str(warning.message)[: len(message)] for warning in caught] == [message]
    with pytest.raises(InputError) as error:
        read_hddl_text(domain, problem, strict=True)
    assert str(error.value) == str(caught[0].message)
    assert read_hddl_text(*write_hddl(found), strict=True) == found
    return found


# --- types and objects


def test_untyped_predicates_functions_and_parameters() -> None:
    domain = read(
        "(:types t) (:predicates (p ?x ?y) (q ?x - t ?y)) (:functions (f ?x) (g ?y - t) - number (total-cost)) "
        "(:constants c) (:task u :parameters (?x)) (:action a :parameters (?x ?y - t ?z))"
    ).domain
    anything, t = ("object",), ("t",)
    assert domain.predicates["p"] == Signature("p", (Parameter("?x", anything), Parameter("?y", anything)))
    assert domain.predicates["q"] == Signature("q", (Parameter("?x", t), Parameter("?y", anything)))
    assert domain.functions["f"] == Signature("f", (Parameter("?x", anything),))
    assert domain.constants == {"c": "object"}
    assert domain.actions["a"].parameters == (Parameter("?x", t), Parameter("?y", t), Parameter("?z", anything))


def test_a_dash_without_a_space_before_its_type() -> None:
    """As in the competition's Ultralight-Cockpit."""
    domain = read_sloppy(
        "(:types a) (:task t :parameters (?x -a ?y - a))", "domain:1:56: expected a space after '-', found '-a'"
    ).domain
    assert domain.tasks["t"].parameters == (Parameter("?x", ("a",)), Parameter("?y", ("a",)))
    read_sloppy("(:functions (f) -number)", "domain:1:36: expected a space after '-', found '-number'")


@pytest.mark.filterwarnings("ignore::statehtn.hddl.HddlWarning")
def test_a_type_after_a_dash_must_be_declared() -> None:
    with pytest.raises(InputError, match=r"domain:1:45: unknown type 'b'"):
        read_hddl_text("(define (domain d) (:types a) (:constants c -b))", EMPTY_PROBLEM)


def test_either_inside_either() -> None:
    domain = read_sloppy(
        "(:types a b c) (:predicates (p ?x - (either a (either b c))))", "domain:1:66: 'either' inside 'either'"
    ).domain
    assert domain.predicates["p"].parameters == (Parameter("?x", ("a", "b", "c")),)


def test_a_type_that_is_declared_twice_has_both_supertypes() -> None:
    types = read(
        "(:types a b - object c - a c - b) (:constants k - c) (:predicates (p ?x - a) (q ?x - b))"
    ).domain.types
    assert types.parents["c"] == ("a", "b")


def test_an_object_of_several_types_is_of_all_of_them() -> None:
    """As in the feature tests of pandaPI; the type that joins them is made up."""
    problem = read_sloppy(
        "(:types a b c) (:predicates (p ?x - a ?y - b))",
        "problem:1:37: object 'k' is of type 'a' already, and now of type 'b', too",
        "(define (problem p) (:objects k - a k - b) (:init (p k k)) (:htn))",
    )
    assert problem.objects == {"k": "a+b"}
    assert problem.objects_of(("a",)) == problem.objects_of(("b",)) == ("k",)
    assert problem.objects_of(("c",)) == ()


@pytest.mark.parametrize("objects", ["k - low k - high", "k - high k - low"])
def test_an_object_of_a_type_and_its_supertype_is_of_the_lower_one(objects: str) -> None:
    problem = f"(define (problem p) (:objects {objects}) (:htn))"
    assert read_sloppy("(:types low - high)", "problem:1:", problem).objects == {"k": "low"}


def test_a_constant_may_get_another_type_from_the_problem() -> None:
    problem = "(define (problem p) (:objects k - b) (:htn))"
    found = read_sloppy("(:types a b a+b) (:constants k - a)", "problem:1:31: object 'k' is of type 'a'", problem)
    assert (found.objects, found.domain.constants) == ({}, {"k": "a+b+"})  # 'a+b' is another type


@pytest.mark.filterwarnings("ignore::statehtn.hddl.HddlWarning")
def test_the_types_of_an_object_are_limited() -> None:
    types = [f"t{index}" for index in range(MAX_TYPES + 2)]
    problem = f"(define (problem p) (:objects {' '.join(f'k - {kind}' for kind in types)}) (:htn))"
    with pytest.raises(InputError, match="declared with more than"):
        read_hddl_text(f"(define (domain d) (:types {' '.join(types)}))", problem)


def test_an_object_of_the_problem_in_the_domain() -> None:
    """As in a test of pandaPIparser: the domain should have declared it as a constant."""
    problem = "(define (problem p) (:objects k l - a) (:init (p k)) (:htn :subtasks (t l)))"
    found = read_sloppy(
        "(:types a) (:predicates (p ?x - a)) (:task t :parameters (?x - a)) "
        "(:method m :task (t k) :precondition (and (p k) (not (= k k))))",
        "domain:1:107: 'k' is an object of the problem, not a constant of the domain",
        problem,
    )
    assert (found.objects, found.domain.constants) == ({"l": "a"}, {"k": "a"})
    method = "(:task t) (:method m :precondition (= k k) :task (t))"
    with pytest.raises(InputError, match=r"domain:1:58: unknown object 'k'$"):
        read(method, "(define (problem p) (:objects kk - object) (:htn))")
    with pytest.raises(InputError, match=r"problem:1:33: expected a type after '-'"):
        read(method, "(define (problem p) (:objects k - ) (:htn))")


@pytest.mark.filterwarnings("ignore::statehtn.hddl.HddlWarning")
def test_the_domain_may_name_an_object_with_several_types() -> None:
    """The type that is made up for it stands in the domain."""
    method = "(:task t) (:method m :task (t) :precondition (and (p k) (q k)))"
    found = read_hddl_text(
        f"(define (domain d) (:types a b) (:predicates (p ?x - a) (q ?x - b)) {method})",
        "(define (problem p) (:objects k - a k - b) (:init (p k) (q k)) (:htn))",
    )
    assert (found.objects, found.domain.constants) == ({}, {"k": "a+b"})
    assert found.domain.types.supertypes("a+b") == {"a+b", "a", "b", "object"}


# --- declarations


@pytest.mark.parametrize(
    ("sections", "message"),
    [
        ("(:predicates (p ?x) (p ?x))", "domain:1:41: predicate 'p' is declared again"),
        ("(:functions (f ?x) (f ?x))", "domain:1:40: function 'f' is declared again"),
        ("(:types a) (:types b)", "domain:1:31: a second section ':types'"),
        ("(:task t :precondition (p) :effect ())", "domain:1:43: ':precondition' of a compound task means nothing"),
        ("(:task t :effect (and (p) (q)))", "domain:1:37: ':effect' of a compound task means nothing"),
        (f"{NETWORK} :causal-links (x (p) y))", "domain:1:117: causal links are not a part of HTN planning"),
        (f"{NETWORK} :causallinks (and (x (p) y)))", "domain:1:116: causal links are not a part of HTN planning"),
    ],
)
def test_what_is_read_with_a_warning(sections: str, message: str) -> None:
    read_sloppy(sections, message)


def test_what_says_nothing_gives_no_warning() -> None:
    domain = read(
        "(:types) (:constants) (:predicates) (:functions) (:requirements) (:task t :parameters () :precondition () "
        ":effect (and)) (:action a :parameters () :precondition (and) :effect (and ())) (:method m :parameters () "
        ":task (t) :precondition (and ()) :effect (and) :subtasks () :ordering () :constraints (and ()) "
        ":causal-links ())",
        "(define (problem p) (:domain d) (:requirements) (:objects) (:htn :parameters () :subtasks (and)) (:init) "
        "(:goal (and)))",
    ).domain
    assert domain.actions["a"].effects == ()
    assert domain.methods["m"].precondition == And((TRUE,))


def test_many_warnings_are_counted_only() -> None:
    slips = " ".join(f"c{index} -a" for index in range(MAX_WARNINGS + 3))
    with pytest.warns(HddlWarning) as caught:
        read_hddl_text(f"(define (domain d) (:types a) (:constants {slips}))", EMPTY_PROBLEM)
    assert len(caught) == MAX_WARNINGS + 1
    assert str(caught[-1].message) == "3 more warnings are left out"


# --- methods and networks


@pytest.mark.parametrize(
    "order",
    ["(< x y) (< y z)", "(x < y) (y < z)", "(> y x) (z > y)", "(< x y) (< y z) ()"],
)
def test_forms_of_order(order: str) -> None:
    assert read(f"{NETWORK} :ordering (and {order}))").domain.methods["m"].network.ordering == ((0, 1), (1, 2))


@pytest.mark.parametrize("order", ["(<x y)", "(x<y)", "(x <y)", "(x< y)", "(y>x)", "(>y x)"])
def test_orders_without_spaces(order: str) -> None:
    method = read_sloppy(f"{NETWORK} :ordering {order})", "domain:1:113: expected '(< <label> <label>)' with spaces")
    assert method.domain.methods["m"].network.ordering == ((0, 1),)


@pytest.mark.parametrize("order", ["(<xy)", "(< x y z)", "(x y <)", "(< < x)", "(x<y<z)", "(< x)", "(<)", "(x = y)"])
def test_orders_that_are_wrong(order: str) -> None:
    with pytest.raises(InputError, match=r"domain:1:113: expected '\(< <label> <label>\)', found"):
        read(f"{NETWORK} :ordering {order})")


@pytest.mark.parametrize("labels", ['"a"', "'b'", "[c]", "1", "T-1", "<x>", "t.1", "x|y", "#", "and", "task0"])
def test_labels_may_be_any_word(labels: str) -> None:
    network = (
        read(
            f"(:task t) (:action a) (:method m :task (t) :tasks (and ({labels} (a)) (last (a)) (a)) "
            f":order (and ({labels} < last)))"
        )
        .domain.methods["m"]
        .network
    )
    assert network.ordering == ((0, 1),)
    assert network.subtasks[0].label == labels
    assert len({subtask.label for subtask in network.subtasks}) == 3


def test_constraints_on_sorts_and_variables() -> None:
    formula = (
        "(and () (not (= ?x ?y)) (= ?x k) (sortof ?x - a) (typeof ?y - b) (sort ?x - (either a b)) "
        "(not (sortof ?y - a)) (or (= ?x ?y) (and)))"
    )
    expected = And((
        TRUE,
        Not(Equals("?x", "?y")),
        Equals("?x", "k"),
        OfType("?x", ("a",)),
        OfType("?y", ("b",)),
        OfType("?x", ("a", "b")),
        Not(OfType("?y", ("a",))),
        Or((Equals("?x", "?y"), TRUE)),
    ))  # fmt: skip
    domain = read(
        f"(:types a b) (:constants k - a) (:task t) "
        f"(:method m :parameters (?x ?y) :task (t) :subtasks () :constraints {formula}) "
        f"(:method n :parameters (?x ?y) :task (t) :precondition {formula})"
    ).domain
    assert domain.methods["m"].network.constraints == expected
    assert domain.methods["n"].precondition == expected


def test_methods_without_parameters_and_constants_in_their_task() -> None:
    method = read(
        "(:constants k l) (:task t :parameters (?x ?y)) (:action a :parameters (?x)) "
        "(:method m :task (t k l) :ordered-subtasks (a k))"
    ).domain.methods["m"]
    assert (method.parameters, method.arguments) == ((), ("k", "l"))
    assert method.network.subtasks[0].arguments == ("k",)


# --- effects


def test_a_quantified_effect_may_use_the_name_of_a_parameter() -> None:
    """The inner variable gets another name: conditions of both would become one."""
    action = read(
        "(:types a) (:predicates (p ?x) (q ?x)) (:action b :parameters (?x ?x_1) "
        ":effect (when (p ?x) (forall (?x - a) (when (exists (?x) (q ?x)) (and (q ?x) (not (p ?x_1)))))))"
    ).domain.actions["b"]
    bound = (Parameter("?x_2", ("a",)),)
    condition = And((Atom("p", ("?x",)), Exists((Parameter("?x_2"),), Atom("q", ("?x_2",)))))
    assert action.effects == (
        Effect(Atom("q", ("?x_2",)), True, condition, bound),
        Effect(Atom("p", ("?x_1",)), False, condition, bound),
    )


# --- the problem


def test_an_and_around_the_facts() -> None:
    problem = "(define (problem p) (:htn) (:init (and (p) (not (q)) (= (f) 2)) (r)))"
    found = read_sloppy("(:predicates (p) (q) (r)) (:functions (f))", "problem:1:35: the facts of ':init'", problem)
    assert found.initial_state == {("p",), ("r",)}
    assert found.function_values == {("f",): 2}


def test_goals_with_quantifiers_and_implications() -> None:
    goal = read(
        "(:predicates (p ?x) (q))",
        "(define (problem p) (:htn) (:goal (and () (or (q) (not (q))) (imply (q) (forall (?x) (p ?x))))))",
    ).goal
    q = Atom("q")
    everywhere = Forall((Parameter("?x"),), Atom("p", ("?x",)))
    assert goal == And((TRUE, Or((q, Not(q))), Or((Not(q), everywhere))))
