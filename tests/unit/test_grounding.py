"""Grounding: what is instantiated, what is compiled away, and what is pruned."""

from __future__ import annotations

import itertools

import pytest

from statehtn.core.grounding import PLAIN, Grounding, ground
from statehtn.errors import UnsupportedError
from statehtn.hddl.reader import read_hddl_text
from statehtn.limits import LimitReached, Limits, resident_mb
from statehtn.model import GroundAction, GroundProblem, Problem
from statehtn.model.cost.probabilities import CostWarning
from statehtn.model.status import Status

CONSTANTS = "(:constants l0 l1 l2 - place)"
PREDICATES = "(:predicates (at ?l - place) (road ?a ?b - place) (wet ?l - place) (done))"
FUNCTIONS = "(:functions (total-cost) (length ?a ?b - place))"


def problem(domain: str, network: str = "(go)", init: str = "(at l0)", goal: str = "", places: int = 3) -> Problem:
    more = " ".join(f"l{i} - place" for i in range(3, places))
    ending = f"(:goal {goal})" if goal else ""
    return read_hddl_text(
        f"(define (domain d) (:types place) {CONSTANTS} {PREDICATES} {FUNCTIONS} {domain})",
        f"(define (problem p) (:domain d) (:objects {more}) (:htn :subtasks (and {network})) (:init {init}) {ending})",
    )


def model(*arguments: str, **more: object) -> GroundProblem:
    return ground(problem(*arguments, **more), switches=PLAIN).to_model()


def actions(found: GroundProblem) -> list[tuple[str, ...]]:
    return sorted((action.name, *action.arguments) for action in found.actions)


def named(found: GroundProblem, name: str) -> list[GroundAction]:
    return [action for action in found.actions if action.name == name]


def facts(found: GroundProblem, numbers: frozenset[int]) -> set[tuple[str, ...]]:
    return {found.facts[number] for number in numbers}


MOVE = """
  (:action move :parameters (?a ?b - place) :precondition (and (at ?a) (road ?a ?b))
    :effect (and (at ?b) (not (at ?a))))
"""
ROADS = "(at l0) (road l0 l1) (road l1 l2)"
TRAVEL = f"""
  (:task go :parameters ())
  (:method step :parameters (?a ?b - place) :task (go) :ordered-subtasks (and (move ?a ?b) (go)))
  (:method stop :parameters () :task (go) :precondition (at l2) :ordered-subtasks (and))
  {MOVE}
"""


def test_only_reachable_actions_and_static_facts_compiled_away() -> None:
    found = model(TRAVEL, init=ROADS)
    assert actions(found) == [("move", "l0", "l1"), ("move", "l1", "l2"), ("precondition of stop",)]
    assert set(found.facts) == {("at", "l0"), ("at", "l1"), ("at", "l2")}
    first = named(found, "move")[0]
    assert facts(found, first.precondition) == {("at", "l0")}
    assert facts(found, first.effects[0].added) == {("at", "l1")}
    assert facts(found, first.effects[0].deleted) == {("at", "l0")}
    assert facts(found, found.initial_state) == {("at", "l0")}


def test_unsolvable_without_a_road() -> None:
    grounding = ground(problem(TRAVEL, init="(at l0) (road l1 l2)"))
    assert not grounding.handle.solvable
    assert (grounding.fact_count, grounding.action_count, grounding.method_count) == (0, 0, 0)


def test_unsolvable_recursion_without_end() -> None:
    endless = "(:task go :parameters ()) (:method again :parameters () :task (go) :subtasks (and (rest) (go)))"
    assert not ground(problem(endless + "(:action rest :parameters () :effect (done))")).handle.solvable


def test_unsolvable_goal() -> None:
    domain = "(:task go :parameters ()) (:method none :parameters () :task (go) :subtasks (and))" + MOVE
    assert not ground(problem(domain, init=ROADS, goal="(at l2)")).handle.solvable
    assert ground(problem(domain, init=ROADS, goal="(at l0)")).handle.solvable


