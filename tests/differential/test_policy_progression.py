"""The decisions that the core leaves out are not needed: the best policy is worth the same as on the whole graph.

The whole graph comes from the lifted problem, by code that shares nothing with grounding and progression.
"""

from __future__ import annotations

from fractions import Fraction

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from statehtn import Problem, read_hddl_text
from statehtn.core.grounding import GroundingSwitches, ground
from tests.explicit_graph import ExplicitGraph, explicit_graph
from tests.explicit_memory import INFINITE, FailureCost, best_policy_with_memory
from tests.explicit_policies import best_policy
from tests.grounded_graph import grounded_graph
from tests.random_outcomes import chance_problems
from tests.shares import share_of_examples
from tests.strategies import between, pick

pytestmark = pytest.mark.filterwarnings("ignore:.*there is no plan")

EXAMPLES = 300  # each takes some milliseconds
LITERALS = ["(p)", "(not (p))", "(q)", "(not (q))"]
NAMES = ["a", "b", "c", "d"]
OBJECTIVES = st.sampled_from(["neutral", "averse 0.3", "seeking 0.7", "success"])
WITH_MEMORY = st.sampled_from(["deadline 2", "deadline 4", "deadline 6", "overrun 3", "quantile 0.5", "cvar 0.5"])
FAILURE_COSTS = st.sampled_from([None, None, Fraction(1), Fraction(4)])
SWITCHES = GroundingSwitches(split_methods=False)


@st.composite
def few_actions(draw: st.DrawFn) -> Problem:
    """Actions over two facts, some with outcomes, and choices between them, two or three of these in no order."""

    def effect(often: list[str]) -> str:
        literal = pick(draw, [*LITERALS, *often])
        cost = pick(draw, ["", "", "(increase (total-cost) 1)", "(increase (total-cost) 3)"])
        return f"(and {literal} {cost})"

    actions = []
    for number, name in enumerate(NAMES):
        effects = [pick(draw, ["", *LITERALS])]
        match pick(draw, ["certain", "uncertain cost", "outcomes", "outcomes"]):
            case "certain":
                effects.append(f"(increase (total-cost) {number})")
            case "uncertain cost":
                effects.append("(probabilistic 0.5 (increase (total-cost) 1) 0.5 (increase (total-cost) 4))")
            case _:
                effects.append(f"(probabilistic 0.5 {effect([])} 0.5 {effect(['', ''])})")
                effects.append(f"(increase (total-cost) {pick(draw, [0, 1, 2])})")
        if pick(draw, [False, False, False, True]):
            effects.append(f"(when {pick(draw, LITERALS)} (increase (total-cost) 2))")
        needed = pick(draw, ["", "", *LITERALS])
        actions.append(
            f"(:action {name} :parameters () :precondition (and {needed}) :effect (and {' '.join(effects)}))"
        )
    names = st.sampled_from(NAMES)
    methods = []
    for task in ("t", "u"):
        for number in range(between(draw, 1, 3)):
            subtasks = " ".join(f"({name})" for name in draw(st.lists(names, min_size=1, max_size=2)))
            order = pick(draw, [":subtasks", ":ordered-subtasks"])
            methods.append(
                f"(:method {task}{number} :parameters () :task ({task}) "
                f":precondition (and {pick(draw, ['', '', '', *LITERALS])}) {order} (and {subtasks}))"
            )
    first = draw(st.lists(st.sampled_from([*NAMES, "t", "u", "t", "u"]), min_size=2, max_size=3))
    network = " ".join(f"(s{number} ({task}))" for number, task in enumerate(first))
    order = pick(draw, ["", "", "(< s0 s1)"])
    goal = pick(draw, ["", "", "(p)", "(q)"])
    initial = pick(draw, ["", "(p)", "(q)", "(p) (q)"])
    return read_hddl_text(
        f"""(define (domain few) (:predicates (p) (q)) (:functions (total-cost))
        (:task t :parameters ()) (:task u :parameters ()) {" ".join(methods)} {" ".join(actions)})""",
        f"""(define (problem p) (:domain few)
        (:htn :parameters () :subtasks (and {network}) :ordering (and {order}))
        (:init {initial}) (:goal (and {goal})))""",
    )


@settings(max_examples=EXAMPLES)
@given(few_actions(), OBJECTIVES, FAILURE_COSTS)
def test_agents_that_look_at_outcomes_of_few_actions(
    problem: Problem, objective: str, failure_cost: Fraction | None
) -> None:
    check(problem, objective, failure_cost)


@settings(max_examples=EXAMPLES)
@given(few_actions(), WITH_MEMORY, st.one_of(FAILURE_COSTS, st.just(INFINITE)))
def test_agents_that_look_at_costs_of_few_actions(problem: Problem, objective: str, failure_cost: FailureCost) -> None:
    check_with_memory(problem, objective, failure_cost)


