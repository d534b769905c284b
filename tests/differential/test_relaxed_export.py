"""The relaxed model as others see it: pyperplan's hmax and Fast Downward's optimum on what `statehtn.relax` exports."""

from __future__ import annotations

import importlib.util
import math
import re
import subprocess
import sys
from fractions import Fraction
from pathlib import Path
from typing import Any

import pytest
from hypothesis import assume, given, settings
from unified_planning.model import InstantaneousAction
from unified_planning.model.metrics import MinimizeActionCosts

import statehtn
from statehtn import Problem
from statehtn.core.grounding import PLAIN, ground
from statehtn.core.heuristics import HeuristicEvaluator
from statehtn.interop.relaxation import pddl
from statehtn.risk import Utility, utility_for
from tests.brute_force import GaveUp
from tests.differential.test_reference_against_core import ATTITUDES
from tests.strategies import problems, utilities

relaxation = pytest.importorskip("pyperplan.heuristics.relaxation")
pyperplan_task = pytest.importorskip("pyperplan.task")
pyperplan_search = pytest.importorskip("pyperplan.search.searchspace")


def close_to(cost: float) -> object:
    return pytest.approx(cost, rel=1e-8, abs=1e-8)  # the export has 10 digits


def initial_value(problem: Problem, utility: Utility, heuristic: str) -> float:
    """The core's heuristic of the initial node."""
    grounding = ground(problem, switches=PLAIN)
    model = grounding.to_model()
    if not model.methods:  # found to be unsolvable already
        return math.inf
    value = HeuristicEvaluator(grounding, utility, heuristic)(model.initial_state, [model.initial_task])
    return math.inf if value is None else value


def facts(condition: Any) -> frozenset[str]:
    """The names of the facts in a conjunction."""
    if condition.is_true():
        return frozenset()
    return frozenset(fact.fluent().name for fact in (condition.args if condition.is_and() else (condition,)))


def pyperplan_hmax(model: Any) -> float:
    """pyperplan's hmax of the exported model; a conditional effect is an operator of its own with its action's cost."""
    operators, costs = [], []
    (metric,) = model.quality_metrics
    for action in model.actions:
        needed = frozenset().union(*map(facts, action.preconditions))
        added: dict[frozenset[str], set[str]] = {needed: set()}
        for effect in action.effects:
            if effect.value.is_true():
                added.setdefault(needed | facts(effect.condition), set()).add(effect.fluent.fluent().name)
        for condition, gained in added.items():
            operators.append(pyperplan_task.Operator(action.name, condition, frozenset(gained), frozenset()))
            costs.append(float(metric.get_action_cost(action).constant_value()))
    names = frozenset(fluent.name for fluent in model.fluents)
    state = frozenset(fluent.fluent().name for fluent, value in model.initial_values.items() if value.is_true())
    goals = frozenset().union(*map(facts, model.goals))
    heuristic = relaxation.hMaxHeuristic(pyperplan_task.Task("relaxed", names, state, goals, operators))
    for operator, cost in zip(heuristic.operators, costs, strict=True):
        operator.cost = cost
    return float(heuristic(pyperplan_search.make_root_node(state)))


@given(problem=problems(), utility=utilities())
def test_hmax_is_that_of_pyperplan(problem: Problem, utility: Utility) -> None:
    model = statehtn.relax(problem, attitude=utility.attitude, alpha=utility.alpha)
    assert initial_value(problem, utility, "hmax") == close_to(pyperplan_hmax(model))


@pytest.mark.parametrize(("attitude", "alpha"), ATTITUDES)
def test_hmax_is_that_of_pyperplan_on_p1(p1: Problem, attitude: str, alpha: float | None) -> None:
    model = statehtn.relax(p1, attitude=attitude, alpha=alpha)
    value = initial_value(p1, utility_for(attitude, alpha), "hmax")
    assert 0 < value == close_to(pyperplan_hmax(model))


def without_deletes(model: Any) -> tuple[Any, int]:
    """The delete relaxation, with costs that are integers, and what they were multiplied by."""
    (metric,) = model.quality_metrics
    costs = {action.name: Fraction(metric.get_action_cost(action).constant_value()) for action in model.actions}
    factor = math.lcm(*(cost.denominator for cost in costs.values()))
    relaxed = model.clone()
    relaxed.clear_actions()
    relaxed.clear_quality_metrics()
    actions = {}
    for action in model.actions:
        copy = InstantaneousAction(action.name)
        for condition in action.preconditions:
            copy.add_precondition(condition)
        for effect in action.effects:
            if effect.value.is_true():
                copy.add_effect(effect.fluent, True, effect.condition)
        relaxed.add_action(copy)
        actions[copy] = int(costs[action.name] * factor)
    relaxed.add_quality_metric(MinimizeActionCosts(actions))
    return relaxed, factor


def fast_downward(model: Any, folder: Path) -> int | None:
    """The cost of an optimal plan by Fast Downward in a process of its own; None where there is no plan."""
    spec = importlib.util.find_spec("up_fast_downward")
    if spec is None or spec.origin is None:
        pytest.skip("Fast Downward comes with up-fast-downward, which is not installed")
    driver = Path(spec.origin).parent / "downward" / "fast-downward.py"
    for name, text in zip(("domain.pddl", "problem.pddl"), pddl(model), strict=True):
        (folder / name).write_text(text, encoding="utf-8")
    conditional = any(not effect.condition.is_true() for action in model.actions for effect in action.effects)
    heuristic = "hmax()" if conditional else "lmcut()"  # its lmcut has no conditional effects
    command = [sys.executable, driver, "--search-time-limit", "5s", "domain.pddl", "problem.pddl"]
    command += ["--search", f"astar({heuristic})"]
    run = subprocess.run(command, cwd=folder, capture_output=True, text=True, timeout=120)
    if run.returncode == 23:  # the time limit: methods cost nothing, and A* tries them in every order
        raise GaveUp
    if run.returncode in (10, 11, 12):
        return None
    assert run.returncode == 0, run.stdout + run.stderr
    (cost,) = re.findall(r"Plan cost: (\d+)", run.stdout)
    return int(cost)


def check_bounds(problem: Problem, folder: Path) -> None:
    """Landmark cuts never exceed the optimum of the delete relaxation, which hmax does not either."""
    relaxed, factor = without_deletes(statehtn.relax(problem))
    assume(factor < 10_000)
    optimum = fast_downward(relaxed, folder)
    hmax, lmcut = (initial_value(problem, utility_for("neutral"), name) for name in ("hmax", "lmcut"))
    if optimum is None:
        assert hmax == lmcut == math.inf
    else:
        assert max(hmax, lmcut) <= optimum / factor * (1 + 1e-8) + 1e-8


@settings(max_examples=8)
@given(problem=problems())
def test_landmark_cuts_never_exceed_the_optimum_of_the_delete_relaxation(
    problem: Problem, tmp_path_factory: pytest.TempPathFactory
) -> None:
    check_bounds(problem, tmp_path_factory.mktemp("pddl"))
