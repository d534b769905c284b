"""The comparison runner is killed or interrupted in the middle: nothing is lost or doubled, and no child survives."""

from __future__ import annotations

import csv
import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

import pytest

from statehtn.cli import main
from tests.test_minimal import DOMAIN, PROBLEM
from tests.unit.test_planner import ENDLESS_DOMAIN, ENDLESS_PROBLEM

EASY = 5
PATIENCE = 120.0


@pytest.fixture
def tree(tmp_path: Path) -> Path:
    root = tmp_path / "tree"
    (root / "b").mkdir(parents=True)
    (root / "domain.hddl").write_text(DOMAIN)
    for number in range(EASY):
        (root / f"p{number}.hddl").write_text(PROBLEM)
    (root / "b/domain.hddl").write_text(ENDLESS_DOMAIN)
    (root / "b/p.hddl").write_text(ENDLESS_PROBLEM)
    return root


def command(tree: Path) -> list[str]:
    limits = ["--time-limit", "2", "--memory-limit", "1000"]
    output = ["--output", str(tree.parent / "results.csv"), "--quiet"]
    return ["compare", "--suite", "ipc", "--root", str(tree), *limits, "--jobs", "2", *output]


def start(tree: Path) -> subprocess.Popen[str]:
    return subprocess.Popen(
        [sys.executable, "-m", "statehtn", *command(tree)], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    )


def rows(tree: Path) -> list[dict[str, str]]:
    path = tree.parent / "results.csv"
    if not path.exists():
        return []
    with open(path, newline="") as file:
        return list(csv.DictReader(file))


def children(folder: Path) -> list[str]:
    """Return the processes that plan for a problem in a folder."""
    found = []
    for process in Path("/proc").glob("[0-9]*/cmdline"):
        try:
            words = process.read_bytes().decode(errors="replace").split("\0")
        except OSError:
            continue
        if "statehtn.experiments.child" in words and any(word.startswith(str(folder)) for word in words):
            found.append(process.parent.name)
    return found


def wait_for(condition: Callable[[], object]) -> None:
    end = time.monotonic() + PATIENCE
    while not condition():
        assert time.monotonic() < end
        time.sleep(0.02)


def check_resumed(tree: Path, before: int) -> None:
    kept = rows(tree)[:before]
    assert main(command(tree)) == 0
    found = rows(tree)
    assert found[:before] == kept
    assert sorted((row["domain"], row["problem"]) for row in found) == sorted(
        [("b", "p"), *(("tree", f"p{number}") for number in range(EASY))]
    )
    assert {row["status"] for row in found if row["domain"] == "tree"} == {"optimal"}
    assert {row["status"] for row in found if row["domain"] == "b"} == {"time-limit"}


@pytest.mark.skipif(not Path("/proc/self/cmdline").exists(), reason="needs /proc to look for child processes")
@pytest.mark.parametrize("rows_before", [0, 3])
def test_killed_runner(tree: Path, rows_before: int) -> None:
    process = start(tree)
    wait_for(lambda: len(rows(tree)) >= rows_before and children(tree))
    process.send_signal(signal.SIGKILL)
    process.communicate()
    assert len(rows(tree)) < EASY + 1
    wait_for(lambda: not children(tree))
    check_resumed(tree, len(rows(tree)))


@pytest.mark.skipif(not Path("/proc/self/cmdline").exists(), reason="needs /proc to look for child processes")
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_interrupted_runner(tree: Path, number: signal.Signals) -> None:
    process = start(tree)
    wait_for(lambda: rows(tree))
    process.send_signal(number)
    output, errors = process.communicate(timeout=PATIENCE)
    assert process.returncode == 130
    assert output == ""
    assert errors.count("\n") == 1
    assert "goes on where it stopped" in errors
    assert children(tree) == []
    check_resumed(tree, len(rows(tree)))


@pytest.mark.skipif(not Path("/proc/self/cmdline").exists(), reason="needs /proc to look for child processes")
def test_an_interrupted_child_counts_for_nothing(tree: Path) -> None:
    process = start(tree)
    wait_for(lambda: rows(tree) and children(tree / "b"))
    (child,) = children(tree / "b")
    os.kill(int(child), signal.SIGTERM)
    process.communicate(timeout=PATIENCE)
    assert process.returncode == 130
    assert "b" not in [row["domain"] for row in rows(tree)]
    check_resumed(tree, len(rows(tree)))


def test_two_runners_do_not_share_an_output(tree: Path, capsys: pytest.CaptureFixture[str]) -> None:
    process = start(tree)
    wait_for(lambda: rows(tree))
    try:
        assert main(command(tree)) == 2
        assert "another comparison" in capsys.readouterr().err
    finally:
        process.send_signal(signal.SIGINT)
        process.communicate(timeout=PATIENCE)
