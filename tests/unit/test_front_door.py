"""What a stranger meets first: messages about commands, files and arguments, and figures that are true."""

from __future__ import annotations

import time
import warnings
from pathlib import Path
from typing import Any

import pytest

import statehtn
from statehtn import _relax
from statehtn.cli import main
from statehtn.core.grounding import ground
from statehtn.core.top_plans import find_top_plans
from statehtn.counted import with_article
from statehtn.limits import LimitReached, ending_by
from statehtn.model.cost.probabilities import CostWarning
from statehtn.model.status import Status
from tests.unit.test_unread_plans import PROBLEM, WALK


@pytest.fixture
def files(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> list[str]:
    monkeypatch.chdir(tmp_path)
    Path("d.hddl").write_text(WALK)
    Path("p.hddl").write_text(PROBLEM)
    return ["d.hddl", "p.hddl"]


def refused(arguments: list[str], capsys: pytest.CaptureFixture[str]) -> str:
    assert main(arguments) == 2
    out, err = capsys.readouterr()
    assert out == ""
    assert err.startswith("error: ")
    assert err.count("\n") == 1
    return err


@pytest.mark.parametrize("options", [[], ["--quiet"], ["--time-limit", "5"], ["--json", "--output", "x"]])
def test_a_misspelt_command_is_what_is_wrong(
    options: list[str], files: list[str], capsys: pytest.CaptureFixture[str]
) -> None:
    assert "there is no 'plann' (did you mean 'plan'?)" in refused(["plann", *files, *options], capsys)


@pytest.mark.parametrize("arguments", [["--verson"], ["--verson", "plann"], ["--verson", "plan", "--quiet"]])
def test_a_misspelt_option_before_the_command(arguments: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    assert "unknown option --verson" in refused(arguments, capsys)


@pytest.mark.parametrize(
    ("command", "option"), [("plan", "--output"), ("graph", "--output"), ("policy", "--svg"), ("export", "--prism")]
)
@pytest.mark.parametrize(("name", "words"), [("new/", "it is the name of a directory"), ("", "is empty")])
def test_the_name_of_no_file(
    command: str, option: str, name: str, words: str, files: list[str], capsys: pytest.CaptureFixture[str]
) -> None:
    form = ["--format", "svg"] if command == "graph" else []
    assert words in refused([command, *files, option, name, *form], capsys)
    assert not Path("new").exists()


def test_top_writes_into_a_new_folder(files: list[str]) -> None:
    assert main(["top", "1", *files, "--output", "new/", "--quiet"]) == 0
    assert [path.name for path in Path("new").iterdir()] == ["plan-1.txt"]


@pytest.mark.parametrize("form", [["--json"], ["--format", "json"], ["--format", "csv"]])
def test_two_results_on_standard_output(form: list[str], files: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    said = refused(["plan", *files, *form, "--output", "-"], capsys)
    assert f"both the result ({form[-1].removeprefix('--')}) and the plan of --output" in said


def test_a_noun_has_its_article() -> None:
    assert [with_article(noun) for noun in ("action", "Object", "type", "int")] == [
        "an action",
        "an Object",
        "a type",
        "an int",
    ]
    with pytest.raises(statehtn.InputError, match="expected the name of an action, found"):
        statehtn.read_hddl_text(WALK.replace("(:action ride", "(:action (ride)"), PROBLEM)
    with pytest.raises(statehtn.InputError, match="expected the name of an object, found"):
        statehtn.read_hddl_text(WALK, PROBLEM.replace("(:htn", "(:objects ?x) (:htn"))


@pytest.mark.parametrize("plan", [[1, 2], ((), ()), [None], [b"(ride)"]])
def test_actions_that_are_no_texts(plan: Any) -> None:
    with pytest.raises(statehtn.UsageError, match="must be a text such as"):
        statehtn.validate(statehtn.read_hddl_text(WALK, PROBLEM), plan)


def test_warnings_of_costs_point_at_the_line_of_the_caller() -> None:
    domain = WALK.replace("(increase (total-cost) 7)", "(increase (total-cost) (far))")
    domain = domain.replace("(:functions (total-cost))", "(:functions (total-cost) (far))")
    problem = statehtn.read_hddl_text(domain, PROBLEM)
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        with pytest.raises(statehtn.InputError, match="is not defined"):  # taken as 0, it is in the best plan
            statehtn.plan(problem)
    (found,) = caught
    assert found.category is CostWarning
    assert found.filename == __file__


def test_the_search_for_several_plans_takes_time(monkeypatch: pytest.MonkeyPatch) -> None:
    now = 0.0
    monkeypatch.setattr(time, "perf_counter", lambda: now)

    def slowly(*arguments: Any, **options: Any) -> Any:
        nonlocal now
        now += 3
        return find_top_plans(*arguments, **options)

    monkeypatch.setattr("statehtn.session.find_top_plans", slowly)
    plans = statehtn.top_plans(statehtn.read_hddl_text(WALK, PROBLEM), 2)
    assert plans.statistics.search_seconds == 3


def test_an_interruption_of_the_core_is_no_limit(monkeypatch: pytest.MonkeyPatch) -> None:
    assert isinstance(ending_by(Status.TIME_LIMIT), LimitReached)
    monkeypatch.setattr(_relax, "ground", lambda *_: _relax.StopReason.Interrupted)
    with pytest.raises(KeyboardInterrupt):
        ground(statehtn.read_hddl_text(WALK, PROBLEM))


@pytest.mark.parametrize(
    "command", [["check"], ["graph", "--kind", "gcv-tdg", "--format", "dot", "--output", "-"], ["why"]]
)
def test_commands_say_that_they_were_interrupted(
    command: list[str], files: list[str], monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(_relax, "ground", lambda *_: _relax.StopReason.Interrupted)
    name, *options = command
    assert main([name, *files, *options]) == 130
    assert "the interrupted" not in capsys.readouterr().err
