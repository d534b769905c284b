"""`statehtn compare`: what it runs, what it records, and how it says what is wrong."""

from __future__ import annotations

import csv
import json
import platform
import sys
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

import statehtn
from statehtn.cli import main
from statehtn.cli.exit_codes import ExitCode
from statehtn.errors import UsageError
from statehtn.experiments import runner
from statehtn.experiments.instances import find_instances
from statehtn.experiments.record_files import RecordFiles
from statehtn.experiments.records import COLUMNS, KEY_COLUMNS
from statehtn.experiments.run import Grid, Run
from statehtn.experiments.runner import STATUSES_WITHOUT_RESULT, execute
from tests.test_minimal import DOMAIN, PROBLEM
from tests.unit.test_planner import ENDLESS_DOMAIN, ENDLESS_PROBLEM, UNSOLVABLE

Capture = pytest.CaptureFixture[str]
ISSUE_COLUMNS = (
    "domain, problem, objective, keep, solver, heuristic, repeat, attitude, alpha, status, risk_cost, value, "
    "lower_bound, gap, expected_cost, log10_expected_utility, length, facts, actions, tasks, methods, expanded, "
    "generated, evaluated, parse_seconds, ground_seconds, search_seconds, peak_memory_mb"
)


@pytest.fixture
def tree(tmp_path: Path) -> Path:
    """Write a small tree in the layout of the competition's benchmarks."""
    texts = {
        "total-order/Errands/domain.hddl": DOMAIN,
        "total-order/Errands/p1.hddl": PROBLEM,
        "total-order/Errands/p2.hddl": UNSOLVABLE,
        "total-order/Errands/p3.hddl": PROBLEM.replace("(home)", "(nowhere)"),
        "partial-order/Endless/pfile01-domain.hddl": ENDLESS_DOMAIN,
        "partial-order/Endless/pfile01.hddl": ENDLESS_PROBLEM,
        "partial-order/Endless/pfile02-domain.hddl": DOMAIN.replace(
            "0.2 (increase (total-cost) 9)", "0.2 (oneof (home) (home))"
        ),
        "partial-order/Endless/pfile02.hddl": PROBLEM,
    }
    for name, text in texts.items():
        path = tmp_path / "tree" / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
    return tmp_path / "tree"


def compare(tree: Path, *options: str) -> int:
    return main(["compare", "--suite", "ipc", "--root", str(tree), *options])


def rows_of(path: Path) -> list[dict[str, str]]:
    with open(path, newline="") as file:
        return list(csv.DictReader(file))


def json_lines(path: Path) -> list[dict[str, Any]]:
    return [json.loads(line) for line in path.read_text().splitlines()]


def counts(table: str, name: str) -> list[int]:
    """Return runs, grounded, solved, optimal, no plan, limits and errors of a line of the summary."""
    (line,) = (line for line in table.splitlines() if line.startswith(f" {name} "))
    return [int(word) for word in line.removeprefix(f" {name}").split()[:7]]


def complaint(capsys: Capture) -> str:
    captured = capsys.readouterr()
    assert captured.out == ""
    assert captured.err.count("\n") == 1, captured.err
    assert captured.err.startswith("error: ")
    return captured.err


