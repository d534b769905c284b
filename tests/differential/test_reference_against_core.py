"""The paper's pseudo-code and the compiled core agree, on random small problems and on the paper's P1."""

from __future__ import annotations

from itertools import pairwise

import pytest
from hypothesis import given

import statehtn
from statehtn import Status, validate
from statehtn.core.grounding import PLAIN, ground
from statehtn.model import Problem
from statehtn.reference import Heuristic, RelaxedTask, SearchNode, blind, find_plans, hmax
from statehtn.risk import Utility, utility_for
from tests.differential.oracles import close_to, must_agree
from tests.strategies import problems, utilities

HEURISTICS = {"blind": blind, "hmax": hmax}
MOST_EXPANSIONS = 300
ATTITUDES = [("neutral", None), ("averse", 0.1), ("averse", 0.9), ("seeking", 0.1), ("seeking", 0.9)]


@pytest.mark.parametrize("heuristic", HEURISTICS.values(), ids=HEURISTICS)
@given(problem=problems(), utility=utilities())
def test_same_optimum(heuristic: Heuristic, problem: Problem, utility: Utility) -> None:
    model = ground(problem, switches=PLAIN).to_model()
    solution = find_plans(model, utility, heuristic, most_expansions=MOST_EXPANSIONS)
    must_agree(problem, utility, solution)


@pytest.mark.parametrize("heuristic", HEURISTICS.values(), ids=HEURISTICS)
@pytest.mark.parametrize(("attitude", "alpha"), ATTITUDES)
def test_same_optimum_on_p1(p1: Problem, attitude: str, alpha: float | None, heuristic: Heuristic) -> None:
    utility = utility_for(attitude, alpha)
    solution = find_plans(ground(p1, switches=PLAIN).to_model(), utility, heuristic)
    result = statehtn.plan(p1, attitude=attitude, alpha=alpha)
    assert solution.plan is not None
    assert validate(p1, solution.plan).valid
    assert solution.risk_cost == close_to(result.risk_cost)


def test_any_callable_is_a_heuristic(p1: Problem) -> None:
    goals: list[int] = []

    def nothing_but_the_goals(task: RelaxedTask) -> float:
        goals.append(len(task.goals - task.initial_state))
        return 0.0

    solution = find_plans(ground(p1, switches=PLAIN).to_model(), utility_for("neutral"), nothing_but_the_goals)
    assert solution.risk_cost == close_to(18.35)
    assert goals[0] == 1
    assert goals[-1] == 0


def test_every_expanded_node_can_be_visited(p1: Problem) -> None:
    values: list[float] = []

    def visit(node: SearchNode, h: float) -> None:
        values.append(node.cost + h)

    solution = find_plans(ground(p1, switches=PLAIN).to_model(), utility_for("averse", 0.9), hmax, visit=visit)
    assert len(values) == solution.expanded
    assert all(first <= second + 1e-9 for first, second in pairwise(values))  # hmax is consistent
    assert values[-1] <= solution.risk_cost + 1e-9


def test_it_gives_up_when_told_to(p1: Problem) -> None:
    solution = find_plans(ground(p1, switches=PLAIN).to_model(), utility_for("neutral"), blind, most_expansions=3)
    assert solution.status is Status.GAVE_UP
    assert solution.plan is None
    assert solution.expanded == 3