def test_facts_only_reachable_through_dropped_actions_vanish() -> None:
    domain = """
      (:task go :parameters ())
      (:task other :parameters ())
      (:method dry :parameters () :task (go) :subtasks (and (walk)))
      (:method swim :parameters () :task (go) :subtasks (and (swim)))
      (:method rain :parameters () :task (other) :subtasks (and (rain)))
      (:action walk :parameters () :precondition (not (wet l0)) :effect (done))
      (:action swim :parameters () :precondition (wet l0) :effect (done))
      (:action rain :parameters () :effect (wet l0))
    """
    found = model(domain)
    assert actions(found) == [("walk",)]
    assert found.facts == ()
    assert actions(model(domain, network="(go) (other)")) == [("rain",), ("swim",), ("walk",)]


def test_method_precondition_first_and_goal_last() -> None:
    domain = f"""
      (:task go :parameters ())
      (:method hop :parameters (?a ?b - place) :task (go)
        :precondition (and (at ?a) (not (wet ?b))) :subtasks (and (splash) (move ?a ?b)))
      (:action splash :parameters () :effect (and (wet l1) (not (wet l2)) (done)))
      {MOVE}
    """
    found = model(domain, init=ROADS, goal="(at l1)")
    initial = found.methods[found.methods_of[found.initial_task][0]]
    assert [found.is_primitive(task) for task in initial.subtasks] == [False, True]
    assert found.actions[initial.subtasks[1]].name == "goal"
    assert initial.ordering == ((0, 1),)
    hop = next(method for method in found.methods if method.arguments == ("l0", "l1"))
    names = [found.actions[task].name for task in hop.subtasks]
    assert names == ["precondition of hop", "splash", "move"]
    assert hop.ordering == ((0, 1), (0, 2))
    action = found.actions[hop.subtasks[0]]
    assert action.is_precondition
    assert not action.effects
    assert facts(found, action.negative_precondition) == {("wet", "l1")}


def test_order_through_a_precondition_that_is_always_true_is_kept() -> None:
    domain = """
      (:task go :parameters ())
      (:method hop :parameters () :task (go) :precondition (road l0 l1) :ordered-subtasks (and (one) (two) (three)))
      (:action one :parameters () :effect (done))
      (:action two :parameters () :precondition (done))
      (:action three :parameters () :effect (not (done)))
    """
    hop = next(method for method in model(domain, init=ROADS).methods if method.name == "hop")
    assert len(hop.subtasks) == 3
    assert hop.ordering == ((0, 1), (0, 2), (1, 2))


def test_disjunctive_precondition_becomes_a_choice() -> None:
    domain = """
      (:task go :parameters ())
      (:method try :parameters () :task (go) :ordered-subtasks (and (rain) (cross)))
      (:method trudge :parameters () :task (go) :ordered-subtasks (and (dry) (cross)))
      (:action rain :parameters () :effect (and (wet l0) (not (wet l1))))
      (:action dry :parameters () :effect (and (wet l1) (not (wet l0))))
      (:action cross :parameters () :precondition (or (wet l0) (not (wet l1)) (road l1 l0)) :effect (done))
    """
    found = model(domain, goal="(done)")
    cases = named(found, "cross")
    assert sorted((len(case.precondition), len(case.negative_precondition)) for case in cases) == [(0, 1), (1, 0)]
    choice = len(found.actions) + found.tasks.index(("cross",))
    assert {found.methods[method].subtasks for method in found.methods_of[choice]} == {
        (found.actions.index(case),) for case in cases
    }
    assert len(named(model(domain, init="(road l1 l0)"), "cross")) == 1


def test_state_dependent_cost_is_parts_of_one_action() -> None:
    domain = """
      (:task go :parameters ())
      (:method dry :parameters () :task (go) :subtasks (and (walk)))
      (:method rain :parameters () :task (go) :ordered-subtasks (and (rain) (walk)))
      (:action rain :parameters () :effect (wet l0))
      (:action walk :parameters () :effect (and (increase (total-cost) 2) (when (wet l0) (increase (total-cost) 3))
        (forall (?l - place) (when (road l0 ?l) (increase (total-cost) 10)))))
    """
    found = model(domain, init="(road l0 l1)")
    (walk,) = named(found, "walk")
    (wet,) = [number for number, fact in enumerate(found.facts) if fact == ("wet", "l0")]
    assert walk.cost.mean == 12
    assert [(part.alternatives, part.cost.mean) for part in walk.cost_parts] == [
        (((frozenset({wet}), frozenset()),), 3.0)
    ]


