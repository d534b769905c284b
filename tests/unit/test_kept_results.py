"""What was found before a signal comes out: while it is put together, written and printed."""

from __future__ import annotations

import importlib
import json
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any, TypeVar

import pytest

import statehtn
from statehtn.cli import files, main, plan_command
from statehtn.cli.formats import printed
from statehtn.cli.signals import signals_as_interrupt
from statehtn.core.labels import Labels
from statehtn.core.staged_run import StagedRun
from statehtn.core.trace import TraceReader
from statehtn.found_plan import FoundPlan
from statehtn.model.status import Status
from statehtn.sweeps.plan_curve import PlanCurve
from tests.unit.test_unread_plans import PROBLEM, WALK

R = TypeVar("R")


def pressing(function: Callable[..., R], times: int = 1, number: int = signal.SIGINT) -> Callable[..., R]:
    """Return the function with a signal in the middle of its first calls."""
    left = times

    def call(*arguments: Any, **options: Any) -> R:
        nonlocal left
        if left > 0:
            left -= 1
            signal.raise_signal(number)
        return function(*arguments, **options)

    return call


def walk() -> statehtn.Problem:
    return statehtn.read_hddl_text(WALK, PROBLEM)


@pytest.fixture
def arguments(tmp_path: Path) -> list[str]:
    (tmp_path / "d.hddl").write_text(WALK)
    (tmp_path / "p.hddl").write_text(PROBLEM)
    return [str(tmp_path / "d.hddl"), str(tmp_path / "p.hddl")]


def found_in_spite_of(owner: Any, name: str, monkeypatch: pytest.MonkeyPatch, **options: Any) -> statehtn.Result:
    monkeypatch.setattr(owner, name, pressing(getattr(owner, name)))
    result = statehtn.plan(walk(), **options)
    assert (result.stopped, result.unread) == (Status.INTERRUPTED, False)
    assert result.status in (Status.SOLVED, Status.OPTIMAL)
    assert result.length == 1
    return result


@pytest.mark.parametrize("search", ["astar", "greedy"])
def test_a_plan_that_is_read_when_the_signal_comes(search: str, monkeypatch: pytest.MonkeyPatch) -> None:
    result = found_in_spite_of(TraceReader, "read", monkeypatch, search=search)
    assert isinstance(result.found, FoundPlan)
    assert result.found.unchecked is Status.INTERRUPTED
    assert result.lower_bound == pytest.approx(5)


def test_plans_after_the_one_that_is_read_come_too(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(TraceReader, "read", pressing(TraceReader.read))
    plans = statehtn.top_plans(walk(), 2)
    assert [plan.unchecked for plan in plans] == [Status.INTERRUPTED] * 2
    assert (plans.status, plans.stopped, plans.unread) == (Status.SOLVED, Status.INTERRUPTED, False)


def test_a_plan_that_is_found_when_the_signal_comes(monkeypatch: pytest.MonkeyPatch) -> None:
    found_in_spite_of(StagedRun, "proves", monkeypatch)


def test_a_plan_that_is_valued_when_the_signal_comes(monkeypatch: pytest.MonkeyPatch) -> None:
    found_in_spite_of(Labels, "value", monkeypatch, objective="cvar 0.9")


def test_a_plan_whose_evar_is_worked_out_when_the_signal_comes(monkeypatch: pytest.MonkeyPatch) -> None:
    found_in_spite_of(PlanCurve, "evar", monkeypatch, objective="evar 0.9")


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
def test_a_plan_that_is_printed_when_the_signal_comes(
    number: int, arguments: list[str], monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(plan_command, "printed", pressing(printed, number=number))
    assert main(["plan", *arguments, "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["status"] == "optimal"


def test_a_second_ctrl_c_ends_what_is_printed(
    arguments: list[str], monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(plan_command, "printed", pressing(pressing(printed)))
    assert main(["plan", *arguments, "--json"]) == 130
    assert capsys.readouterr() == ("", "interrupted\n")
    assert signal.getitimer(signal.ITIMER_REAL) == (0, 0)


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_a_plan_that_is_written_when_the_signal_comes(
    number: int, arguments: list[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(files, "_replace", pressing(files._replace, number=number))
    output = tmp_path / "plan.txt"
    assert main(["plan", *arguments, "--output", str(output)]) == 0
    assert output.read_text().startswith("==>")


MODULE = """
import os, signal, time
try:
    os.kill(os.getpid(), signal.{name})
    time.sleep(0.1)
except BaseException:
    raise ImportError("modules in C do so")
done = True
"""


@pytest.mark.parametrize("name", ["SIGINT", "SIGTERM"])
def test_a_module_that_is_imported_when_the_signal_comes(
    name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.syspath_prepend(str(tmp_path))
    module = f"imported_at_{name.lower()}"
    (tmp_path / f"{module}.py").write_text(MODULE.format(name=name))

    def work() -> None:
        importlib.import_module(module)
        time.sleep(5)  # which the signal ends

    with pytest.raises(KeyboardInterrupt), signals_as_interrupt():
        work()
    assert sys.modules.pop(module).done


AFTER_THE_END = """
import atexit, os, signal, sys
import statehtn.cli, statehtn.__main__

class Late:
    def __del__(self):  # the interpreter is ending
        os.kill(os.getpid(), signal.{name})

late = Late()
atexit.register(os.kill, os.getpid(), signal.{name})
statehtn.cli.main = lambda *, is_process: 0 if is_process else 1
sys.exit(statehtn.__main__.main())
"""


@pytest.mark.parametrize("name", ["SIGINT", "SIGTERM", "SIGHUP"])
def test_a_signal_after_the_end_changes_nothing(name: str) -> None:
    run = subprocess.run(
        [sys.executable, "-c", AFTER_THE_END.format(name=name)], capture_output=True, text=True, check=False
    )
    assert (run.returncode, run.stderr) == (0, "")
