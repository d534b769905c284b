"""Pairs of facts that never hold together: compared with all states that can be reached, actions in any order."""

from __future__ import annotations

import itertools

import pytest
from hypothesis import assume, event, given
from hypothesis import strategies as st

import statehtn._relax as _relax
from statehtn import Problem, Status, read_hddl_text
from statehtn.core.grounding import GroundingSwitches, ground
from statehtn.core.search import find_plans
from statehtn.core.searches import SEARCHES
from statehtn.model import GroundProblem
from statehtn.risk import utility_for
from tests.brute_force import GaveUp
from tests.strategies import problems

MOST_STATES = 500


def reachable(model: GroundProblem) -> set[frozenset[int]]:
    seen = {model.initial_state}
    pending = list(seen)
    while pending:
        state = pending.pop()
        for action in model.actions:
            if action.is_applicable(state) and (after := action.apply(state)) not in seen:
                seen.add(after)
                pending.append(after)
        if len(seen) > MOST_STATES:
            raise GaveUp
    return seen


FACTS = [f"(p{index})" for index in range(4)]
LITERALS = [*FACTS, *(f"(not {fact})" for fact in FACTS)]


@st.composite
def machines(draw: st.DrawFn) -> Problem:
    """Few facts that change together, so that many pairs never hold together; actions come in any order."""
    conjunctions = st.lists(st.sampled_from(LITERALS), max_size=2, unique=True).map(" ".join)
    actions = []
    for index in range(draw(st.integers(1, 4))):
        effects = []
        for fact in draw(st.lists(st.sampled_from(FACTS), min_size=1, max_size=3, unique=True)):
            literal = draw(st.sampled_from([fact, f"(not {fact})"]))
            condition = draw(st.sampled_from(["", "", "", draw(conjunctions)]))
            effects.append(f"(when (and {condition}) {literal})" if condition else literal)
        needed, made = draw(conjunctions), " ".join(effects)
        actions.append(f"(:action a{index} :parameters () :precondition (and {needed}) :effect (and {made}))")
    methods = " ".join(
        f"(:method m{index} :parameters () :task (run) :ordered-subtasks (and (a{index}) (run)))"
        for index in range(len(actions))
    )
    domain = f"""(define (domain machine) (:predicates {" ".join(FACTS)}) (:task run :parameters ()) {methods}
        (:method stop :parameters () :task (run) :ordered-subtasks ()) {" ".join(actions)})"""
    initial = " ".join(draw(st.lists(st.sampled_from(FACTS), unique=True)))
    return read_hddl_text(domain, f"(define (problem p) (:domain machine) (:htn :subtasks (run)) (:init {initial}))")


@pytest.mark.filterwarnings("ignore:.*there is no plan")
@given(problem=machines() | problems())
def test_mutexes_never_hold_together(problem: Problem) -> None:
    grounding = ground(problem, switches=GroundingSwitches(mutexes=False))
    assume(grounding.handle.solvable)
    model = grounding.to_model()
    mutexes = _relax.Mutexes(grounding.handle)
    states = reachable(model)
    together: set[tuple[int, ...]] = set()
    for state in states:
        literals = [2 * fact + (fact not in state) for fact in range(len(model.facts))]
        together.update(itertools.combinations(literals, 2))
    pairs = [
        (one, other)
        for one, other in itertools.combinations(range(2 * len(model.facts)), 2)
        if one // 2 != other // 2 and mutexes.are_mutex(one, other)
    ]
    event(f"finds mutexes: {bool(pairs)}, with negated facts: {any(one % 2 or other % 2 for one, other in pairs)}")
    assert not together.intersection(pairs)
    for number, action in enumerate(model.actions):
        assert mutexes.is_possible(number) >= any(map(action.is_applicable, states))


# A boat is moored or at sea. Whoever is aboard at sea, is not ashore; the goal asks for both by a negation.
HARBOUR = """
(define (domain harbour)
  (:predicates (moored) (aboard) (ashore) (fished))
  (:task cruise :parameters ()) (:task trip :parameters ())
  (:method more :parameters () :task (cruise) :ordered-subtasks (and (trip) (cruise)))
  (:method home :parameters () :task (cruise) :ordered-subtasks ())
  (:method again :parameters () :task (trip) :ordered-subtasks (and (cruise) (trip)))
  (:method go :parameters () :task (trip) :ordered-subtasks (and (embark) (fish)))
  (:action embark :parameters () :effect (and (aboard) (not (ashore))))
  (:action fish :parameters () :precondition (aboard) :effect (fished)))
"""


@pytest.mark.parametrize("search", SEARCHES)
@pytest.mark.parametrize("goal", ["(ashore)", "(not (aboard))"])
def test_a_goal_that_contradicts_itself_is_found_at_once(search: str, goal: str) -> None:
    problem = f"""(define (problem p) (:domain harbour) (:htn :ordered-subtasks (cruise)) (:init (ashore) (moored))
        (:goal (and (fished) {goal})))"""
    grounding = ground(read_hddl_text(HARBOUR, problem))
    assert not grounding.handle.solvable
    outcome = find_plans(grounding, utility_for("neutral"), search=search, weight=2.0)
    assert outcome.status is Status.UNSOLVABLE


def test_what_an_action_without_preconditions_makes_may_hold_with_all_that_is_reached_later() -> None:
    """Whoever answers ends the ringing: that it rings again is known only if `ring` is looked at once more."""
    domain = """
    (define (domain telephone)
      (:predicates (ringing) (answered))
      (:action ring :parameters () :effect (ringing))
      (:action answer :parameters () :precondition (ringing) :effect (and (answered) (not (ringing)))))
    """
    problem = """(define (problem p) (:domain telephone) (:init) (:goal (and (ringing) (answered)))
        (:htn :ordered-subtasks (and (ring) (answer) (ring))))"""
    outcome = find_plans(ground(read_hddl_text(domain, problem)), utility_for("neutral"))
    assert outcome.status is Status.OPTIMAL


def test_actions_that_are_never_possible_are_left_out() -> None:
    domain = """
    (define (domain doors)
      (:types room)
      (:predicates (in ?r - room) (lit ?r - room))
      (:task visit :parameters (?r - room))
      (:method walk :parameters (?r ?s - room) :task (visit ?s) :ordered-subtasks (and (go ?r ?s)))
      (:method beam :parameters (?r ?s - room) :task (visit ?s) :ordered-subtasks (and (be-in-two-rooms ?r ?s)))
      (:action go :parameters (?r ?s - room) :precondition (in ?r) :effect (and (in ?s) (not (in ?r))))
      (:action be-in-two-rooms :parameters (?r ?s - room) :precondition (and (not (= ?r ?s)) (in ?r) (in ?s))))
    """
    problem = """(define (problem p) (:domain doors) (:objects a b c - room) (:init (in a))
        (:htn :ordered-subtasks (and (visit b) (visit c))))"""
    lifted = read_hddl_text(domain, problem)
    names = [
        {action.name for action in ground(lifted, switches=GroundingSwitches(mutexes=mutexes)).to_model().actions}
        for mutexes in (True, False)
    ]
    assert names[1] - names[0] == {"be-in-two-rooms"}
