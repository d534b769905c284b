"""The engine of unified-planning: statuses, parameters, what it supports, and UP's own conformance report."""

from __future__ import annotations

import importlib.util
import io
import os
import re
import subprocess
import sys
import warnings
from fractions import Fraction
from pathlib import Path
from typing import Any

import pytest
import unified_planning.shortcuts as up
from unified_planning.engines import PlanGenerationResultStatus as S
from unified_planning.engines.results import ValidationResultStatus
from unified_planning.exceptions import UPNoSuitableEngineAvailableException, UPUsageError
from unified_planning.model.htn import HierarchicalProblem, Method
from unified_planning.plans import ActionInstance, HierarchicalPlan, SequentialPlan
from unified_planning.test.examples.hierarchical import get_example_problems

import statehtn
from statehtn import CostDistribution
from statehtn.engine import ADMISSIBLE, StateHtnEngine

up.get_environment().credits_stream = None


def problem(metric: Any = None, slow: Any = 3, fast: Any = 2) -> HierarchicalProblem:
    """Go slowly or fast; fast costs 2, slow 3, if nothing else is said."""
    made = HierarchicalProblem("Two Ways")
    done = made.add_fluent("Done", default_initial_value=False)
    go = made.add_task("Go")
    costs = {}
    for name, cost in (("Slow Way", slow), ("fast", fast)):
        action = up.InstantaneousAction(name)
        action.add_effect(done, True)
        made.add_action(action)
        costs[action] = cost
        method = Method(f"by {name}")
        method.set_task(go)
        method.add_subtask(action, ident="only")
        made.add_method(method)
    made.task_network.add_subtask(go, ident="first")
    made.add_goal(done)
    if metric != "none":
        made.add_quality_metric(metric or up.MinimizeActionCosts(costs))
    return made


def names(result: Any) -> list[str]:
    return [action.action.name for action in result.plan.action_plan.actions]


def test_optimal_with_a_metric_and_names_of_its_own() -> None:
    result = StateHtnEngine().solve(problem())
    assert result.status is S.SOLVED_OPTIMALLY
    assert names(result) == ["fast"]
    assert result.metrics["expected_cost"] == "2.0"
    assert names(StateHtnEngine().solve(problem(fast=Fraction(31, 10)))) == ["Slow Way"]
    shortest = StateHtnEngine().solve(problem(up.MinimizeSequentialPlanLength()))
    assert shortest.status is S.SOLVED_OPTIMALLY
    anything = StateHtnEngine().solve(problem("none"))
    assert anything.status is S.SOLVED_SATISFICING
    assert StateHtnEngine().validate(problem("none"), anything.plan)


def test_attitudes_and_distributions() -> None:
    risky = {"fast": CostDistribution.of([(0.5, 1), (0.5, 6)])}
    options = {"cost_distributions": risky, "alpha": 0.9}
    assert names(StateHtnEngine(cost_distributions=risky).solve(problem())) == ["Slow Way"]
    assert names(StateHtnEngine(attitude="averse", **options).solve(problem())) == ["Slow Way"]
    seeking = StateHtnEngine(attitude="seeking", **options).solve(problem())
    assert names(seeking) == ["fast"]
    assert seeking.status is S.SOLVED_OPTIMALLY
    assert float(seeking.metrics["risk_cost"]) < 2 < float(seeking.metrics["expected_cost"])
    averse = StateHtnEngine(attitude="averse", alpha="0.9", memory_limit="4000").solve(problem())
    assert names(averse) == ["fast"]  # certain costs are the same to everyone
    without = StateHtnEngine(cost_distributions={"Slow Way": 7, "fast": [1, lambda: 2]}).solve(problem("none"))
    assert without.status is S.SOLVED_SATISFICING
    assert without.metrics["risk_cost"] == "3.0"