def test_conditions_of_costs_are_simplified() -> None:
    domain = """
      (:task go :parameters ())
      (:method all :parameters () :task (go) :ordered-subtasks (and (rain) (walk) (dry) (walk) (soak)))
      (:action rain :parameters () :effect (and (wet l0) (wet l1)))
      (:action dry :parameters () :effect (not (wet l1)))
      (:action walk :parameters () :precondition (wet l0) :effect (and (done)
        (when (not (wet l0)) (increase (total-cost) 1))
        (when (and (wet l0) (wet l1)) (increase (total-cost) 2))
        (when (exists (?l - place) (wet ?l)) (increase (total-cost) 4))
        (when (at l0) (increase (total-cost) 8))
        (forall (?l - place) (when (or (wet l1) (road ?l ?l)) (increase (total-cost) 16)))))
      (:action soak :parameters () :precondition (done) :effect (forall (?l - place) (increase (total-cost) 1)))
    """
    found = model(domain, init="(road l2 l2)")
    (walk,), (soak,) = named(found, "walk"), named(found, "soak")
    (wet,) = [number for number, fact in enumerate(found.facts) if fact == ("wet", "l1")]
    assert walk.cost.mean == 4 + 16
    assert [part.alternatives for part in walk.cost_parts] == [((frozenset({wet}), frozenset()),)]
    assert walk.cost_parts[0].cost.mean == 2 + 2 * 16
    assert (soak.cost.mean, soak.cost_parts) == (3, ())


def test_conditional_and_universal_effects() -> None:
    domain = """
      (:task go :parameters ())
      (:method all :parameters () :task (go) :ordered-subtasks (and (rain) (dry l1) (look l2)))
      (:action rain :parameters () :effect (forall (?l - place) (when (road l0 ?l) (wet ?l))))
      (:action dry :parameters (?l - place) :effect (when (at ?l) (not (wet ?l))))
      (:action look :parameters (?l - place) :precondition (and (wet ?l) (wet l1)) :effect (at l1))
    """
    found = model(domain, init="(road l0 l1) (road l0 l2)")
    (rain,), (dry,) = named(found, "rain"), named(found, "dry")
    assert [facts(found, effect.added) for effect in rain.effects] == [{("wet", "l1"), ("wet", "l2")}]
    assert not rain.effects[0].condition
    assert [facts(found, effect.condition) for effect in dry.effects] == [{("at", "l1")}]
    assert [facts(found, effect.deleted) for effect in dry.effects] == [{("wet", "l1")}]


def test_constraints_and_parameters_of_the_initial_network() -> None:
    domain = """
      (:task go :parameters ())
      (:method hop :parameters (?a ?b ?c - place) :task (go) :subtasks (and (visit ?a) (visit ?b) (visit ?c))
        :constraints (and (not (= ?a ?b)) (= ?c l2) (= ?a l0)))
      (:action visit :parameters (?l - place) :effect (at ?l))
    """
    hops = [method.arguments for method in model(domain).methods if method.name == "hop"]
    assert sorted(hops) == [("l0", "l1", "l2"), ("l0", "l2", "l2")]
    text = f"(define (domain d) (:types place) {CONSTANTS} {PREDICATES} {domain})"
    network = "(:htn :parameters (?x - place) :subtasks (and (visit ?x)) :constraints (not (= ?x l1)))"
    read = read_hddl_text(text, f"(define (problem p) (:domain d) {network} (:init))")
    assert actions(ground(read, switches=PLAIN).to_model()) == [("visit", "l0"), ("visit", "l2")]