@share_of_examples(2)
@given(chance_problems(), OBJECTIVES, FAILURE_COSTS)
def test_agents_that_look_at_outcomes(problem: Problem, objective: str, failure_cost: Fraction | None) -> None:
    check(problem, objective, failure_cost)


@share_of_examples(2)
@given(chance_problems(), WITH_MEMORY, st.one_of(FAILURE_COSTS, st.just(INFINITE)))
def test_agents_that_look_at_costs(problem: Problem, objective: str, failure_cost: FailureCost) -> None:
    check_with_memory(problem, objective, failure_cost)


def check(problem: Problem, objective: str, failure_cost: Fraction | None) -> None:
    if objective == "success":
        failure_cost = None
    expected = best_policy(explicit_graph(problem), objective, failure_cost)
    found = best_policy(graph_of(problem, objective, failure_cost), objective, failure_cost)
    assert is_same(found.value, expected.value)
    assert is_same(found.expected_cost, expected.expected_cost)


def check_with_memory(problem: Problem, objective: str, failure_cost: FailureCost) -> None:
    if failure_cost == INFINITE and not objective.startswith(("deadline", "quantile")):
        failure_cost = None
    expected = best_policy_with_memory(explicit_graph(problem), objective, failure_cost)
    found = best_policy_with_memory(graph_of(problem, objective, failure_cost, True), objective, failure_cost)
    assert is_same(found.value, expected.value)


def graph_of(problem: Problem, objective: str, failure_cost: FailureCost, sees_costs: bool = False) -> ExplicitGraph:
    only_done = objective != "success" and failure_cost in {None, INFINITE}
    return grounded_graph(ground(problem, switches=SWITCHES), sees_costs, only_done_runs_pay=only_done)


def is_same(one: Fraction | None, other: Fraction | None) -> bool:
    return one is other is None or (one is not None and other is not None and abs(one - other) < Fraction(1, 10**9))


TWO_CHOICES = """(define (domain d) (:functions (total-cost))
    (:task c :parameters ()) (:task d :parameters ())
    (:method c1 :parameters () :task (c) :subtasks (c1)) (:method c2 :parameters () :task (c) :subtasks (c2))
    (:method d1 :parameters () :task (d) :subtasks (d1)) (:method d2 :parameters () :task (d) :subtasks (d2))
    (:action c1 :parameters () :effect (probabilistic 0.5 (increase (total-cost) 0) 0.5 (increase (total-cost) 6)))
    (:action c2 :parameters () :effect (increase (total-cost) 20))
    (:action d1 :parameters () :effect (increase (total-cost) 5))
    (:action d2 :parameters () :effect (probabilistic 0.5 (increase (total-cost) 0) 0.5 (increase (total-cost) 9))))"""


@pytest.mark.parametrize("tasks", ["(c) (d)", "(d) (c)"])
def test_a_choice_may_wait_for_a_cost_elsewhere(tasks: str) -> None:
    """Whether c costs 0 or 6 tells how to do d: late with probability 1/4, but 1/2 where d is decomposed first."""
    problem = read_hddl_text(TWO_CHOICES, f"(define (problem p) (:domain d) (:htn :subtasks (and {tasks})) (:init))")
    seen = grounded_graph(ground(problem, switches=SWITCHES), sees_costs=True)
    assert best_policy_with_memory(seen, "deadline 8").value == Fraction(1, 4)


def test_fixing_the_order_may_be_wrong() -> None:
    """The same problem, decomposed by a progression that thinks that nobody looks at costs."""
    values = set()
    for tasks in ("(c) (d)", "(d) (c)"):
        problem = read_hddl_text(
            TWO_CHOICES, f"(define (problem p) (:domain d) (:htn :subtasks (and {tasks})) (:init))"
        )
        unseen = grounded_graph(ground(problem, switches=SWITCHES), sees_costs=False)
        values.add(best_policy_with_memory(unseen, "deadline 8").value)
    assert max(values) == Fraction(1, 2)


def test_an_action_may_wait_for_what_a_task_leads_to() -> None:
    """Where failing has a price, what commutes with all else is paid only if x has worked: 1 + (3 + 10) / 2."""
    domain = """(define (domain d) (:predicates (p)) (:functions (total-cost))
        (:task t :parameters ())
        (:method tx :parameters () :task (t) :subtasks (x)) (:method ty :parameters () :task (t) :subtasks (y))
        (:action b :parameters () :effect (increase (total-cost) 3))
        (:action x :parameters () :effect (and (probabilistic 0.5 (p) 0.5 ()) (increase (total-cost) 1)))
        (:action y :parameters () :effect (and (p) (increase (total-cost) 30))))"""
    problem = read_hddl_text(
        domain, "(define (problem p) (:domain d) (:htn :subtasks (and (b) (t))) (:init) (:goal (p)))"
    )
    graph = graph_of(problem, "neutral", Fraction(10))
    assert best_policy(graph, "neutral", Fraction(10)).value == Fraction(15, 2)
