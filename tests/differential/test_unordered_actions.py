"""Few actions in no order over two facts, so that nearly each bars, enables or changes another: every order counts."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from statehtn import Problem, Status, read_hddl_text, validate
from statehtn.risk import utility_for
from tests.brute_force import optimal_risk_cost
from tests.differential.oracles import close_to, must_have_ended, solve

LITERALS = ["(p)", "(not (p))", "(q)", "(not (q))"]
NAMES = ["a", "b", "c"]


@st.composite
def unordered(draw: st.DrawFn) -> Problem:
    """Two or three tasks: actions, or choices between two of them."""
    literal = st.sampled_from(LITERALS)
    seldom = st.sampled_from(["", "", *LITERALS])
    actions = []
    for cost, name in enumerate(NAMES):
        effects = [draw(literal), f"(increase (total-cost) {cost})"]
        if draw(st.sampled_from([False, False, True])):
            effects.append(f"(when {draw(literal)} {draw(literal)})")
        if draw(st.sampled_from([False, False, True])):
            effects.append(f"(when {draw(literal)} (increase (total-cost) 5))")
        needed = f"(and {draw(seldom)})"
        actions.append(f"(:action {name} :parameters () :precondition {needed} :effect (and {' '.join(effects)}))")
    choices = [
        f"(:method {task}-{name} :parameters () :task ({task}) :ordered-subtasks ({name}))"
        for task in ("t", "u")
        for name in draw(st.lists(st.sampled_from(NAMES), min_size=2, max_size=2, unique=True))
    ]
    domain = f"""(define (domain d) (:predicates (p) (q)) (:functions (total-cost)) (:task t :parameters ())
        (:task u :parameters ()) {" ".join(choices)} {" ".join(actions)})"""
    tasks = draw(st.lists(st.sampled_from([*NAMES, *NAMES, "t", "u"]), min_size=2, max_size=3))
    initial = draw(st.sampled_from(["", "(p)", "(q)", "(p) (q)"]))
    return read_hddl_text(
        domain,
        f"""(define (problem r) (:domain d) (:htn :subtasks (and {" ".join(f"({task})" for task in tasks)}))
        (:init {initial}) (:goal (and {draw(seldom)} {draw(seldom)})))""",
    )


@pytest.mark.filterwarnings("ignore:.*there is no plan")
@pytest.mark.parametrize("options", [{}, {"heuristic": "blind"}, {"solver": "plan"}], ids=["auto", "blind", "plan"])
@given(problem=unordered())
def test_the_best_order_is_found(options: dict[str, str], problem: Problem) -> None:
    optimum = optimal_risk_cost(problem, utility_for("neutral"))
    result = solve(problem, utility_for("neutral"), **options)
    must_have_ended(result.stopped)
    if optimum is None:
        assert result.status is Status.UNSOLVABLE
        return
    assert result.status is Status.OPTIMAL
    assert result.risk_cost == close_to(optimum)
    assert validate(problem, result.plan).risk_cost(utility_for("neutral")) == close_to(optimum)