def test_every_run_has_its_row(tree: Path, tmp_path: Path, capsys: Capture) -> None:
    output = tmp_path / "results.csv"
    assert compare(tree, "--time-limit", "1", "--jobs", "2", "--output", str(output)) == 0
    assert output.read_text().splitlines()[0].split(",") == list(COLUMNS) == ISSUE_COLUMNS.split(", ")
    rows = {(row["domain"], row["problem"]): row for row in rows_of(output)}
    assert {name: row["status"] for name, row in rows.items()} == {
        ("partial-order/Endless", "pfile01"): "time-limit",
        ("partial-order/Endless", "pfile02"): "unsupported",
        ("total-order/Errands", "p1"): "optimal",
        ("total-order/Errands", "p2"): "unsolvable",
        ("total-order/Errands", "p3"): "input-error",
    }
    solved = rows["total-order/Errands", "p1"]
    assert [solved[column] for column in KEY_COLUMNS[2:]] == ["neutral", "", "state", "auto", "1"]
    assert float(solved["risk_cost"]) == pytest.approx(3.4)
    assert (solved["length"], solved["log10_expected_utility"]) == ("1", "")
    assert all(float(solved[column]) > 0 for column in ("parse_seconds", "peak_memory_mb", "actions"))
    assert set(list(rows["total-order/Errands", "p3"].values())[10:]) == {""}
    assert float(rows["partial-order/Endless", "pfile01"]["lower_bound"]) > 0

    records = {tuple(record["key"][:2]): record for record in json_lines(tmp_path / "results.jsonl")}
    assert records.keys() == rows.keys()
    assert "nowhere" in records["total-order/Errands", "p3"]["message"]
    found = records["total-order/Errands", "p1"]
    assert found["result"]["plan"][0]["action"] == "take-car"
    assert (found["run"]["search"], found["run"]["time_limit"], found["exit_code"]) == ("astar", 1.0, 0)
    assert found["seconds"] > 0
    assert (found["machine"], found["version"]) == (platform.node(), statehtn.__version__)

    captured = capsys.readouterr()
    told = sorted(line.split(": ")[0] for line in captured.err.splitlines())
    assert told == [
        "1 run with status input-error, of total-order/Errands p3",
        "1 run with status unsupported, of partial-order/Endless pfile02",
    ]
    assert captured.out.splitlines()[-1] == f"what the errors were: '{tmp_path / 'results.jsonl'}' (message)"
    assert counts(captured.out, "partial-order/Endless") == [2, 1, 0, 0, 0, 1, 1]
    assert counts(captured.out, "in all") == [5, 3, 1, 1, 1, 1, 2]


def test_a_grid_of_settings(tree: Path, tmp_path: Path, capsys: Capture) -> None:
    output = tmp_path / "results.csv"
    for problem in ("p2", "p3"):
        (tree / f"total-order/Errands/{problem}.hddl").unlink()
    options = ["--domain", "*Errands", "--attitude", "averse", "neutral", "--alpha", "0.5", "0.9"]
    options += ["--heuristic", "lmcut", "blind", "--heuristic", "lmcut", "--search", "astar", "greedy"]
    assert compare(tree, *options, "--jobs", "2", "--output", str(output), "--quiet") == 0
    rows = rows_of(output)
    settings = {tuple(row[column] for column in KEY_COLUMNS[2:]) for row in rows}
    assert len(settings) == len(rows) == 3 * 2 * 2
    assert ("averse 0.9", "", "state/greedy", "lmcut", "1") in settings
    assert ("neutral", "", "state", "blind", "1") in settings
    assert {row["alpha"] for row in rows if row["attitude"] == "averse"} == {"0.5", "0.9"}
    assert all(float(row["log10_expected_utility"]) < 0 for row in rows if row["attitude"] == "averse")
    assert capsys.readouterr() == ("", "")
    lines = output.read_text()
    assert compare(tree, *options, "--output", str(output)) == 0
    assert output.read_text() == lines
    assert "averse 0.9 state/greedy lmcut" in capsys.readouterr().out


def test_a_run_without_a_refinement(tmp_path: Path) -> None:
    output = tmp_path / "results.csv"
    options = ["--suite", "paper", "--domain", "av", "--problem", "p1", "--attitude", "neutral", "--solver", "state"]
    options += ["--without", "nothing", "follow_forced", "--heuristic", "lmcut", "--output", str(output), "--quiet"]
    assert main(["compare", *options]) == 0
    complete, lacking = rows_of(output)
    assert (complete["solver"], lacking["solver"]) == ("state", "state without follow_forced")
    assert complete["status"] == lacking["status"] == "optimal"
    assert complete["risk_cost"] == lacking["risk_cost"]
    assert int(complete["evaluated"]) < int(lacking["evaluated"])


def test_it_goes_on_where_it_stopped(tree: Path, tmp_path: Path) -> None:
    output = tmp_path / "results.csv"
    options = ["--domain", "*Errands", "--output", str(output)]
    assert compare(tree, *options) == 0
    whole = output.read_text()
    lines = whole.splitlines(keepends=True)
    jsonl = (tmp_path / "results.jsonl").read_text()
    output.write_text("".join(lines[:2]) + lines[2][:20])  # a torn row, and one that is missing
    (tmp_path / "results.jsonl").write_text(jsonl[:-30])
    assert compare(tree, *options) == 0
    keys = [tuple(row.values())[:8] for row in rows_of(output)]
    assert len(keys) == 3
    assert sorted(keys) == sorted(tuple(line.split(",")[:8]) for line in lines[1:])
    assert output.read_text().startswith("".join(lines[:2]))
    records = [record["key"] for record in json_lines(tmp_path / "results.jsonl")]
    assert {tuple(key) for key in records} == {key[:7] for key in keys}