def test_undefined_function_value_matters_only_where_it_is_reachable() -> None:
    domain = TRAVEL.replace("(not (at ?a))", "(not (at ?a)) (increase (total-cost) (length ?a ?b))")
    values = "(= (length l0 l1) 4) (= (length l1 l2) 2.5)"
    found = model(domain, init=f"{ROADS} {values}")
    assert sorted(action.cost.mean for action in named(found, "move")) == [2.5, 4.0]
    with pytest.warns(CostWarning, match="length l1 l2"):
        found = model(domain, init=f"{ROADS} (= (length l0 l1) 4)")
    assert sorted(action.cost.mean for action in named(found, "move")) == [0.0, 4.0]


def chain(parameters: int) -> str:
    names = [f"?x{i}" for i in range(parameters)]
    roads = " ".join(f"(road {a} {b})" for a, b in itertools.pairwise(names))
    return f"""
      (:task go :parameters ())
      (:method way :parameters ({" ".join(names)} - place) :task (go) :precondition (and {roads} (at ?x0))
        :subtasks (and (visit {names[-1]})))
      (:action visit :parameters (?l - place) :effect (done))
    """


def test_many_parameters_are_joined_not_enumerated() -> None:
    places = 400
    roads = " ".join(f"(road l{i} l{i + 1})" for i in range(places - 1))
    ways = problem(chain(10), init=f"(at l0) {roads}", places=places)
    found = ground(ways, Limits.starting_now(120), switches=PLAIN).to_model()  # 400^10 tuples take years
    assert actions(found) == [("visit", "l9")]


@pytest.mark.parametrize(
    ("precondition", "cost"),
    [
        ("(forall (?l - place) (or (wet ?l) (at ?l)))", ""),
        ("(done)", "(when (forall (?l - place) (or (wet ?l) (at ?l))) (increase (total-cost) 1))"),
    ],
)
def test_too_many_cases_are_refused_at_once(precondition: str, cost: str) -> None:
    domain = f"""
      (:task go :parameters ())
      (:method more :parameters (?l - place) :task (go) :subtasks (and (flood ?l) (dry ?l) (go)))
      (:method end :parameters () :task (go) :subtasks (and (cross)))
      (:action flood :parameters (?l - place) :effect (and (wet ?l) (at ?l) (done)))
      (:action dry :parameters (?l - place) :effect (and (not (wet ?l)) (not (at ?l))))
      (:action cross :parameters () :precondition {precondition} :effect (and (done) {cost}))
    """
    with pytest.raises(UnsupportedError, match="cross"):
        ground(problem(domain, init="", places=40), Limits.starting_now(120))  # 2^40 cases take hours
    assert ground(problem(domain, init="", places=4)).handle.solvable


def large() -> Problem:
    domain = """
      (:task go :parameters ())
      (:method all :parameters (?a ?b ?c - place) :task (go) :subtasks (and (visit ?a ?b ?c)))
      (:action visit :parameters (?a ?b ?c - place) :effect (done))
    """
    return problem(domain, places=150)


def test_limits() -> None:
    with pytest.raises(LimitReached) as stop:
        ground(large(), Limits.starting_now(time_limit=0.05))
    assert stop.value.status is Status.TIME_LIMIT
    with pytest.raises(LimitReached) as stop:
        ground(large(), Limits(memory_mb=1))
    assert stop.value.status is Status.MEMORY_LIMIT


def test_counts_are_the_domains_own() -> None:
    grounding: Grounding = ground(problem(TRAVEL, init=ROADS))
    assert (grounding.fact_count, grounding.action_count) == (3, 2)


@pytest.mark.parametrize("kind", ["exists", "forall"])
@pytest.mark.parametrize("place", ["action", "method", "effect"])
def test_quantified_variables_that_are_not_mentioned_need_no_loop(kind: str, place: str) -> None:
    nested = "".join(f"({kind} (?q{at} - place) " for at in range(60)) + "(wet ?q7)" + ")" * 60
    wanted = dict.fromkeys(("action", "method", "effect"), "()") | {place: nested}
    effect = f"(when {nested} (done))" if place == "effect" else "(done)"
    found = ground(
        problem(
            f"""(:task go :parameters ())
            (:method m :parameters () :task (go) :precondition {wanted["method"]} :ordered-subtasks (a))
            (:action dry :parameters (?l - place) :effect (not (wet ?l)))
            (:action a :parameters () :precondition {wanted["action"]} :effect {effect})""",
            init="(wet l0) (wet l1) (wet l2)",
            goal="(done)",
        )
    )
    assert found.handle.solvable


