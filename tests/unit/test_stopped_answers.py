"""`check` and `why` at their limits, and on Ctrl-C: what was found by then comes out, and the exit code says why."""

from __future__ import annotations

import json
import signal
from pathlib import Path
from typing import NoReturn

import pytest

from statehtn.cli.program import main
from statehtn.explanation import deepest, explanation
from statehtn.inspection import inspection
from statehtn.limits import LimitReached
from statehtn.model.status import Status
from statehtn.reference.find_plans import successors
from tests.pages import ROOT, blocks
from tests.processes import start, wait_until_signals_are_caught
from tests.unit.test_interrupted_policies import AT_LEAST_ENDED, SECONDS_OF_WORK, wait_for_work

PAGE = {block.title: block.text for block in blocks((ROOT / "docs" / "why.md").read_text(encoding="utf-8"))}
DOMAIN, UNREACHABLE, FORBIDDEN = (PAGE[name] for name in ("transport.hddl", "p1.hddl", "p2.hddl"))
LARGE = """(define (domain large) (:types place) (:predicates (road ?a ?b - place) (unused))
  (:task go :parameters ())
  (:method m-go :parameters (?a ?b ?c ?d ?e ?f - place) :task (go) :ordered-subtasks (and (drive ?a ?b ?c ?d ?e ?f)))
  (:action drive :parameters (?a ?b ?c ?d ?e ?f - place)
    :precondition (and (road ?a ?b) (road ?b ?c) (road ?c ?d) (road ?d ?e) (road ?e ?f))
    :effect (and (not (road ?a ?b)) (road ?b ?a))))"""
PLACES = [f"p{number}" for number in range(60)]


def stopped_by(status: Status) -> BaseException:
    return KeyboardInterrupt() if status is Status.INTERRUPTED else LimitReached(status)


@pytest.fixture(autouse=True)
def files(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    roads = " ".join(f"(road {a} {b})" for a in PLACES for b in PLACES)
    large = f"(define (problem q) (:domain large) (:objects {' '.join(PLACES)} - place) (:htn :subtasks (and (go))) "
    texts = {
        "d": DOMAIN,
        "unreachable": UNREACHABLE,
        "forbidden": FORBIDDEN,
        "large": LARGE,
        "q": f"{large}(:init {roads}))",
    }
    for name, text in texts.items():
        Path(f"{name}.hddl").write_text(text, encoding="utf-8")


CODES = [(Status.TIME_LIMIT, 20), (Status.MEMORY_LIMIT, 21), (Status.INTERRUPTED, 130)]


@pytest.mark.parametrize(("status", "code"), CODES)
@pytest.mark.parametrize("form", ["text", "json", "github"])
def test_check_says_what_it_has_found(
    status: Status, code: int, form: str, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def reached(*_: object) -> NoReturn:
        raise stopped_by(status)

    monkeypatch.setattr(inspection, "reached", reached)
    assert main(["check", "large.hddl", "q.hddl", "--format", form]) == code
    printed = capsys.readouterr()
    if form == "json":
        found = json.loads(printed.out)
        assert found["stopped"] == status.value
        assert [finding["code"] for finding in found["findings"]] == ["unused-predicate"]
        return
    assert "unused" in printed.out
    assert ("not all was looked at: 0 errors, 0 warnings, 1 note until then" in printed.out) == (form == "text")
    assert printed.err.splitlines()[-1] in ("error: the time limit was reached", "error: the memory limit was reached",
                                            "interrupted")  # fmt: skip


@pytest.mark.parametrize(("status", "code"), CODES)
def test_why_says_what_it_has_found(
    status: Status, code: int, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def stop(*_: object) -> NoReturn:
        raise stopped_by(status)

    monkeypatch.setattr(explanation, "smallest_additions", stop)
    assert main(["why", "d.hddl", "unreachable.hddl"]) == code
    assert "neither ':init' nor an action makes it true" in capsys.readouterr().out
    monkeypatch.setattr(explanation, "any_plan", stop)
    assert main(["why", "d.hddl", "forbidden.hddl", "--json"]) == code
    assert json.loads(capsys.readouterr().out)["status"] == status.value


def test_an_exploration_that_is_interrupted_is_told(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    calls = 0

    def interrupted(*arguments: object) -> object:
        nonlocal calls
        calls += 1
        if calls > 8:
            raise KeyboardInterrupt
        return successors(*arguments)  # type: ignore[arg-type]

    monkeypatch.setattr(deepest, "successors", interrupted)
    assert main(["why", "d.hddl", "forbidden.hddl"]) == 130
    assert "There is no plan" in capsys.readouterr().out


@pytest.mark.skipif(not Path("/proc/self/stat").exists(), reason="asks /proc how long a process has worked")
@pytest.mark.parametrize("command", [["check", "--format", "json"], ["why", "--json"]])
def test_ctrl_c_while_a_large_problem_is_looked_at(command: list[str]) -> None:
    name, *form = command
    with start(name, "large.hddl", "q.hddl", *form, "--memory-limit", "1500") as process:
        wait_until_signals_are_caught(process)
        wait_for_work(process, SECONDS_OF_WORK)
        process.send_signal(signal.SIGINT)
        out, err = process.communicate(timeout=AT_LEAST_ENDED)
    assert process.returncode == 130
    assert "Traceback" not in err
    found = json.loads(out)
    if name == "check":
        assert [finding["code"] for finding in found["findings"]] == ["unused-predicate"]
    else:
        assert found["status"] == "interrupted"


@pytest.mark.parametrize(("option", "code"), [(("--time-limit", "1"), 20), (("--memory-limit", "90"), 21)])
@pytest.mark.parametrize("command", ["check", "why"])
def test_limits_of_a_large_problem(command: str, option: tuple[str, str], code: int) -> None:
    with start(command, "large.hddl", "q.hddl", *option) as process:
        _, err = process.communicate(timeout=AT_LEAST_ENDED)
    assert process.returncode == code
    assert "Traceback" not in err
