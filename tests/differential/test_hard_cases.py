"""Problems that random ones rarely hit: each has exactly one way to be solved, or none."""

from __future__ import annotations

import itertools

from statehtn import Plan, read_hddl_text, validate
from statehtn.core.grounding import PLAIN, ground
from statehtn.model import Problem
from statehtn.reference import blind, find_plans
from statehtn.risk import utility_for
from tests.brute_force import all_plans, optimal_risk_cost
from tests.differential.oracles import ADMISSIBLE, close_to, solve

DOMAIN = """
(define (domain hard)
  (:predicates (p) (q) (r))
  (:functions (total-cost) - number)
  (:task top :parameters ()) (:task sub :parameters ())
  {methods}
  (:action make-p :parameters () :effect (and (p) (increase (total-cost) 1)))
  (:action end-p :parameters () :effect (and (not (p)) (increase (total-cost) 1)))
  (:action p-to-q :parameters () :precondition (p) :effect (and (q) (not (p)) (increase (total-cost) 1)))
  (:action toggle :parameters () :effect
    (and (when (p) (not (p))) (when (p) (q)) (when (q) (not (q))) (when (not (p)) (p))))
  (:action blink :parameters () :effect (and (p) (not (p)) (increase (total-cost) 1))))
"""
PROBLEM = "(define (problem p) (:domain hard) (:htn :parameters () {network}) (:init {init}) (:goal {goal}))"


def problem(methods: str, network: str = ":subtasks (and (top))", init: str = "", goal: str = "(and)") -> Problem:
    return read_hddl_text(DOMAIN.format(methods=methods), PROBLEM.format(network=network, init=init, goal=goal))


def steps(plan: Plan | None) -> list[str] | None:
    return None if plan is None else [step.action for step in plan.steps]


def check(problem: Problem, expected: list[str] | None) -> None:
    utility = utility_for("neutral")
    found = [steps(plan) for plan in all_plans(problem)]
    assert found == ([] if expected is None else [expected])
    for heuristic in ADMISSIBLE:
        result = solve(problem, utility, heuristic=heuristic)
        assert steps(result.plan) == expected
        assert (result.risk_cost is None) == (expected is None)
        if result.plan is not None:
            assert validate(problem, result.plan).valid
            assert result.risk_cost == close_to(optimal_risk_cost(problem, utility))
    assert steps(find_plans(ground(problem, switches=PLAIN).to_model(), utility, blind).plan) == expected


def partial_orders() -> list[tuple[tuple[str, str], ...]]:
    """All partial orders of three tasks."""
    pairs = list(itertools.permutations("abc", 2))
    sets = itertools.chain.from_iterable(itertools.combinations(pairs, size) for size in range(4))
    return [
        order
        for order in sets
        if all((j, i) not in order for i, j in order)
        and all((i, k) in order for i, j in order for other, k in order if j == other)
    ]


def test_networks_that_differ_in_their_order_only() -> None:
    assert len(partial_orders()) == 19
    tasks = "(a (make-p)) (b (p-to-q)) (c (end-p))"
    for orders in itertools.permutations(partial_orders(), 2):
        methods = "".join(
            f"(:method m{number} :parameters () :task (top) :subtasks (and {tasks}) "
            f":ordering (and {' '.join(f'(< {i} {j})' for i, j in order)}))"
            for number, order in enumerate(orders)
        )
        pair = problem(methods, goal="(and (q) (not (p)))")
        expected = [steps(plan) for plan in all_plans(pair)] or [None]
        assert steps(solve(pair, utility_for("neutral")).plan) in expected
        model = ground(pair, switches=PLAIN).to_model()
        assert steps(find_plans(model, utility_for("neutral"), blind).plan) in expected


def test_a_precondition_holds_after_what_is_ordered_before_its_task() -> None:
    """What is ordered before the task may make its precondition true or false."""
    methods = """
      (:method m :parameters () :task (top) :ordered-subtasks (and (make-p) (sub)))
      (:method n :parameters () :task (sub) :precondition (p) :ordered-subtasks (and (make-p)))"""
    check(problem(methods), ["make-p", "make-p"])
    network = ":subtasks (and (a (sub)) (b (end-p))) :ordering (and (< b a))"
    check(problem(methods, network=network, init="(p)"), None)


def test_a_parallel_task_makes_a_precondition_true() -> None:
    methods = "(:method n :parameters () :task (sub) :precondition (p) :ordered-subtasks (and (end-p)))"
    check(problem(methods, network=":subtasks (and (sub) (make-p))"), ["make-p", "end-p"])


def test_a_parents_precondition_is_tested_before_its_childrens() -> None:
    methods = """
      (:method m :parameters () :task (top) :precondition (q) :subtasks (and (sub)))
      (:method n :parameters () :task (sub) :precondition (p) :subtasks ())"""
    network = ":subtasks (and (t (top)) (a (p-to-q)) (b (make-p))) :ordering (and (< a b))"
    check(problem(methods, network=network, init="(p)"), ["p-to-q", "make-p"])
    network = ":subtasks (and (t (top)) (a (p-to-q)))"
    check(problem(methods, network=network, init="(p)"), None)


def test_conditions_are_read_before_the_action_and_adding_wins() -> None:
    methods = "(:method m :parameters () :task (top) :ordered-subtasks (and (toggle)))"
    check(problem(methods, init="(p)", goal="(and (q) (not (p)))"), ["toggle"])
    check(problem(methods, init="(p) (q)", goal="(and (q) (not (p)))"), ["toggle"])
    check(problem(methods, init="(q)", goal="(and (p) (not (q)))"), ["toggle"])
    check(problem("(:method m :parameters () :task (top) :subtasks (and (blink)))", goal="(p)"), ["blink"])


def test_an_unneeded_fact_is_no_reason_to_fail() -> None:
    check(problem("(:method m :parameters () :task (top) :subtasks (and (make-p)))", goal="(not (r))"), ["make-p"])