def test_objectives_and_budgets() -> None:
    risky = {"fast": CostDistribution.of([(0.5, 1), (0.5, 6)])}
    for wanted, expected in (("deadline 2", "fast"), ("cvar 0.9", "Slow Way"), (lambda cost: -float(cost > 2), "fast")):
        engine = StateHtnEngine(objective=wanted, cost_distributions=risky)
        result = engine.solve(problem())
        assert result.status is S.SOLVED_OPTIMALLY
        assert names(result) == [expected]
    assert float(result.metrics["value"]) == 0.5
    keeping = StateHtnEngine(objective="seeking 0.9", keep="3 0.9", cost_distributions=risky)
    assert names(keeping.solve(problem())) == ["Slow Way"]
    assert StateHtnEngine(keep=["2 0.9"], cost_distributions=risky).solve(problem()).status is S.UNSOLVABLE_PROVEN
    assert names(list(keeping.get_solutions(problem()))[-1]) == ["Slow Way"]


@pytest.mark.parametrize(
    ("parameters", "message"),
    [
        ({"attitude": "brave"}, "brave"),
        ({"objective": "cvr 0.9"}, "did you mean 'cvar'"),
        ({"objective": "neutral", "alpha": 1}, "two ways to say one thing"),
        ({"keep": "3 2"}, "at most 1"),
        ({"attitude": "averse"}, "alpha"),
        ({"attitude": "averse", "alpha": "much"}, "much"),
        ({"heuristic": "ff"}, "one of auto, blind, tdg, hmax, lmcut, potential, potential-hmax, found 'ff'"),
        ({"heuristic": "nothing"}, "found 'nothing'"),
        ({"memory_limit": -1}, "memory"),
    ],
)
def test_wrong_parameters(parameters: dict[str, Any], message: str) -> None:
    with pytest.raises(UPUsageError, match=message):
        StateHtnEngine(**parameters)


@pytest.mark.parametrize("heuristic", ADMISSIBLE)
def test_every_heuristic_is_optimal(heuristic: str) -> None:
    assert names(StateHtnEngine(heuristic=heuristic).solve(problem())) == ["fast"]
    assert StateHtnEngine(heuristic=heuristic).solve(problem("none")).status is S.SOLVED_SATISFICING


def test_wrong_distributions() -> None:
    for distributions in ({"faster": 1}, {"fast": "cheap"}, [1]):
        with pytest.raises(UPUsageError, match=r"statehtn: "):
            StateHtnEngine(cost_distributions=distributions).solve(problem())


def test_unknown_arguments_are_warned_of() -> None:
    with pytest.warns(UserWarning, match="ignores the unknown parameter 'speed'"):
        engine = StateHtnEngine(speed=3)
    with pytest.warns(UserWarning, match="ignores the argument 'heuristic'"):
        engine.solve(problem(), heuristic=len)
    with pytest.warns(UserWarning, match="ignores the argument 'warm_start_plan'"):
        list(engine.get_solutions(problem(), warm_start_plan=SequentialPlan([])))
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        engine.solve(problem(), timeout=5)


def test_no_plan() -> None:
    unsolvable = problem()
    unsolvable.add_goal(up.FALSE())
    for metric_or_not in (unsolvable, _without_metric(unsolvable)):
        assert StateHtnEngine().solve(metric_or_not).status is S.UNSOLVABLE_PROVEN
        assert [r.status for r in StateHtnEngine().get_solutions(metric_or_not)] == [S.UNSOLVABLE_PROVEN]


def _without_metric(problem: HierarchicalProblem) -> HierarchicalProblem:
    other = problem.clone()
    other.clear_quality_metrics()
    return other


def satellite(name: str) -> HierarchicalProblem:
    folder = Path(__file__).parents[2] / "domains" / "satellite"
    return statehtn.to_unified_planning(statehtn.read_hddl(folder / "domain.hddl", folder / f"{name}.hddl"))


def test_limits_are_statuses() -> None:
    hard = satellite("RA-7obs-3sat-6mod-unordered")
    engine = StateHtnEngine(heuristic="blind")
    assert engine.solve(hard, timeout=0.3).status is S.TIMEOUT
    with pytest.raises(UPUsageError, match="time"):
        engine.solve(hard, timeout=-1)
    small = StateHtnEngine(memory_limit=1).solve(hard)
    assert (small.status, small.plan) == (S.MEMOUT, None)


