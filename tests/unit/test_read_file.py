"""Files are read in pieces under limits: pipes that do not begin, devices that do not end."""

from __future__ import annotations

import contextlib
import os
import signal
import socket
import subprocess
import sys
import threading
import time
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from statehtn import InputError, read_costs, read_file, read_hddl
from statehtn.cli import files, main
from statehtn.limits import LimitReached, Limits
from statehtn.model import TypeHierarchy
from statehtn.read_file import PIECE, read_pieces

DOMAIN = "(define (domain d) (:predicates (there)) (:action go :parameters () :effect (there)))"
PROBLEM = "(define (problem p) (:domain d) (:htn :subtasks (go)) (:init))"


@pytest.fixture
def pipe(tmp_path: Path) -> Path:
    os.mkfifo(tmp_path / "pipe")
    return tmp_path / "pipe"


def test_a_pipe_that_nobody_writes_ends_at_the_limit(pipe: Path, capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(LimitReached):
        list(read_pieces(pipe, Limits.starting_now(0.1)))
    with pytest.raises(LimitReached):
        read_hddl(pipe, pipe, limits=Limits.starting_now(0.1))
    with pytest.raises(LimitReached):
        read_costs(pipe, Limits.starting_now(0.1))
    assert main(["plan", str(pipe), str(pipe), "--time-limit", "0.1"]) == 20
    assert "time limit reached" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("command", "shown"),
    [
        ("plan d.hddl p.hddl --costs pipe", "time limit reached"),
        ("top 2 d.hddl pipe", "time limit"),
        ("top 2 d.hddl p.hddl --costs pipe", "time limit"),
        ("validate pipe p.hddl a.plan", "the plan is not checked: the time limit was reached before"),
        ("validate d.hddl p.hddl pipe", "the plan is not checked: the time limit was reached before"),
        ("validate d.hddl p.hddl pipe --json", '"stopped": "time-limit"'),
        ("validate d.hddl p.hddl a.plan --costs pipe", "not decided"),
        ("compare-attitudes d.hddl pipe --alpha 1", "error: the time limit was reached"),
        ("compare-attitudes d.hddl pipe --alpha 1 --json", '"results": [{"status": "time-limit"'),
        ("compare-attitudes d.hddl p.hddl --alpha 1 --costs pipe", "error: the time limit was reached"),
    ],
)
def test_every_file_of_a_command_is_read_under_its_limits(
    pipe: Path, command: str, shown: str, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(pipe.parent)
    Path("d.hddl").write_text(DOMAIN)
    Path("p.hddl").write_text(PROBLEM)
    assert main(["plan", "d.hddl", "p.hddl", "--quiet", "--output", "a.plan"]) == 0
    assert main([*command.split(), "--time-limit", "0.1"]) == 20
    captured = capsys.readouterr()
    assert shown in captured.out + captured.err


@pytest.mark.parametrize("command", ["validate d.hddl p.hddl a.plan", "compare-attitudes d.hddl p.hddl --alpha 1"])
def test_limits_hold_while_a_reader_computes(command: str, monkeypatch: pytest.MonkeyPatch) -> None:
    def compute(*_: object, **__: object) -> None:
        end = time.monotonic() + 120
        while time.monotonic() < end:
            pass

    monkeypatch.setattr(files, "read_hddl", compute)
    assert main([*command.split(), "--time-limit", "0.1"]) == 20


@pytest.mark.parametrize("command", ["plan", "validate", "graph"])
def test_a_pipe_that_nobody_writes_can_be_interrupted(pipe: Path, command: str) -> None:
    more = {"plan": [], "validate": ["a.plan"], "graph": ["--output", "g.dot"]}[command]
    arguments = [sys.executable, "-m", "statehtn", command, str(pipe), str(pipe), *more]
    process = subprocess.Popen(arguments, stdout=subprocess.PIPE, stderr=subprocess.PIPE, cwd=pipe.parent)
    descriptor = os.open(pipe, os.O_WRONLY)  # returns when the command has opened the pipe
    process.send_signal(signal.SIGINT)
    process.communicate(timeout=120)
    os.close(descriptor)
    assert process.returncode == 130


def test_standard_input_may_be_a_socket(tmp_path: Path) -> None:
    (tmp_path / "p.hddl").write_text(PROBLEM)
    ours, theirs = socket.socketpair()
    with ours, theirs:
        ours.sendall(DOMAIN.encode())
        ours.shutdown(socket.SHUT_WR)
        command = [sys.executable, "-m", "statehtn", "plan", "-", str(tmp_path / "p.hddl"), "--quiet"]
        ended = subprocess.run(command, stdin=theirs, capture_output=True, text=True, timeout=120, check=False)
    assert (ended.returncode, ended.stderr) == (0, "")
    assert "(go)" in ended.stdout


def test_a_pipe_is_read_to_its_end(pipe: Path, tmp_path: Path) -> None:
    text = DOMAIN + "\n;" + "x" * (3 * PIECE)
    (tmp_path / "p.hddl").write_text(PROBLEM)
    writer = threading.Thread(target=pipe.write_text, args=(text,))
    writer.start()
    assert read_hddl(pipe, tmp_path / "p.hddl", limits=Limits.starting_now(60)).domain.name == "d"
    writer.join()


def test_a_device_without_an_end_is_no_text() -> None:
    with pytest.raises(InputError, match="binary"):
        read_hddl("/dev/zero", "/dev/zero")
    with pytest.raises(LimitReached):
        read_costs("/dev/zero", Limits.starting_now(0.1))
    with pytest.raises(LimitReached):
        read_costs("/dev/zero", Limits.starting_now(memory_limit=1))


@pytest.mark.parametrize("file", ["domain", "costs", "samples", "plan"])
def test_what_has_no_end_is_refused(
    file: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(read_file, "MOST_UNBOUNDED", 3 * PIECE)
    names = {name: str(tmp_path / name) for name in ("domain", "problem", "costs", "samples", "plan")}
    Path(names["domain"]).write_text(DOMAIN)
    Path(names["problem"]).write_text(PROBLEM)
    Path(names["costs"]).write_text('[[costs]]\naction = "go"\nsamples = "samples"\n')
    Path(names["samples"]).write_text("1 2")
    Path(names["plan"]).write_text("(go)\n")
    Path(names[file]).unlink()
    os.mkfifo(names[file])
    ended = threading.Event()

    def write() -> None:
        with open(names[file], "wb", buffering=0) as pipe, contextlib.suppress(BrokenPipeError):
            while not ended.is_set():
                pipe.write(b" " * PIECE)

    writer = threading.Thread(target=write)
    writer.start()
    try:
        arguments = [names["domain"], names["problem"], names["plan"], "--costs", names["costs"]]
        assert main(["validate", *arguments]) == 30
    finally:
        ended.set()
        writer.join()
    assert "is no regular file, and more than 3 MiB come out of it" in capsys.readouterr().err
    with pytest.raises(InputError, match="no regular file"):
        read_costs("/dev/zero")


def test_a_large_file_is_no_endless_one(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(read_file, "MOST_UNBOUNDED", 10)
    (tmp_path / "large").write_bytes(b" " * 20)
    assert len(read_file.read_whole(tmp_path / "large")) == 20


def test_a_name_that_no_file_can_have() -> None:
    with pytest.raises(InputError, match="cannot read"):
        read_costs("a\0b")


@given(st.lists(st.lists(st.integers(0, 9), max_size=2), min_size=10, max_size=10), st.sets(st.integers(0, 9)))
def test_types_below_are_those_that_have_them_above(above: list[list[int]], asked: set[int]) -> None:
    parents = {f"t{name}": tuple(f"t{one}" for one in found) for name, found in enumerate(above)}
    hierarchy = TypeHierarchy(parents)
    names = {f"t{one}" for one in asked}
    assert hierarchy.subtypes(names) == {name for name in parents if hierarchy.is_subtype(name, names)}
    assert hierarchy.subtypes(["object"]) == {"object", *parents}
