"""Ctrl-C while a policy is searched for: the best policy so far and both values come out, and whole JSON objects."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import time
from pathlib import Path

import pytest

import statehtn
from statehtn import Status
from statehtn.limits import LimitReached
from statehtn.policies import total_cost
from statehtn.policies.totals import Totals
from tests.processes import start, wait_until_signals_are_caught

SECONDS_OF_WORK = 2.0
"""Of the processor, after which a run has long begun to search."""
AT_LEAST_ENDED = 60.0
BALLS = 9
LONG = """(define (domain long) (:types ball) (:predicates (held ?b - ball))
  (:task get :parameters (?b - ball))
  (:task check :parameters (?b - ball))
  (:method m-quick :parameters (?b - ball) :task (get ?b) :ordered-subtasks (and (quick ?b) (check ?b)))
  (:method m-slow :parameters (?b - ball) :task (get ?b) :ordered-subtasks (and (slow ?b)))
  (:method m-held :parameters (?b - ball) :task (check ?b) :precondition (held ?b) :subtasks ())
  (:method m-again :parameters (?b - ball) :task (check ?b) :ordered-subtasks (and (get ?b)))
  (:action quick :parameters (?b - ball) :precondition ()
    :effect (and (probabilistic 0.5 (increase (total-cost) 1) 0.5 (increase (total-cost) 3))
      (probabilistic 0.6 (held ?b) 0.4 ())))
  (:action slow :parameters (?b - ball) :precondition () :effect (and (increase (total-cost) 4) (held ?b))))"""
ENDLESS = """(define (domain endless) (:predicates (held))
  (:task get :parameters ())
  (:task check :parameters ())
  (:method m-get :parameters () :task (get) :ordered-subtasks (and (grasp) (check)))
  (:method m-held :parameters () :task (check) :precondition (held) :subtasks ())
  (:method m-twice :parameters () :task (check) :precondition (not (held)) :ordered-subtasks (and (get) (get)))
  (:action grasp :parameters () :precondition ()
    :effect (and (increase (total-cost) 1) (probabilistic 0.4 (held) 0.6 (not (held))))))"""


def problem(name: str) -> str:
    """Return the problem of a domain: many balls in any order, or one that may take ever more tries."""
    if name == "endless":
        return "(define (problem p) (:domain endless) (:htn :ordered-subtasks (and (get))) (:init))"
    balls = [f"b{number}" for number in range(BALLS)]
    tasks = " ".join(f"(get {ball})" for ball in balls)
    objects = " ".join(balls)
    return f"(define (problem p) (:domain long) (:objects {objects} - ball) (:htn :subtasks (and {tasks})) (:init))"


def wait_for_work(process: subprocess.Popen[str], seconds: float) -> None:
    """Wait until a process has used so much of the processor, whatever else the machine does."""
    ticks = os.sysconf("SC_CLK_TCK")
    deadline = time.monotonic() + AT_LEAST_ENDED
    while process.poll() is None and time.monotonic() < deadline:
        fields = Path(f"/proc/{process.pid}/stat").read_text(encoding="utf-8").rsplit(")", 1)[1].split()
        if (int(fields[11]) + int(fields[12])) / ticks >= seconds:
            return
        time.sleep(0.02)
    pytest.fail("the run has ended, or not begun")


@pytest.mark.skipif(not Path("/proc/self/stat").exists(), reason="asks /proc how long a process has worked")
@pytest.mark.parametrize(
    ("domain", "objective", "code", "status"),
    [
        ("long", "deadline 28", 0, "solved"),
        ("long", "cvar 0.9", 0, "solved"),
        ("long", "quantile 0.9", None, None),
        ("endless", "neutral", 130, "interrupted"),
    ],
)
def test_what_is_known_by_then_comes_out(
    domain: str, objective: str, code: int | None, status: str | None, tmp_path: Path
) -> None:
    (tmp_path / "d.hddl").write_text(LONG if domain == "long" else ENDLESS, encoding="utf-8")
    (tmp_path / "p.hddl").write_text(problem(domain), encoding="utf-8")
    files = (str(tmp_path / "d.hddl"), str(tmp_path / "p.hddl"))
    with start("policy", *files, "--objective", objective, "--json", "--memory-limit", "1500") as process:
        wait_until_signals_are_caught(process)
        wait_for_work(process, SECONDS_OF_WORK)
        process.send_signal(signal.SIGINT)
        out, err = process.communicate(timeout=AT_LEAST_ENDED)
    found = json.loads(out)
    assert "Traceback" not in err
    assert found["stopped"] == "interrupted"
    assert found["lower_bound"] is not None
    if code is None:  # a policy may or may not be there
        code, status = (0, "solved") if found["policy"] is not None else (130, "interrupted")
    assert (process.returncode, found["status"]) == (code, status)
    if code == 0:
        assert found["policy"]["nodes"]
        assert found["lower_bound"] <= found["upper_bound"]
        assert found["success_probability"] == pytest.approx(1)
    else:
        assert (found["policy"], found["upper_bound"]) == (None, None)


def test_a_limit_before_the_law_is_known_leaves_what_the_search_has_found(monkeypatch: pytest.MonkeyPatch) -> None:
    """The law of the total cost may take longer than the search: limits hold for it, too."""
    model = statehtn.read_hddl("domains/gripper-robot/domain.hddl", "domains/gripper-robot/p1.hddl")
    whole = statehtn.policy(model, objective="deadline 10")

    def too_long(*_: object) -> Totals:
        raise LimitReached(Status.TIME_LIMIT)

    monkeypatch.setattr(total_cost, "totals_of", too_long)
    stopped = statehtn.policy(model, objective="deadline 10")
    assert stopped.stopped is Status.TIME_LIMIT
    assert stopped.value == pytest.approx(whole.value)
    assert json.dumps(stopped.to_dict())