def test_quantifiers_over_many_objects_are_joined() -> None:
    """Plain loops would look at 10^9 combinations for each of 1000 actions."""
    found = ground(
        problem(
            """(:task go :parameters ())
            (:method m :parameters (?l - place) :task (go) :ordered-subtasks (a ?l))
            (:action dry :parameters (?l - place) :effect (not (wet ?l)))
            (:action a :parameters (?l - place)
              :precondition (and
                (exists (?x ?y ?z - place) (and (road ?x ?y) (road ?y ?z) (wet ?z)))
                (forall (?x ?y ?z - place) (imply (and (road ?x ?y) (road ?y ?z)) (wet ?z))))
              :effect (not (wet ?l)))""",
            init="(road l0 l1) (road l1 l2) (wet l2)",
            places=1000,
        )
    )
    assert found.handle.action_count == 1000


def test_a_limit_holds_in_loops_over_quantified_variables() -> None:
    pairs = " ".join(f"(not (road ?q{at} ?q{at + 1}))" for at in range(9))
    variables = " ".join(f"?q{at}" for at in range(10))
    roads = " ".join(f"(road l{a} l{b})" for a in range(30) for b in range(30))
    lifted = problem(
        f"(:action go :parameters () :precondition (forall ({variables} - place) (or {pairs} (wet ?q0) (wet ?q9))))",
        init=roads + " ".join(f"(wet l{at})" for at in range(30)),
        places=30,
    )
    with pytest.raises(LimitReached) as reached:
        ground(lifted, Limits.starting_now(0.2))
    assert reached.value.status is Status.TIME_LIMIT


def wide(parameters: int) -> Problem:
    """One action with so many parameters, and one instance of it."""
    variables, objects = " ".join(f"?x{at}" for at in range(parameters)), " ".join(["o"] * parameters)
    return read_hddl_text(
        f"""(define (domain d) (:types thing) (:predicates (p {variables} - thing) (done))
          (:action a :parameters ({variables} - thing) :precondition (p {variables}) :effect (done)))""",
        f"""(define (problem p) (:domain d) (:objects o u - thing) (:htn :ordered-subtasks (a {objects}))
          (:init (p {objects})))""",
    )


def test_memory_does_not_grow_with_the_square_of_the_parameters() -> None:
    """Pairs of 800 parameters would take more than 2 GB."""
    found = ground(wide(800), Limits(memory_mb=resident_mb() + 300))
    assert found.handle.action_count == 1


def test_a_task_that_stands_in_a_method_many_times_is_joined_once() -> None:
    """Planning a join for each of 1200 equal subtasks, of which each is as good as the others, takes a minute."""
    lifted = problem(
        f"""(:task go :parameters ())
        (:method again :parameters () :task (go) :ordered-subtasks (and {"(go) " * 1200}))
        (:method none :parameters () :task (go) :ordered-subtasks ())"""
    )
    assert ground(lifted, Limits.starting_now(30)).handle.method_count == 3


def test_a_precondition_is_instantiated_only_for_what_fixed_facts_allow() -> None:
    """Each of 40 places may be wet: without the roads there would be 40^4 of them, in half a gigabyte."""
    places = range(40)
    lifted = problem(
        """(:task go :parameters ())
        (:method m :parameters (?a ?b ?c ?e ?f - place) :task (go)
          :precondition (and (road ?a ?b) (road ?b ?c) (road ?c ?e) (wet ?a) (wet ?b) (wet ?c) (wet ?e) (road ?e ?f))
          :ordered-subtasks (dry ?a))
        (:action dry :parameters (?l - place) :effect (not (wet ?l)))""",
        init=" ".join(f"(wet l{at})" for at in places) + " ".join(f"(road l{at} l{at + 1})" for at in places[:-1]),
        places=len(places),
    )
    found = ground(lifted, Limits(memory_mb=resident_mb() + 100))
    assert sum(schema is None for schema in map(found.encoding.actions.__getitem__, found.handle.action_schema)) == 36
