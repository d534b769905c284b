"""Quantifiers: how they are pushed inside, joined and dropped must not change what is true.

A condition with nested quantifiers over several variables, some of which it does not mention, some of a type without
objects, stands in an action, in a method, or before a conditional effect. There is a plan exactly if the condition is
true in the initial state or in one that a single change leads to.
"""

from __future__ import annotations

import itertools

from hypothesis import given, target
from hypothesis import strategies as st

from statehtn import plan
from statehtn.hddl.reader import read_hddl_text
from tests.naive_semantics import Semantics
from tests.strategies import Draw, pick

TYPES = ("big", "small", "none")
OBJECTS = {"big": ("a", "b", "c"), "small": ("s",), "none": ()}
FACTS = [f"(p {x})" for x in "abcs"] + [f"(q {x} {y})" for x, y in itertools.product("abcs", repeat=2)]
CHANGES = ("add-p", "del-p", "add-q", "del-q")


@st.composite
def conditions(draw: Draw, scope: tuple[str, ...] = (), depth: int = 4) -> str:
    """A condition as HDDL; every name of a variable is used once."""
    kinds = ["p", "q", "not p", "not q", "="] if scope else []
    if depth > 0 or not scope:
        kinds += ["exists", "forall"]
    if depth > 0:
        kinds += ["and", "or", "not", "exists", "forall"]
    kind = pick(draw, kinds)
    deeper = conditions(scope, depth - 1)
    if kind in ("and", "or"):
        return f"({kind} {' '.join(draw(st.lists(deeper, min_size=2, max_size=3)))})"
    if kind == "not":
        return f"(not {draw(deeper)})"
    if kind in ("exists", "forall"):
        types = draw(st.lists(st.sampled_from(("big", "big", "small", "none")), min_size=1, max_size=3))
        names = [f"?v{len(scope) + at}" for at in range(len(types))]
        bound = " ".join(f"{name} - {type_}" for name, type_ in zip(names, types, strict=True))
        return f"({kind} ({bound}) {draw(conditions((*scope, *names), depth - 1))})"
    term = st.sampled_from(scope)
    atom = f"(p {draw(term)})" if kind.endswith("p") else f"({kind[-1]} {draw(term)} {draw(term)})"
    return f"(not {atom})" if kind.startswith("not ") else atom


@given(
    conditions(),
    st.sampled_from(("action", "method", "effect")),
    st.sets(st.sampled_from(FACTS)),
    st.sampled_from(CHANGES),
)
def test_a_condition_is_met_exactly_where_it_is_true(condition: str, where: str, init: set[str], change: str) -> None:
    wanted = dict.fromkeys(("action", "method", "effect"), "()") | {where: condition}
    effect = f"(when {condition} (seen))" if where == "effect" else "(seen)"
    kind, predicate = change.split("-")
    variables = "?x" if predicate == "p" else "?x ?y"
    fact = f"({predicate} {variables})"
    domain = f"""(define (domain d)
      (:types big small none - object)
      (:predicates (p ?x - object) (q ?x ?y - object) (seen))
      (:task maybe :parameters ())
      (:task look :parameters ())
      (:method no :parameters () :task (maybe) :ordered-subtasks ())
      (:method yes :parameters ({variables} - object) :task (maybe) :ordered-subtasks (change {variables}))
      (:method m :parameters () :task (look) :precondition {wanted["method"]} :ordered-subtasks (see))
      (:action change :parameters ({variables} - object) :effect {fact if kind == "add" else f"(not {fact})"})
      (:action see :parameters () :precondition {wanted["action"]} :effect {effect}))"""
    objects = " ".join(f"{' '.join(names)} - {type_}" for type_, names in OBJECTS.items() if names)
    problem = read_hddl_text(
        domain,
        f"""(define (problem p) (:domain d) (:objects {objects})
          (:htn :ordered-subtasks (and (maybe) (look))) (:init {" ".join(sorted(init))}) (:goal (seen)))""",
    )
    semantics = Semantics(problem)
    see, look = problem.domain.actions["see"], problem.domain.methods["m"]
    formula = {"action": see.precondition, "method": look.precondition, "effect": see.effects[0].condition}[where]
    arguments = itertools.product("abcs", repeat=1 if predicate == "p" else 2)
    states = [problem.initial_state, *(semantics.execute("change", one, problem.initial_state) for one in arguments)]
    is_possible = any(semantics.holds(formula, {}, state) for state in states if state is not None)
    target(float(condition.count("exists") + condition.count("forall")))
    assert (plan(problem).plan is not None) == is_possible
