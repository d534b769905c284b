"""Ctrl-C in Python: a value by default, an exception on request; and what a result says of its end."""

from __future__ import annotations

import logging
import signal
import subprocess
import sys
from collections.abc import Callable
from typing import Any

import pytest

import statehtn
from statehtn import Status
from statehtn.experiments.records import Record
from statehtn.experiments.run import Run
from tests.test_minimal import DOMAIN, PROBLEM
from tests.unit.test_output_files import A_PLAN_AND_NO_PROOF, ARRIVE
from tests.unit.test_planner import ENDLESS_DOMAIN, ENDLESS_PROBLEM


def press(_progress: object) -> None:
    signal.raise_signal(signal.SIGINT)


def endless() -> statehtn.Problem:
    return statehtn.read_hddl_text(ENDLESS_DOMAIN, ENDLESS_PROBLEM)


def with_a_plan() -> statehtn.Problem:
    return statehtn.read_hddl_text(A_PLAN_AND_NO_PROOF, ARRIVE)


@pytest.mark.parametrize("problem", [endless(), with_a_plan()])
@pytest.mark.parametrize(
    "call",
    [
        lambda problem, **options: statehtn.plan(problem, search="anytime", **options),
        lambda problem, **options: list(statehtn.improving(problem, **options))[-1],
        lambda problem, **options: statehtn.top_plans(problem, 1000, **options),
        lambda problem, **options: statehtn.compare_attitudes(problem, search="anytime", **options),
    ],
)
def test_an_interruption_is_a_value_or_an_exception(call: Callable[..., Any], problem: statehtn.Problem) -> None:
    result = call(problem, progress=press, time_limit=60)
    assert result.stopped is Status.INTERRUPTED
    with pytest.raises(KeyboardInterrupt) as raised:
        call(problem, progress=press, time_limit=60, interrupt="raise")
    assert type(raised.value.args[0]) is type(result)
    assert raised.value.args[0].stopped is Status.INTERRUPTED


def press_once_there_is_a_plan(progress: statehtn.Progress) -> None:
    if progress.best is not None:
        press(progress)


def test_every_plan_comes_before_the_exception() -> None:
    seen: list[statehtn.Result] = []
    results = statehtn.improving(with_a_plan(), progress=press_once_there_is_a_plan, time_limit=60, interrupt="raise")
    with pytest.raises(KeyboardInterrupt):
        seen.extend(iter(lambda: next(results), None))
    assert [str(step.step) for step in seen[0].steps] == ["(ride)"]
    assert (seen[-1].status, seen[-1].stopped) == (Status.SOLVED, Status.INTERRUPTED)


@pytest.mark.parametrize(
    ("problem", "options", "status", "stopped"),
    [
        (statehtn.read_hddl_text(DOMAIN, PROBLEM), {}, Status.OPTIMAL, None),
        (with_a_plan(), {"search": "greedy"}, Status.SOLVED, None),
        (statehtn.read_hddl_text(DOMAIN, PROBLEM), {"time_limit": 1e-9}, Status.TIME_LIMIT, Status.TIME_LIMIT),
        (endless(), {"time_limit": 0.3}, Status.TIME_LIMIT, Status.TIME_LIMIT),
        (endless(), {"memory_limit": 1}, Status.MEMORY_LIMIT, Status.MEMORY_LIMIT),
        (with_a_plan(), {"time_limit": 2, "search": "anytime"}, Status.SOLVED, Status.TIME_LIMIT),
    ],
)
def test_a_result_says_what_stopped_it(
    problem: statehtn.Problem, options: dict[str, Any], status: Status, stopped: Status | None
) -> None:
    result = statehtn.plan(problem, **options)
    assert (result.status, result.stopped) == (status, stopped)
    assert result.to_dict()["stopped"] == (stopped and stopped.value)


def test_agents_after_an_interruption_are_not_asked() -> None:
    comparison = statehtn.compare_attitudes(
        with_a_plan(), search="anytime", progress=press_once_there_is_a_plan, time_limit=60
    )
    assert comparison.stopped is Status.INTERRUPTED
    assert len(comparison.results) == 1
    assert comparison.results[0]  # it has a plan


def test_an_interrupted_run_with_a_plan_is_no_record() -> None:
    def record(status: str, stopped: str | None) -> Record:
        run = Run.__new__(Run)
        return Record(run, status, 0, 1.0, "", {"status": status, "stopped": stopped})

    assert record("solved", "interrupted").was_interrupted
    assert not record("solved", "time-limit").was_interrupted
    assert Record(Run.__new__(Run), "interrupted", 130, 1.0, "", None).was_interrupted


def test_the_engine_of_unified_planning_knows_what_stopped_it() -> None:
    pytest.importorskip("unified_planning")
    from unified_planning.engines.results import PlanGenerationResultStatus

    from statehtn.engine import StateHtnEngine

    problem = statehtn.to_unified_planning(with_a_plan())
    # Converting takes a part of the time that is not known, so memory is what ends this run.
    result = StateHtnEngine(memory_limit=1).solve(problem)
    assert result.status is PlanGenerationResultStatus.MEMOUT


def test_phases_and_better_plans_are_logged(caplog: pytest.LogCaptureFixture) -> None:
    caplog.set_level(logging.INFO, "statehtn")
    statehtn.plan(statehtn.read_hddl_text(DOMAIN, PROBLEM))
    statehtn.top_plans(statehtn.read_hddl_text(DOMAIN, PROBLEM), 2)
    text = caplog.text
    for words in (
        "grounding: ",
        "2 tasks",
        "search: optimal, a plan of 1 step for 3.4, bound 3.4",
        "2 plans, 2 proven",
    ):
        assert words in text
    with pytest.warns(statehtn.HddlWarning, match="declared again"):
        statehtn.read_hddl_text(DOMAIN.replace("(home) (away)", "(home) (home) (away)"), PROBLEM)
    assert [record.levelname for record in caplog.records][-1] == "WARNING"


def test_the_library_prints_nothing() -> None:
    text = DOMAIN.replace("(home) (away)", "(home) (home) (away)")
    code = f"import statehtn; statehtn.plan(statehtn.read_hddl_text({text!r}, {PROBLEM!r}))"
    run = subprocess.run([sys.executable, "-W", "ignore", "-c", code], capture_output=True, text=True, check=True)
    assert (run.stdout, run.stderr) == ("", "")
