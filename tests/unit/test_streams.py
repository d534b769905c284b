"""Standard streams that are closed, full, or read no more; and what is said on a terminal."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from statehtn.cli import main, streams
from statehtn.errors import InputError, Place, printable
from statehtn.streams import own_descriptor
from tests.test_minimal import DOMAIN, PROBLEM

Capture = pytest.CaptureFixture[str]
RUN = f"{sys.executable} -m statehtn"


@pytest.fixture
def inputs(tmp_path: Path) -> str:
    (tmp_path / "domain.hddl").write_text(DOMAIN)
    (tmp_path / "problem.hddl").write_text(PROBLEM)
    return f"'{tmp_path}/domain.hddl' '{tmp_path}/problem.hddl'"


def shell(command: str) -> tuple[int, str, str]:
    """Run a shell's command; returns its exit code and what it printed."""
    done = subprocess.run(["bash", "-c", command], capture_output=True, text=True, check=False, timeout=120)
    return done.returncode, done.stdout, done.stderr


def test_closed_streams_are_silent(inputs: str, tmp_path: Path) -> None:
    code, output, errors = shell(f"{RUN} plan {inputs} --quiet 2>&-")
    assert (code, output, errors) == (0, "(take-car)\n", "")
    assert shell(f"{RUN} plan {inputs} --json >&-") == (0, "", "")
    target = tmp_path / "plan"  # must not get the number of a closed stream
    assert shell(f"{RUN} plan {inputs} --output '{target}' <&- >&- 2>&-") == (0, "", "")
    assert target.read_text().startswith("==>\n0 take-car\n")
    assert shell(f"{RUN} plan {inputs} --alpha 2 2>&-") == (2, "", "")


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="this system has no /dev/full")
@pytest.mark.parametrize("arguments", ["--version", "--help", "plan --help", "plan INPUTS", "top 2 INPUTS"])
def test_a_full_disk_is_told_in_one_line(arguments: str, inputs: str) -> None:
    code, _, errors = shell(f"{RUN} {arguments.replace('INPUTS', inputs)} > /dev/full")
    assert (code, errors) == (74, "error: cannot write to standard output: No space left on device\n")
    code, _, _ = shell(f"{RUN} {arguments.replace('INPUTS', inputs)} > /dev/full 2> /dev/full")
    assert code == 74


@pytest.mark.parametrize("arguments", ["--version", "--help", "plan --help"])
def test_a_reader_that_has_gone_is_no_error(arguments: str) -> None:
    assert shell(f"{RUN} {arguments} | true; exit ${{PIPESTATUS[0]}}") == (0, "", "")


def test_control_characters_are_shown() -> None:
    assert printable("a\x1b[31m\tb\nc\x7f\x85\u202e\udc80ü€") == "a\\x1b[31m\\tb\nc\\x7f\\x85\\u202e\\udc80ü€"
    assert str(InputError("bad '\x1b]0;x\x07'", Place("\x1b.hddl", 1, 2))) == "\\x1b.hddl:1:2: bad '\\x1b]0;x\\x07'"


def test_names_with_control_characters_do_not_drive_the_terminal(tmp_path: Path, capsys: Capture) -> None:
    name = str(tmp_path / "\x1b[31m.hddl")
    assert main(["plan", name, name]) == 30
    assert main(["plan", "--output", "\x1b[31m/x", name, name]) == 2
    assert main(["plan", name, "--\x1b[31m"]) == 2
    captured = capsys.readouterr()
    assert "\x1b" not in captured.out + captured.err
    assert captured.err.count("\\x1b[31m") >= 3


def test_a_mistake_is_one_line_whatever_its_files_are_called(tmp_path: Path, capsys: Capture) -> None:
    name = str(tmp_path / "no\nsuch\x85file")
    for arguments in (
        ["plan", name, name],
        ["plan", name, name, "--costs", name],
        ["validate", name, name, name],
        ["plan", "--output", f"{name}/plan", name, name],
        ["plan", name, name, "--output", name],
        ["graph", name, name, "--output", name],
        ["report", name, "--output", "page.html"],
        ["compare", "--suite", name],
        ["plan", name, name, "--a\nb"],
    ):
        assert main(arguments) in (2, 30)
        captured = capsys.readouterr()
        assert (captured.out, captured.err.count("\n"), "\\n" in captured.err) == ("", 1, True), captured.err


def test_what_is_said_stands_above_the_progress_line(capsys: Capture) -> None:
    streams.show_progress("0.1 s, 17 expanded")
    streams.say("warning: twice")
    streams.show_progress("")
    streams.say("and now without it")
    clear = streams.CLEAR_LINE
    assert capsys.readouterr().err == (
        f"{clear}0.1 s, 17 expanded{clear}warning: twice\n0.1 s, 17 expanded{clear}and now without it\n"
    )


def test_own_descriptors(tmp_path: Path) -> None:
    reading, writing = os.pipe()
    try:
        assert own_descriptor(f"/dev/fd/{reading}") == reading
        assert own_descriptor("/dev/stdin") == 0
        (tmp_path / "link").symlink_to("/dev/stdout")
        assert own_descriptor(tmp_path / "link") == 1
    finally:
        os.close(reading)
        os.close(writing)
    (tmp_path / "circle").symlink_to("circle")
    for name in (tmp_path / "none", tmp_path / "circle", tmp_path, "\0", "", "x" * 5000, os.devnull):
        assert own_descriptor(name) is None
