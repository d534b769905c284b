"""Mistakes on the command line and in files: one line on stderr, nothing on stdout, and the right exit code."""

from __future__ import annotations

from pathlib import Path

import pytest

from statehtn.cli import main, program
from tests.test_minimal import DOMAIN, PROBLEM

Capture = pytest.CaptureFixture[str]


def complaint(capsys: Capture) -> str:
    """Return the one line on stderr."""
    captured = capsys.readouterr()
    assert captured.out == ""
    assert captured.err.count("\n") == 1, captured.err
    assert "Traceback" not in captured.err
    return captured.err.rstrip("\n")


@pytest.fixture
def inputs(tmp_path: Path) -> list[str]:
    (tmp_path / "domain.hddl").write_text(DOMAIN)
    (tmp_path / "problem.hddl").write_text(PROBLEM)
    return [str(tmp_path / "domain.hddl"), str(tmp_path / "problem.hddl")]


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (["--attitude", "averse", "--alpha", "0"], "alpha"),
        (["--attitude", "averse", "--alpha", "-1"], "alpha"),
        (["--attitude", "averse", "--alpha", "nan"], "alpha"),
        (["--attitude", "averse"], "alpha"),
        (["--attitude", "seeking"], "alpha"),
        (["--alpha", "0.9"], "alpha"),
        (["--alpha", "much"], "--alpha"),
        (["--attitude", "brave"], "brave"),
        (["--time-limit", "-1"], "time limit"),
        (["--time-limit", "0"], "time limit"),
        (["--memory-limit", "-1"], "memory limit"),
        (["--heuristic", "magic"], "magic"),
        (["--search", "magic"], "magic"),
        (["--solver", "magic"], "magic"),
        (["--solver", "plan", "--heuristic", "lmcut"], "has no state"),
        (["--solver", "plan", "--search", "greedy"], "has no search but"),
        (["--branch", "all"], "branch"),
        (["--without", "ending"], "endings"),
        (["--solver", "plan", "--without", "endings"], "refinements"),
        (["--weight", "2"], "weight"),
        (["--search", "weighted", "--weight", "0.5"], "weight"),
        (["--json", "--quiet"], "not allowed"),
        (["--jsn"], "--jsn"),
        (["--output", "/no/such/directory/plan"], "no directory"),
        (["--output", "/"], "directory"),
    ],
)
def test_usage_errors(inputs: list[str], options: list[str], words: str, capsys: Capture) -> None:
    assert main(["plan", *inputs, *options]) == 2
    line = complaint(capsys)
    assert line.startswith("error: ")
    assert words in line


@pytest.mark.parametrize("arguments", [[], ["sing"], ["plan"], ["validate", "a", "b"]])
def test_incomplete_command_lines(arguments: list[str], capsys: Capture) -> None:
    assert main(arguments) == 2
    assert complaint(capsys).startswith("error: ")


def test_usage_is_checked_before_files_are_read(capsys: Capture) -> None:
    assert main(["plan", "missing", "missing", "--attitude", "averse"]) == 2
    assert "alpha" in complaint(capsys)


@pytest.mark.parametrize(
    ("content", "words"),
    [
        (None, "domain.hddl"),
        (b"", "empty"),
        (b"\x00\x01\x02\xff" * 100, "domain.hddl"),
        (DOMAIN.rstrip()[:-1].encode(), "domain.hddl:"),
        (DOMAIN.replace("(home)\n    :effect (and (away)", "(hoome)\n    :effect (and (away)").encode(), "hoome"),
        (DOMAIN.replace("0.8", "0.9").encode(), "sum"),
        (DOMAIN.replace("0.8", "-0.8").encode(), "negative"),
        (b"(" * 50_000_000, "domain.hddl:1:"),
    ],
    ids=["missing", "empty", "binary", "unbalanced", "unknown-predicate", "sum", "negative", "parentheses"],
)
def test_bad_domains(inputs: list[str], content: bytes | None, words: str, capsys: Capture) -> None:
    if content is None:
        Path(inputs[0]).unlink()
    else:
        Path(inputs[0]).write_bytes(content)
    assert main(["plan", *inputs]) == 30
    line = complaint(capsys)
    assert line.startswith("error: ")
    assert words in line


def test_undefined_function_value_of_a_reachable_action(inputs: list[str], capsys: Capture) -> None:
    text = DOMAIN.replace("(total-cost) 4", "(total-cost) (fare)").replace("- number)", "- number (fare) - number)")
    Path(inputs[0]).write_text(text)
    assert main(["plan", *inputs]) == 30
    captured = capsys.readouterr()
    warning, error = captured.err.splitlines()  # the best plan has the cost that the warning was about
    assert (captured.out, warning[:8], error[:6]) == ("", "warning:", "error:")
    assert "fare" in error


def test_directories_are_no_files(inputs: list[str], tmp_path: Path, capsys: Capture) -> None:
    assert main(["plan", str(tmp_path), inputs[1]]) == 30
    complaint(capsys)
    assert main(["validate", *inputs, str(tmp_path)]) == 30
    complaint(capsys)


def test_unsupported_effects(inputs: list[str], capsys: Capture) -> None:
    Path(inputs[0]).write_text(DOMAIN.replace("0.2 (increase (total-cost) 9)", "0.2 (oneof (home) (home))"))
    assert main(["plan", *inputs]) == 31
    assert "unsupported" in complaint(capsys).lower()


def test_warnings_are_lines_and_errors_if_strict(inputs: list[str], capsys: Capture) -> None:
    Path(inputs[0]).write_text(DOMAIN.replace("0.8", "0.7"))
    assert main(["plan", *inputs, "--quiet"]) == 0
    captured = capsys.readouterr()
    assert captured.out == "(take-car)\n"
    assert captured.err.startswith("warning: ")
    assert main(["plan", *inputs, "--strict"]) == 30
    complaint(capsys)


def test_plan_files_that_are_none(inputs: list[str], tmp_path: Path, capsys: Capture) -> None:
    for content in (b"", b"\xff\xfe\x00", b"==>\nroot 1\n"):
        (tmp_path / "plan").write_bytes(content)
        assert main(["validate", *inputs, str(tmp_path / "plan")]) in (1, 30)
        assert "Traceback" not in capsys.readouterr().err
    assert main(["validate", *inputs, str(tmp_path / "missing")]) == 30
    complaint(capsys)


def test_an_internal_error_asks_for_a_report(
    inputs: list[str], monkeypatch: pytest.MonkeyPatch, capsys: Capture
) -> None:
    def fail(*_: object) -> int:
        raise ZeroDivisionError("a\nmistake")

    monkeypatch.delenv("STATEHTN_DEBUG", raising=False)
    monkeypatch.setattr(program, "run_plan", fail)
    assert main(["plan", *inputs]) == 70
    line = complaint(capsys)
    assert line.startswith("internal error: ZeroDivisionError: a mistake")
    assert "please report" in line
    monkeypatch.setenv("STATEHTN_DEBUG", "1")
    assert main(["plan", *inputs]) == 70
    assert "Traceback" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("error", "code"), [(KeyboardInterrupt, 130), (MemoryError, 21), (RecursionError, 31), (BrokenPipeError, 70)]
)
def test_last_resorts(
    inputs: list[str], error: type[BaseException], code: int, monkeypatch: pytest.MonkeyPatch, capsys: Capture
) -> None:
    def fail(*_: object) -> int:
        raise error

    monkeypatch.setattr(program, "run_plan", fail)
    assert main(["plan", *inputs]) == code
    complaint(capsys)