def test_anytime_gets_better_and_tells_when_time_is_up() -> None:
    hard = satellite("RA-5obs-1sat-3mod-unordered")
    stream = io.StringIO()
    found = list(StateHtnEngine(heuristic="blind").get_solutions(hard, timeout=3, output_stream=stream))
    assert len(found) > 1
    assert [result.status for result in found[:-1]] == [S.INTERMEDIATE] * (len(found) - 1)
    assert found[-1].status is S.TIMEOUT
    assert found[-1].plan is not None
    costs = [float(result.metrics["risk_cost"]) for result in found]
    assert costs == sorted(costs, reverse=True)
    assert re.match(r"\d+\.\d s: \d+ nodes, bound \S+, best plan \S+\n", stream.getvalue())
    first = next(iter(StateHtnEngine().get_solutions(hard)))  # and may be left
    assert first.status is S.INTERMEDIATE


def test_what_is_not_supported_is_refused_by_up() -> None:
    statehtn.register()
    statehtn.register()
    temporal = get_example_problems()["htn-go-temporal"].problem
    assert not StateHtnEngine.supports(temporal.kind)
    with pytest.raises(UPUsageError, match="cannot establish"):
        StateHtnEngine().solve(temporal)
    numeric = problem()
    fuel = numeric.add_fluent("fuel", up.IntType(), default_initial_value=3)
    numeric.action("fast").add_precondition(up.GE(fuel, 2))
    with pytest.raises(UPUsageError, match="cannot establish"):
        StateHtnEngine().solve(numeric)
    final = problem(up.MinimizeExpressionOnFinalState(up.Int(1)))
    with up.OneshotPlanner(name="statehtn") as planner:
        assert not planner.supports(final.kind)
        with pytest.warns(UserWarning, match="cannot establish"):  # so UP treats engines that are asked for by name
            assert planner.solve(final).status is S.UNSUPPORTED_PROBLEM
    factory = up.get_environment().factory
    preferred = factory.preference_list
    factory.preference_list = ["statehtn"]
    try:
        with up.OneshotPlanner(problem_kind=problem().kind, optimality_guarantee="SOLVED_OPTIMALLY") as planner:
            assert planner.name == "statehtn"
        with pytest.raises(UPNoSuitableEngineAvailableException, match="CONTINUOUS_TIME"):
            up.OneshotPlanner(problem_kind=temporal.kind)
    finally:
        factory.preference_list = preferred


def test_what_up_cannot_tell_is_a_status() -> None:
    negative = StateHtnEngine().solve(problem(fast=-1))
    assert negative.status is S.UNSUPPORTED_PROBLEM
    assert "must not be negative, found -1" in str(negative.log_messages[0])


def test_costs_read_fluents_of_the_parameters() -> None:
    made = HierarchicalProblem("roads")
    place = up.UserType("Place")
    length = made.add_fluent("length", up.IntType(0, 90), a=place, b=place)  # unknown where there is no road
    at = made.add_fluent("at", place)
    places = [made.add_object(f"P{i}", place) for i in range(3)]
    made.set_initial_value(at, places[0])
    for a, b, cost in ((0, 1, 6), (1, 2, 5), (0, 2, 10)):
        made.set_initial_value(length(places[a], places[b]), cost)
    road = made.add_fluent("road", a=place, b=place, default_initial_value=False)
    for a, b in ((0, 1), (1, 2), (0, 2)):
        made.set_initial_value(road(places[a], places[b]), True)
    drive = up.InstantaneousAction("drive", a=place, b=place)
    drive.add_precondition(up.Equals(drive.a, at))
    drive.add_precondition(road(drive.a, drive.b))
    drive.add_effect(at, drive.b)
    made.add_action(drive)
    go = made.add_task("go", to=place)
    stay = Method("stay", to=place)
    stay.set_task(go)
    stay.add_precondition(up.Equals(at, stay.to))
    made.add_method(stay)
    on = Method("on", a=place, b=place, to=place)
    on.set_task(go, on.to)
    on.set_ordered(on.add_subtask(drive, on.a, on.b), on.add_subtask(go, on.to))
    made.add_method(on)
    made.task_network.add_subtask(go, places[2])
    made.add_quality_metric(up.MinimizeActionCosts({drive: up.Plus(length(drive.a, drive.b), 1)}))
    result = StateHtnEngine().solve(made)
    assert str(result.plan.action_plan).split("\n")[1:] == ["    drive(P0, P2)"]
    validation = StateHtnEngine().validate(made, result.plan)
    assert list(validation.metric_evaluations.values()) == [11]


