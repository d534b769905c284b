"""The command line as a user meets it: output, exit codes, files, signals."""

from __future__ import annotations

import json
import os
import signal
import stat
import subprocess
import sys
import time
from pathlib import Path

import pytest

from statehtn.cli import main
from statehtn.cli.exit_codes import ExitCode
from tests.processes import start, wait_until_signals_are_caught
from tests.test_minimal import DOMAIN, PROBLEM
from tests.unit.test_planner import ENDLESS_DOMAIN, ENDLESS_PROBLEM, KEYS, UNSOLVABLE

Files = dict[str, str]


@pytest.fixture
def files(tmp_path: Path) -> Files:
    texts = {
        "domain": DOMAIN,
        "problem": PROBLEM,
        "unsolvable": UNSOLVABLE,
        "endless-domain": ENDLESS_DOMAIN,
        "endless": ENDLESS_PROBLEM,
    }
    names = {}
    for name, text in texts.items():
        path = tmp_path / f"{name}.hddl"
        path.write_text(text)
        names[name] = str(path)
    return names


def test_readable_plan(files: Files, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["plan", files["domain"], files["problem"], "--attitude", "seeking", "--alpha", "0.9"]) == 0
    captured = capsys.readouterr()
    assert captured.err == ""
    for words in (
        "risk-seeking agent with alpha 0.9",
        "(take-car)",
        "2 w.p. 0.8, 9 w.p. 0.2",
        "optimal: no plan of this problem has a higher expected utility",
        "PS10110",
        "log10 EU",
    ):
        assert words in captured.out
    assert "\x1b" not in captured.out
    assert all(line == line.rstrip() for line in captured.out.splitlines())