@pytest.mark.parametrize(("number", "word"), [(9, "errors"), (15, None)])
def test_runs_killed_from_outside_are_done_again_on_request(
    tree: Path, tmp_path: Path, number: int, word: str | None, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A run that is killed is an error until it is asked for again; an interrupted one (15) is not recorded at all."""
    output = tmp_path / "results.csv"
    command = ["--domain", "*Errands", "--output", str(output)]
    assert compare(tree, *command, "--problem", "p1", "p3") == 0
    before = output.read_text().splitlines()
    with monkeypatch.context() as patch:
        python(tmp_path, f"import os; os.kill(os.getpid(), {number})", patch)
        assert compare(tree, *command) == (0 if word else 130)
    expected = {"p1": "optimal", "p2": "error", "p3": "input-error"} if word else {"p1": "optimal", "p3": "input-error"}
    assert {row["problem"]: row["status"] for row in rows_of(output)} == expected
    if word:
        recorded = output.read_text()
        assert compare(tree, *command) == 0
        assert compare(tree, *command, "--retry", "killed") == 0
        assert compare(tree, *command, "--retry", "errors", "--problem", "p1") == 0
        assert compare(tree, *command, "--retry", "errors", "--time-limit", "5") == 2
        assert output.read_text() == recorded
    assert compare(tree, *command, *(["--retry", word] if word else [])) == 0
    assert output.read_text().splitlines()[:3] == before
    statuses = {row["problem"]: row["status"] for row in rows_of(output)}
    assert statuses == {"p1": "optimal", "p2": "unsolvable", "p3": "input-error"}
    last = json_lines(tmp_path / "results.jsonl")[-1]
    assert (last["key"][1], last["status"]) == ("p2", "unsolvable")
    assert sorted(path.name for path in tmp_path.iterdir()) == sorted(
        ["python", "results.csv", "results.jsonl", "tree"]
    )


def test_a_table_that_is_replaced_stays_locked(tree: Path, tmp_path: Path) -> None:
    table, link = tmp_path / "results.csv", tmp_path / "link.csv"
    link.symlink_to(table)
    assert compare(tree, "--domain", "*Errands", "--output", str(link)) == 0
    table.chmod(0o640)
    runs = [replace(run_of(tree, f"p{number}", 60), memory_limit=4000) for number in (1, 2, 3)]
    with RecordFiles(str(link)) as files:
        files.forget(runs, ["optimal"])
        assert [run.instance.problem for run in files.missing(runs[:1])] == ["p1"]
        for name in (table, link):
            with pytest.raises(UsageError, match="another comparison is writing it"):
                RecordFiles(str(name))
    assert [row["problem"] for row in rows_of(table)] == ["p2", "p3"]
    assert link.is_symlink()
    assert table.stat().st_mode & 0o777 == 0o640


def test_rows_on_standard_output(tree: Path, capsys: Capture) -> None:
    assert compare(tree, "--domain", "*Errands") == 0
    captured = capsys.readouterr()
    rows = list(csv.DictReader(captured.out.splitlines()))
    assert sorted(row["problem"] for row in rows) == ["p1", "p2", "p3"]
    assert "in all" in captured.err


@pytest.mark.parametrize("options", [[], ["--quiet"], ["--output", "results.csv"]])
def test_why_runs_have_failed(
    tree: Path, tmp_path: Path, options: list[str], monkeypatch: pytest.MonkeyPatch, capsys: Capture
) -> None:
    monkeypatch.chdir(tmp_path)
    assert compare(tree, "--domain", "*Errands", "--problem", "p1", "p3", "--repeat", "2", *options) == 0
    captured = capsys.readouterr()
    (line,) = (line for line in captured.err.splitlines() if " with status " in line)
    assert line.startswith("2 runs with status input-error, first total-order/Errands p3: ")
    assert "p3.hddl:" in line
    assert "'nowhere'" in line


def test_a_crash_without_a_word_is_told(
    tree: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: Capture
) -> None:
    python(tmp_path, "raise SystemExit(3)", monkeypatch)
    assert compare(tree, "--domain", "*Errands", "--problem", "p1", "--quiet") == 0
    assert capsys.readouterr().err == "1 run with status error, of total-order/Errands p1: exit code 3\n"


def test_other_limits_are_not_mixed(tree: Path, tmp_path: Path, capsys: Capture) -> None:
    output = tmp_path / "results.csv"
    options = ["--domain", "*Errands", "--output", str(output), "--quiet"]
    assert compare(tree, *options, "--time-limit", "5") == 0
    capsys.readouterr()
    before = output.read_bytes()
    assert compare(tree, *options, "--time-limit", "6") == 2
    assert "time limit of 5 s" in complaint(capsys)
    assert output.read_bytes() == before


@pytest.mark.parametrize(
    ("options", "code", "words"),
    [
        (["--suite", "magic"], 2, "magic"),
        ([], 2, "--suite"),
        (["--suite", "ipc"], 2, "--root"),
        (["--suite", "ipc", "--root", "/no/such/folder"], 30, "/no/such/folder"),
        (["--suite", "ipc", "--root", "EMPTY"], 30, "no HDDL problem"),
        (["--suite", "ipc", "--root", "TREE", "--domain", "Magic"], 30, "Magic"),
        (["--suite", "ipc", "--root", "TREE", "--problem", "q*"], 30, "no problem called 'q*'"),
        (["--suite", "TREE/none.toml"], 30, "none.toml"),
        (["--suite", "paper", "--root", "TREE"], 30, "--root"),
        (["--suite", "ipc", "--root", "TREE", "--jobs", "0"], 2, "--jobs"),
        (["--suite", "ipc", "--root", "TREE", "--repeat", "-1"], 2, "--repeat"),
        (["--suite", "ipc", "--root", "TREE", "--time-limit", "0"], 2, "time limit"),
        (["--suite", "ipc", "--root", "TREE", "--attitude", "averse"], 2, "alpha"),
        (["--suite", "ipc", "--root", "TREE", "--alpha", "1"], 2, "alpha"),
        (["--suite", "ipc", "--root", "TREE", "--attitude", "seeking", "--alpha", "-1"], 2, "alpha"),
        (["--suite", "ipc", "--root", "TREE", "--heuristic", "magic"], 2, "magic"),
        (["--suite", "ipc", "--root", "TREE", "--without", "magic"], 2, "magic"),
        (["--suite", "ipc", "--root", "TREE", "--retry", "magic"], 2, "errors"),
        (["--suite", "ipc", "--root", "TREE", "--retry", "errors"], 2, "--output"),
        (["--suite", "ipc", "--root", "TREE", "--output", "/no/such/folder/x.csv"], 2, "/no/such/folder"),
        (["--suite", "ipc", "--root", "TREE", "--output", "EMPTY"], 2, "regular file"),
        (["--suite", "ipc", "--root", "TREE", "--output", "EMPTY/x.jsonl"], 2, "*.csv"),
    ],
)
def test_bad_options(tree: Path, tmp_path: Path, options: list[str], code: int, words: str, capsys: Capture) -> None:
    empty = tmp_path / "empty"
    empty.mkdir()
    names = [option.replace("EMPTY", str(empty)).replace("TREE", str(tree)) for option in options]
    assert main(["compare", *names]) == code
    assert words in complaint(capsys)
    assert list(empty.iterdir()) == []


@pytest.mark.parametrize(
    ("name", "content"),
    [
        ("results.csv", b"name,age\nAda,36\n"),
        ("results.csv", b"a note without a newline"),
        ("results.csv", b"\xff\xfe\x00"),
        ("results.csv", ",".join(COLUMNS).encode() + b",more\n"),
        ("results.csv", ",".join(COLUMNS).encode() + b"\na,b\n"),
        ("results.jsonl", b'{"name": "Ada"}\n'),
        ("results.jsonl", b'{"key": ["a"]}\n'),
    ],
)
def test_other_files_stay_what_they_are(tree: Path, tmp_path: Path, name: str, content: bytes, capsys: Capture) -> None:
    (tmp_path / name).write_bytes(content)
    assert compare(tree, "--output", str(tmp_path / "results.csv")) == 2
    assert name in complaint(capsys)
    assert (tmp_path / name).read_bytes() == content


def test_layouts(tmp_path: Path) -> None:
    files = {
        "domain.hddl": DOMAIN,
        "p0.hddl": PROBLEM,
        "a/b/domain.hddl": DOMAIN,
        "a/b/easy/p1.hddl": PROBLEM,
        "a/b/other/unused.hddl": f"; (define (problem\n{DOMAIN}",
        "c/domains/pfile01-domain.hddl": DOMAIN,
        "c/domains/domain.hddl": DOMAIN,
        "c/problems/pfile01.hddl": PROBLEM,
        "c/problems/pfile02.hddl": PROBLEM,
        "d/trips.hddl": DOMAIN.upper(),
        "d/p1-domain.hddl": DOMAIN,
        "d/p1.hddl": PROBLEM,
        "d/p2.hddl": PROBLEM,
        "e/p1-domain.hddl": DOMAIN,
        "e/p1.hddl": PROBLEM,
        "e/p2.hddl": PROBLEM,
    }
    root = tmp_path / "root"
    for name, text in files.items():
        (root / name).parent.mkdir(parents=True, exist_ok=True)
        (root / name).write_text(text)
    found = {
        (instance.domain, instance.problem): Path(instance.domain_file).relative_to(root).as_posix()
        for instance in find_instances(root)
    }
    assert found == {
        ("a/b", "easy/p1"): "a/b/domain.hddl",
        ("c", "problems/pfile01"): "c/domains/pfile01-domain.hddl",
        ("c", "problems/pfile02"): "c/domains/domain.hddl",
        ("d", "p1"): "d/p1-domain.hddl",
        ("d", "p2"): "d/trips.hddl",
        ("e", "p1"): "e/p1-domain.hddl",
        ("root", "e/p2"): "domain.hddl",
        ("root", "p0"): "domain.hddl",
    }
    (root / "domain.hddl").unlink()
    lost = next(instance for instance in find_instances(root) if instance.problem == "p2" and instance.domain == "e")
    record = execute(Grid().runs([lost])[0])
    assert record.status == "input-error"
    assert "domain.hddl" in record.message


def run_of(tree: Path, problem: str, time_limit: float | None) -> Run:
    (instance,) = (instance for instance in find_instances(tree) if instance.problem == problem)
    return Grid(time_limit=time_limit).runs([instance])[0]


def python(folder: Path, script: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Have a script run in place of every run."""
    program = folder / "python"
    program.write_text(f"#!{sys.executable}\n{script}\n")
    program.chmod(0o755)
    monkeypatch.setattr(sys, "executable", str(program))


def test_a_run_that_does_not_end_is_killed(tree: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(runner, "GRACE_SECONDS", -0.5)
    record = execute(run_of(tree, "pfile01", 0.8))
    assert (record.status, record.result) == ("killed", None)
    assert record.message.endswith("s, far beyond the limit of 0.8 s")
    assert record.seconds < 5


def test_a_run_that_eats_memory_is_killed(tree: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    python(tmp_path, "import time; eaten = b'x' * 300_000_000; time.sleep(60)", monkeypatch)
    monkeypatch.setattr(runner, "GRACE_MEGABYTES", 20)
    record = execute(replace(run_of(tree, "p1", 50), memory_limit=100))
    assert (record.status, record.result) == ("killed", None)
    assert "MB, far beyond the limit of 100 MB" in record.message
    assert record.seconds < 20


@pytest.mark.parametrize(
    ("script", "status", "message"),
    [
        ("import sys; sys.exit('no such luck')", "error", "no such luck"),
        ("import os; os.kill(os.getpid(), 11)", "error", "ended by signal 11"),
        ('print(\'{"status": "opti\')', "error", ""),
        ("import sys; print('error: used up', file=sys.stderr); sys.exit(21)", "memory-limit", "error: used up"),
    ],
)
def test_crashes_are_recorded(
    tree: Path, tmp_path: Path, script: str, status: str, message: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    python(tmp_path, script, monkeypatch)
    record = execute(run_of(tree, "p1", 5))
    assert (record.status, record.message, record.result) == (status, message, None)
    assert record.row()["risk_cost"] == ""


def test_the_exit_codes_are_those_of_the_command_line() -> None:
    names = {21: "MEMORY_LIMIT", 30: "INPUT_ERROR", 31: "UNSUPPORTED", 130: "INTERRUPTED"}
    assert {code: ExitCode(code).name for code in STATUSES_WITHOUT_RESULT if code > 0} == names


def test_names_with_commas_and_other_letters(tmp_path: Path) -> None:
    folder = tmp_path / 'tree/a, "b"\u00e9'
    folder.mkdir(parents=True)
    (folder / "domain.hddl").write_text(DOMAIN)
    (folder / "-p 1.hddl").write_text(PROBLEM)
    for _ in range(2):
        assert compare(tmp_path / "tree", "--output", str(tmp_path / "results.csv"), "--quiet") == 0
    (row,) = rows_of(tmp_path / "results.csv")
    assert (row["domain"], row["problem"], row["status"]) == ('a, "b"\u00e9', "-p 1", "optimal")
