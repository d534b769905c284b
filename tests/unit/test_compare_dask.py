"""`statehtn compare --dask`: workers, clients and clusters on loopback are lost in the middle, rows are not."""

from __future__ import annotations

import csv
import json
import os
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

import statehtn
import statehtn.experiments.cluster
from statehtn.cli import main
from statehtn.experiments.records import KEY_COLUMNS
from statehtn.experiments.run import Grid
from statehtn.experiments.suites import runs_of
from tests.test_minimal import DOMAIN, PROBLEM
from tests.unit.test_planner import ENDLESS_DOMAIN, ENDLESS_PROBLEM

EASY = 4
HARD = 3
HARD_SECONDS = 1
PATIENCE = 120.0

needs_proc = pytest.mark.skipif(not Path("/proc/self/cmdline").exists(), reason="needs /proc to look for processes")


def wait_for(condition: Callable[[], object]) -> None:
    end = time.monotonic() + PATIENCE
    while not condition():
        assert time.monotonic() < end
        time.sleep(0.02)


class Cluster:
    """A scheduler and two workers with one thread each, as processes of their own."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self._file = folder / "scheduler.json"
        self._processes: list[subprocess.Popen[bytes]] = []
        options = ["--host", "127.0.0.1", "--no-dashboard", "--scheduler-file", str(self._file)]
        self.scheduler = self._start("scheduler", "--port", "0", *options)
        wait_for(lambda: self._file.exists() and self._file.read_text().endswith("}"))
        self.address: str = json.loads(self._file.read_text())["address"]
        self.workers = [self._start("worker", "--nthreads", "1", "--no-nanny", *options) for _ in range(2)]
        logs = [folder / name for name in ("log-1", "log-2")]
        wait_for(lambda: all("Registered" in log.read_text() for log in logs))

    def _start(self, *words: str) -> subprocess.Popen[bytes]:
        environment = {**os.environ, "TMPDIR": str(self.folder)}
        with open(self.folder / f"log-{len(self._processes)}", "wb") as log:
            process = subprocess.Popen([sys.executable, "-m", "dask", *words], stdout=log, stderr=log, env=environment)
        self._processes.append(process)
        return process

    def stop(self) -> None:
        for process in reversed(self._processes):
            process.kill()
            process.wait()

    def running(self) -> dict[str, int]:
        """Return the runs that are being executed: process, and that of its worker."""
        found = {}
        for process in Path("/proc").glob("[0-9]*"):
            try:
                words = (process / "cmdline").read_bytes().decode(errors="replace").split("\0")
                parent = int((process / "stat").read_text().rpartition(")")[2].split()[1])
            except OSError:
                continue
            if "statehtn.experiments.child" in words and any(word.startswith(str(self.folder)) for word in words):
                found[process.name] = parent
        return found


@pytest.fixture
def cluster(tmp_path: Path) -> Iterator[Cluster]:
    pytest.importorskip("distributed", reason="needs the package 'distributed'")
    folder = tmp_path / "cluster"
    folder.mkdir()
    cluster = Cluster(folder)
    try:
        yield cluster
    finally:
        cluster.stop()


@pytest.fixture
def tree(tmp_path: Path) -> Path:
    root = tmp_path / "tree"
    for name, domain, problem, count in (("a", ENDLESS_DOMAIN, ENDLESS_PROBLEM, HARD), ("b", DOMAIN, PROBLEM, EASY)):
        (root / name).mkdir(parents=True)
        (root / name / "domain.hddl").write_text(domain)
        for number in range(count):
            (root / name / f"p{number}.hddl").write_text(problem)
    return root


def command(tree: Path, address: str) -> list[str]:
    limits = ["--time-limit", str(HARD_SECONDS), "--memory-limit", "1000"]
    where = ["--dask", address, "--output", str(tree.parent / "results.csv"), "--quiet"]
    return ["compare", "--suite", "ipc", "--root", str(tree), *limits, *where]


def start(tree: Path, address: str) -> subprocess.Popen[str]:
    return subprocess.Popen(
        [sys.executable, "-m", "statehtn", *command(tree, address)],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )


def rows(tree: Path) -> list[dict[str, str]]:
    path = tree.parent / "results.csv"
    if not path.exists():
        return []
    with open(path, newline="") as file:
        return list(csv.DictReader(file))


def records(tree: Path) -> list[dict[str, Any]]:
    return [json.loads(line) for line in (tree.parent / "results.jsonl").read_text().splitlines()]


def check_complete(tree: Path) -> None:
    """Check that every run has exactly one row and one record, with what must come of it."""
    expected = {("a", f"p{number}"): "time-limit" for number in range(HARD)}
    expected |= {("b", f"p{number}"): "optimal" for number in range(EASY)}
    found = [(row["domain"], row["problem"]) for row in rows(tree)]
    assert sorted(found) == sorted(expected)
    assert {(row["domain"], row["problem"]): row["status"] for row in rows(tree)} == expected
    assert sorted(tuple(record["key"]) for record in records(tree)) == sorted(
        tuple(row[column] for column in KEY_COLUMNS) for row in rows(tree)
    )
    assert {record["run"]["instance"]["problem_file"] for record in records(tree)} == {
        str(tree / domain / f"{problem}.hddl") for domain, problem in expected
    }


@needs_proc
def test_the_client_is_interrupted(tree: Path, cluster: Cluster) -> None:
    client = start(tree, cluster.address)
    wait_for(lambda: rows(tree) and cluster.running())
    client.send_signal(signal.SIGINT)
    output, errors = client.communicate(timeout=PATIENCE)
    assert (client.returncode, output) == (130, "")
    assert errors.count("\n") == 1
    assert "goes on where it stopped" in errors
    wait_for(lambda: not cluster.running())
    before = rows(tree)
    assert 0 < len(before) < EASY + HARD
    assert main(command(tree, cluster.address)) == 0
    assert rows(tree)[: len(before)] == before
    check_complete(tree)
    assert main(command(tree, "127.0.0.1:1")) == 0  # nothing is left to do


@needs_proc
def test_a_worker_is_killed_in_the_middle(tree: Path, cluster: Cluster) -> None:
    client = start(tree, cluster.address)
    wait_for(lambda: rows(tree) and set(cluster.running().values()) == {worker.pid for worker in cluster.workers})
    cluster.workers[0].kill()
    output, errors = client.communicate(timeout=PATIENCE)
    assert (client.returncode, output, errors) == (0, "", "")
    check_complete(tree)


@needs_proc
def test_the_cluster_is_lost(tree: Path, cluster: Cluster) -> None:
    (tree / "b/p0.hddl").write_text(PROBLEM.replace("(home)", "(nowhere)"))
    (tree / "c").mkdir()
    (tree / "c/p0.hddl").write_text(PROBLEM)
    client = start(tree, cluster.address)
    wait_for(lambda: len(rows(tree)) >= HARD // 2 + EASY)
    cluster.scheduler.kill()
    output, errors = client.communicate(timeout=PATIENCE)
    assert (client.returncode, output) == (69, "")
    assert errors.endswith(f"error: the Dask cluster at '{cluster.address}' is lost\n")


@needs_proc
def test_what_goes_wrong_on_a_worker(
    tree: Path, cluster: Cluster, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    shutil.rmtree(tree / "a")
    (tree / "b/p0.hddl").write_text(PROBLEM.replace("(home)", "(nowhere)"))
    (tree / "b/other-domain.hddl").write_text(DOMAIN)  # now nothing says which domain is that of c/p0
    (tree / "c").mkdir()
    (tree / "c/p0.hddl").write_text(PROBLEM)
    with monkeypatch.context() as patch:
        patch.setattr(statehtn, "__version__", "0.0", raising=False)
        assert main(command(tree, cluster.address)) == 69
    assert "the client 0.0" in capsys.readouterr().err
    assert rows(tree) == []
    assert main(command(tree, cluster.address)) == 0
    found = {tuple(record["key"][:2]): record for record in records(tree)}
    assert len(rows(tree)) == len(found) == EASY + 1
    for name, file in ((("b", "p0"), "b/p0.hddl"), (("c", "p0"), "c/domain.hddl")):
        assert found[name]["status"] == "input-error"
        assert str(tree / file) in found[name]["message"]
        assert str(cluster.folder) not in found[name]["message"]


def test_a_run_that_kills_its_workers_is_recorded(tree: Path) -> None:
    distributed = pytest.importorskip("distributed", reason="needs the package 'distributed'")

    class GivenUp:
        status = "error"

        def result(self, **_: float) -> None:
            raise self.exception()

        def exception(self) -> Exception:
            return distributed.KilledWorker("p0", SimpleNamespace(address="tcp://127.0.0.1:1"), 3)

    run = runs_of("ipc", Grid(), tree)[0]
    record = statehtn.experiments.cluster._record(GivenUp(), run, "")
    assert (record.run, record.status, record.result) == (run, "killed", None)
    assert "workers were lost" in record.message
    assert "\n" not in record.message
    assert record.row()["status"] == "killed"


@pytest.mark.parametrize(
    ("address", "code", "words"),
    [("127.0.0.1:1", 69, "no Dask scheduler"), ("magic", 2, "'magic'"), ("", 2, "''"), ("magic://x:1", 2, "scheme")],
)
def test_no_cluster(
    tree: Path,
    address: str,
    code: int,
    words: str,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    pytest.importorskip("distributed", reason="needs the package 'distributed'")
    monkeypatch.setattr(statehtn.experiments.cluster, "CONNECT_SECONDS", 0.5)
    assert main(command(tree, address)) == code
    captured = capsys.readouterr()
    assert captured.out == ""
    assert captured.err.count("\n") == 1
    assert words in captured.err
    assert rows(tree) == []


def test_dask_is_not_installed(tree: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    monkeypatch.setitem(sys.modules, "distributed", None)
    assert main(command(tree, "127.0.0.1:1")) == 2
    assert capsys.readouterr().err.endswith("pip install 'statehtn[dask]'\n")


def test_jobs_are_the_workers_business(tree: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main([*command(tree, "127.0.0.1:1"), "--jobs", "2"]) == 2
    assert "--dask" in capsys.readouterr().err
