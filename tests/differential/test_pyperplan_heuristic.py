"""Someone else's heuristic works in the reference search: pyperplan's hmax on the relaxed model."""

from __future__ import annotations

import pytest
from hypothesis import assume, given

from statehtn import Status, validate
from statehtn.core.grounding import PLAIN, ground
from statehtn.core.heuristics import HeuristicEvaluator
from statehtn.model import Problem
from statehtn.reference import RelaxedTask, compute_rc_ad_heur, find_plans
from statehtn.risk import Utility, utility_for
from tests.brute_force import GaveUp, optimal_risk_cost
from tests.differential.oracles import close_to
from tests.differential.test_reference_against_core import ATTITUDES
from tests.remaining_cost import explore
from tests.strategies import problems, utilities

relaxation = pytest.importorskip("pyperplan.heuristics.relaxation")
pyperplan_task = pytest.importorskip("pyperplan.task")
pyperplan_search = pytest.importorskip("pyperplan.search.searchspace")


def pyperplan_hmax(task: RelaxedTask) -> float:
    """Hand the relaxed model to pyperplan: actions cost their risk cost, methods nothing."""
    operators = [
        pyperplan_task.Operator(operator.name, operator.preconditions, operator.add_effects, frozenset())
        for operator in task.operators
    ]
    theirs = pyperplan_task.Task("relaxed", task.facts, task.initial_state, task.goals, operators)
    heuristic = relaxation.hMaxHeuristic(theirs)
    for operator, ours in zip(heuristic.operators, task.operators, strict=True):
        operator.cost = ours.cost
    return float(heuristic(pyperplan_search.make_root_node(task.initial_state)))


@given(problem=problems(), utility=utilities())
def test_same_optimum(problem: Problem, utility: Utility) -> None:
    solution = find_plans(ground(problem, switches=PLAIN).to_model(), utility, pyperplan_hmax, most_expansions=150)
    if solution.status is Status.GAVE_UP:
        raise GaveUp
    optimum = optimal_risk_cost(problem, utility)
    assert (solution.plan is None) == (optimum is None)
    if solution.plan is not None:
        assert solution.risk_cost == close_to(optimum)
        assert validate(problem, solution.plan).valid


@given(problem=problems(), utility=utilities())
def test_same_value_as_the_core(problem: Problem, utility: Utility) -> None:
    grounding = ground(problem)
    model = grounding.to_model()
    assume(model.methods)
    h = HeuristicEvaluator(grounding, utility, "hmax")
    for node in explore(model, utility, most_nodes=30):
        theirs = compute_rc_ad_heur(node.state, node.tasks, model, utility, pyperplan_hmax)
        ours = h(node.state, node.tasks)
        assert theirs == close_to(float("inf") if ours is None else ours)


@pytest.mark.parametrize(("attitude", "alpha"), ATTITUDES)
def test_same_optimum_on_p1(p1: Problem, attitude: str, alpha: float | None) -> None:
    utility = utility_for(attitude, alpha)
    solution = find_plans(ground(p1, switches=PLAIN).to_model(), utility, pyperplan_hmax)
    assert solution.plan is not None
    assert validate(p1, solution.plan).valid
    assert solution.risk_cost == close_to(optimal_risk_cost(p1, utility))