def test_json(files: Files, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["plan", files["domain"], files["problem"], "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert list(found) == KEYS
    assert found["statistics"]["parse_seconds"] >= 0
    assert found["statistics"]["peak_memory_mb"] > 1


def test_quiet(files: Files, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["plan", files["domain"], files["problem"], "--quiet"]) == 0
    assert capsys.readouterr().out == "(take-car)\n"


def test_unsolvable(files: Files, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["plan", files["domain"], files["unsolvable"]]) == 10
    assert "proven that this problem has no plan" in capsys.readouterr().out
    assert main(["plan", files["domain"], files["unsolvable"], "--json"]) == 10
    assert json.loads(capsys.readouterr().out)["plan"] is None
    assert main(["plan", files["domain"], files["unsolvable"], "--quiet"]) == 10
    assert capsys.readouterr().out == ""


@pytest.mark.parametrize("limit", ["0.000001", "0.3"])
def test_time_limit_in_any_phase_prints_the_object(
    files: Files, limit: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["plan", files["endless-domain"], files["endless"], "--json", "--time-limit", limit]) == 20
    found = json.loads(capsys.readouterr().out)
    assert found["status"] == "time-limit"
    assert list(found) == KEYS
    assert found["plan"] is None


def test_memory_limit(files: Files, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["plan", files["endless-domain"], files["endless"], "--json", "--memory-limit", "1"]) == 21
    assert json.loads(capsys.readouterr().out)["status"] == "memory-limit"


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_a_signal_ends_in_a_result(files: Files, tmp_path: Path, number: signal.Signals) -> None:
    pipe = tmp_path / "pipe"
    os.mkfifo(pipe)
    process = start("plan", files["endless-domain"], str(pipe), "--json", "--time-limit", "20")
    pipe.write_text(Path(files["endless"]).read_text())  # waits until the pipe is read: the command line runs
    time.sleep(1)
    process.send_signal(number)
    output, errors = process.communicate(timeout=120)
    assert process.returncode == 130
    assert errors == ""
    found = json.loads(output)
    assert found["status"] == "interrupted"
    assert found["lower_bound"] > 0


LOADING_FOR_EVER = """
import runpy, sys, time

class Slow:
    def find_spec(name, *_):
        time.sleep(60 if name == "statehtn.cli" else 0)

sys.meta_path.insert(0, Slow)
runpy.run_module("statehtn", run_name="__main__", alter_sys=True)
"""


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
def test_a_signal_while_the_program_is_loaded_is_one_line(number: signal.Signals) -> None:
    process = subprocess.Popen(
        [sys.executable, "-c", LOADING_FOR_EVER], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    )
    wait_until_signals_are_caught(process)
    process.send_signal(number)
    assert process.communicate(timeout=120) == ("", "interrupted\n")
    assert process.returncode == ExitCode.INTERRUPTED


def test_output_and_validate(files: Files, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    target = tmp_path / "plan.txt"
    assert main(["plan", files["domain"], files["problem"], "--output", str(target)]) == 0
    text = target.read_text()
    assert text.startswith("==>")
    assert text.rstrip().endswith("<==")
    capsys.readouterr()
    assert main(["validate", files["domain"], files["problem"], str(target)]) == 0
    assert "valid" in capsys.readouterr().out
    target.write_text(text.replace("by-car", "by-train"))
    assert main(["validate", files["domain"], files["problem"], str(target)]) == 1
    captured = capsys.readouterr().out
    assert "invalid" in captured
    assert "because" in captured


def test_output_keeps_links_and_modes_and_leaves_nothing_behind(files: Files, tmp_path: Path) -> None:
    folder = tmp_path / "out"
    folder.mkdir()
    (folder / "real").write_text("old")
    (folder / "real").chmod(0o640)
    (folder / "link").symlink_to("real")
    assert main(["plan", files["domain"], files["problem"], "--quiet", "--output", str(folder / "link")]) == 0
    assert sorted(path.name for path in folder.iterdir()) == ["link", "real"]
    assert (folder / "link").is_symlink()
    assert stat.S_IMODE((folder / "real").stat().st_mode) == 0o640
    assert (folder / "real").read_text().startswith("==>")


def test_no_plan_writes_no_file(files: Files, tmp_path: Path) -> None:
    target = tmp_path / "plan.txt"
    assert main(["plan", files["domain"], files["unsolvable"], "--quiet", "--output", str(target)]) == 10
    assert not target.exists()


def test_a_device_is_not_replaced(files: Files) -> None:
    assert main(["plan", files["domain"], files["problem"], "--quiet", "--output", os.devnull]) == 0
    assert not Path(os.devnull).is_file()


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="this system has no /dev/full")
def test_a_full_disk_loses_no_plan(files: Files, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["plan", files["domain"], files["problem"], "--quiet", "--output", "/dev/full"]) == 74
    captured = capsys.readouterr()
    assert captured.out == "(take-car)\n"
    assert captured.err.startswith("error: cannot write '/dev/full'")
    with open("/dev/full", "w") as full:
        process = start("plan", files["domain"], files["problem"], stdout=full)
        _, errors = process.communicate(timeout=120)
    assert process.returncode == 74
    assert errors.count("\n") == 1


def test_a_reader_that_goes_away_is_no_error(files: Files) -> None:
    reading, writing = os.pipe()
    os.close(reading)
    with os.fdopen(writing, "w") as nobody:
        process = start("plan", files["domain"], files["problem"], stdout=nobody)
        _, errors = process.communicate(timeout=120)
    assert process.returncode == 0
    assert errors == ""


def test_names_outside_the_encoding_are_printed_somehow(files: Files) -> None:
    environment = os.environ | {"PYTHONIOENCODING": "ascii", "PYTHONUTF8": "0"}
    process = start("plan", files["domain"], files["problem"], env=environment)
    output, errors = process.communicate(timeout=120)
    assert (process.returncode, errors) == (0, "")
    assert "(take-car)" in output


@pytest.mark.parametrize("command", [["--help"], ["plan", "--help"], ["validate", "--help"], ["--version"]])
def test_help(command: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    assert main(command) == 0
    assert "statehtn" in capsys.readouterr().out
