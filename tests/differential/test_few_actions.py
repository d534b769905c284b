"""Few actions over two facts, so that nearly each bars, enables or changes another: in no order, and in sequences."""

from __future__ import annotations

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from statehtn import Problem, Status, read_hddl_text, validate
from statehtn.risk import utility_for
from tests.brute_force import optimal_risk_cost
from tests.differential.oracles import close_to, must_have_ended, solve
from tests.strategies import between, pick

LITERALS = ["(p)", "(not (p))", "(q)", "(not (q))"]
EXAMPLES = 400  # each takes some milliseconds
NAMES = ["a", "b", "c", "d"]
seldom = st.sampled_from(["", "", *LITERALS])
name = st.sampled_from(NAMES)


@st.composite
def problems_of(
    draw: st.DrawFn, methods: dict[str, st.SearchStrategy[str]], network: st.SearchStrategy[str]
) -> Problem:
    """Actions, and two or three methods of each task; what a method and the problem consist of is drawn."""
    actions = []
    for cost, action in enumerate(NAMES):
        effects = [pick(draw, LITERALS), f"(increase (total-cost) {cost})"]
        if pick(draw, [False, False, True]):
            effects.append(f"(when {pick(draw, LITERALS)} {pick(draw, LITERALS)})")
        if pick(draw, [False, False, True]):
            effects.append(f"(when {pick(draw, LITERALS)} (increase (total-cost) 5))")
        needed = f"(and {draw(seldom)})"
        actions.append(f"(:action {action} :parameters () :precondition {needed} :effect (and {' '.join(effects)}))")
    ways = [
        f"(:method {task}-{index} :parameters () :task ({task}) :ordered-subtasks (and {draw(subtasks)}))"
        for task, subtasks in methods.items()
        for index in range(between(draw, 2, 3))
    ]
    tasks = " ".join(f"(:task {task} :parameters ())" for task in methods)
    domain = f"""(define (domain few) (:predicates (p) (q)) (:functions (total-cost)) {tasks}
        {" ".join(ways)} {" ".join(actions)})"""
    initial = pick(draw, ["", "(p)", "(q)", "(p) (q)"])
    goal = f"(and {draw(seldom)} {draw(seldom)})"
    return read_hddl_text(
        domain, f"(define (problem p) (:domain few) (:htn {draw(network)}) (:init {initial}) (:goal {goal}))"
    )


def listed(tasks: st.SearchStrategy[str], least: int, most: int) -> st.SearchStrategy[str]:
    return st.lists(tasks.map("({})".format), min_size=least, max_size=most).map(" ".join)


# Two or three tasks in no order: actions, or choices between them.
unordered = problems_of(
    {"t": listed(name, 1, 1), "u": listed(name, 1, 1)},
    listed(st.sampled_from([*NAMES, "t", "u", "t", "u"]), 2, 3).map(":subtasks (and {})".format),
)
# A choice between sequences, behind a task of which it is not yet known what it does.
sequences = problems_of(
    {"t": listed(name, 1, 3).map("(u) {}".format), "u": listed(name, 0, 1)},
    listed(name, 0, 1).map(":ordered-subtasks (and (t) {})".format),
)


@pytest.mark.filterwarnings("ignore:.*there is no plan")
@pytest.mark.parametrize("options", [{}, {"heuristic": "blind"}, {"solver": "plan"}], ids=["auto", "blind", "plan"])
@pytest.mark.parametrize("kind", [unordered, sequences], ids=["unordered", "sequences"])
@settings(max_examples=max(EXAMPLES, settings().max_examples))
@given(data=st.data())
def test_the_optimum_is_found(kind: st.SearchStrategy[Problem], options: dict[str, str], data: st.DataObject) -> None:
    problem = data.draw(kind)
    optimum = optimal_risk_cost(problem, utility_for("neutral"))
    result = solve(problem, utility_for("neutral"), **options)
    must_have_ended(result.stopped)
    if optimum is None:
        assert result.status is Status.UNSOLVABLE
        return
    assert result.status is Status.OPTIMAL
    assert result.risk_cost == close_to(optimum)
    assert validate(problem, result.plan).risk_cost(utility_for("neutral")) == close_to(optimum)
