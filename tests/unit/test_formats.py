"""The forms in which `statehtn plan` prints a result, completion by a shell, and the version."""

from __future__ import annotations

import csv
import json
import shutil
import subprocess
from pathlib import Path

import pytest

import statehtn
from statehtn.cli import main

AV = [str(Path(__file__).parents[2] / "domains" / "av" / name) for name in ("domain.hddl", "p1.hddl")]
UNSOLVABLE = (
    "(define (domain d) (:predicates (p)) (:task t) (:method m :task (t) :precondition (p) :subtasks (and)))",
    "(define (problem q) (:domain d) (:htn :subtasks (and (t))) (:init))",
)


def output(capsys: pytest.CaptureFixture[str], *arguments: str) -> str:
    assert main(["plan", *AV, *arguments]) == 0
    return capsys.readouterr().out


def test_the_actions_of_a_plan_as_csv(capsys: pytest.CaptureFixture[str]) -> None:
    rows = list(csv.DictReader(output(capsys, "--format", "csv").splitlines()))
    result = statehtn.plan(statehtn.read_hddl(*AV))
    assert [(row["action"], row["arguments"]) for row in rows] == [
        (priced.step.action, " ".join(priced.step.arguments)) for priced in result.steps
    ]
    assert sum(float(row["expected_cost"]) for row in rows) == pytest.approx(18.35)
    for row, priced in zip(rows, result.steps, strict=True):
        outcomes = [tuple(map(float, outcome.split(":"))) for outcome in row["law"].split()]
        assert statehtn.CostDistribution.of(outcomes) == priced.law


def test_a_plan_in_the_format_of_the_competition_is_valid(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    text = output(capsys, "--format", "ipc")
    problem = statehtn.read_hddl(*AV)
    assert statehtn.validate(problem, statehtn.read_plan(text, problem))
    file = tmp_path / "plan"
    output(capsys, "--output", str(file))
    assert file.read_text() == text


def test_json_has_two_names(capsys: pytest.CaptureFixture[str]) -> None:
    texts = [output(capsys, *form) for form in (["--json"], ["--format", "json"])]
    assert [json.loads(text)["status"] for text in texts] == ["optimal", "optimal"]


@pytest.mark.parametrize("form", ["csv", "ipc"])
def test_without_a_plan_nothing_is_printed_and_the_reason_is_said(
    form: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    files = [tmp_path / "domain", tmp_path / "problem"]
    for file, text in zip(files, UNSOLVABLE, strict=True):
        file.write_text(text)
    assert main(["plan", *map(str, files), "--format", form]) == 10
    captured = capsys.readouterr()
    assert captured.out == ""
    assert "unsolvable" in captured.err


def test_two_things_do_not_share_standard_output(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["plan", *AV, "--format", "csv", "--output", "-"]) == 2
    assert "both the result (csv) and the plan of --output would go to standard output" in capsys.readouterr().err
    assert main(["plan", *AV, "--json", "--quiet"]) == 2


def test_the_version_says_by_what_the_core_was_compiled(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["--version"]) == 0
    text = capsys.readouterr().out
    assert text.startswith(f"statehtn {statehtn.__version__} (core: ")
    assert "; Python 3." in text


def test_a_shell_completes_commands_and_values(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    pytest.importorskip("shtab")
    bash = shutil.which("bash")
    assert bash is not None
    assert main(["completion", "bash"]) == 0
    script = tmp_path / "completion"
    script.write_text(capsys.readouterr().out)
    asked = f"source {script}; COMP_WORDS=(statehtn {{}}); COMP_CWORD={{}}; _shtab_statehtn; echo ${{{{COMPREPLY[@]}}}}"

    def completed(words: str, count: int) -> list[str]:
        run = subprocess.run([bash, "-c", asked.format(words, count)], capture_output=True, text=True, check=True)
        return run.stdout.split()

    assert {"plan", "atlas", "check"} <= set(completed("", 1))
    assert completed("plan --attitude av", 3) == ["averse"]
    assert "--objective" in completed("plan --obj", 2)