def test_validator() -> None:
    case = get_example_problems()["htn-go"]
    engine = StateHtnEngine()
    (plan,) = case.valid_plans
    assert engine.validate(case.problem, plan).status is ValidationResultStatus.VALID
    again = SequentialPlan([ActionInstance(a.action, a.actual_parameters) for a in plan.action_plan.actions])
    assert engine.validate(case.problem, HierarchicalPlan(again, plan.decomposition))  # equal actions, not the same
    shorter = HierarchicalPlan(SequentialPlan(plan.action_plan.actions[:-1]), plan.decomposition)
    invalid = engine.validate(case.problem, shorter)
    assert invalid.status is ValidationResultStatus.INVALID
    assert "move l3 l2" in str(invalid.log_messages[0])
    swapped = [plan.action_plan.actions[i] for i in (1, 0, 2, 3, 4)]
    invalid = engine.validate(case.problem, HierarchicalPlan(SequentialPlan(swapped), plan.decomposition))
    assert not invalid
    assert invalid.log_messages
    with pytest.raises(UPUsageError, match="cannot validate this kind of plan"):
        engine.validate(case.problem, plan.action_plan)


def in_a_process(home: Path, *arguments: str, **environment: str) -> subprocess.CompletedProcess[str]:
    """Python as a new user has it, with a file `up.ini` that names the engine."""
    (home / "up.ini").write_text(
        "[engine statehtn]\nmodule_name: statehtn.engine\nclass_name: StateHtnEngine\n", encoding="utf-8"
    )
    return subprocess.run(
        [sys.executable, *arguments],
        capture_output=True,
        text=True,
        timeout=120,
        cwd=home,
        env={**os.environ, "HOME": str(home), **environment},
    )


def test_conformance_report(tmp_path: Path) -> None:
    """UP's report compares the cost of every plan with the optimum of the test case."""
    cases = importlib.util.find_spec("up_test_cases")
    assert cases is not None
    assert cases.submodule_search_locations
    (folder,) = cases.submodule_search_locations
    report = [f"{folder}/report.py", "statehtn", "-p", "builtin.hierarchical", "unified_planning.test", "-f", "htn"]
    run = in_a_process(tmp_path, *report, PYTHONPATH=str(folder))
    assert run.returncode == 0, run.stdout + run.stderr
    assert run.stdout.count("builtin.hierarchical:") == 16  # each of 8 problems by both kinds of planners
    assert run.stdout.count("OK(Valid)") == 16 + 3  # and UP's own example, whose plan is validated, too
    assert not re.search(r"Err\(|WARN|CRASH|errors:", run.stdout), run.stdout


def test_importing_statehtn_does_not_import_up(tmp_path: Path) -> None:
    code = "import statehtn, sys; print([name for name in sys.modules if name.startswith(('unified', 'up_'))])"
    assert in_a_process(tmp_path, "-c", code).stdout == "[]\n"


def test_without_up(tmp_path: Path) -> None:
    code = "import sys; sys.modules['unified_planning'] = None; import statehtn\n"
    for line in ("statehtn.register()", "statehtn.from_unified_planning(None)", "import statehtn.engine"):
        run = in_a_process(tmp_path, "-c", code + line)
        last = run.stderr.splitlines()[-1]
        assert re.fullmatch(
            r"statehtn.errors.UsageError: .* needs the package 'unified-planning': pip install .*", last
        )
