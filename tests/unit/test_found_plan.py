"""Plans that are found in time and cannot be validated in time, and the effort of validating long ones."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import pytest

from statehtn import Status, found_plan, plan, read_hddl, top_plans
from statehtn.cli import main
from statehtn.hddl import read_hddl_text
from statehtn.hddl.plan_format import read_plan, write_plan
from statehtn.limits import LimitReached
from statehtn.model import Decomposition, Plan, Problem, Step
from statehtn.validation import validate
from tests.counted_limits import CountedLimits

# A walk of any length, there and back; whoever goes on must be where the method says.
WALK = """
(define (domain walk)
  (:requirements :hierarchy :method-preconditions :negative-preconditions)
  (:predicates (there) (tired) (marked ?p))
  (:task wander :parameters ())
  (:method out :parameters () :task (wander) :precondition (not (there)) :ordered-subtasks (and (go) (wander)))
  (:method home :parameters () :task (wander) :precondition (there) :ordered-subtasks (and (come) (wander)))
  (:method stay :parameters (?p) :task (wander) :precondition (and (marked ?p) (not (there))) :subtasks ())
  (:action go :parameters () :precondition (not (there))
    :effect (and (there) (tired) (when (tired) (increase (total-cost) 4))
      (probabilistic 0.5 (increase (total-cost) 2) 0.5 (increase (total-cost) 0))))
  (:action come :parameters () :precondition (there)
    :effect (and (not (there)) (increase (total-cost) 1) (when (tired) (increase (total-cost) 3)))))
"""
PROBLEM = """
(define (problem p) (:domain walk) (:objects a b)
  (:htn :ordered-subtasks (and (go) (come) (wander))) (:init (marked b)))
"""


@pytest.fixture
def files(tmp_path: Path) -> tuple[str, str]:
    (tmp_path / "d.hddl").write_text(WALK)
    (tmp_path / "p.hddl").write_text(PROBLEM)
    return str(tmp_path / "d.hddl"), str(tmp_path / "p.hddl")


def walk(length: int) -> Plan:
    """Return a plan of so many rounds, whose decomposition is as deep as it is long."""
    node = Decomposition("wander", (), "stay", ())
    for number in range(2 * length - 1, -1, -1):
        node = Decomposition("wander", (), "home" if number % 2 else "out", (number + 2, node))
    steps = tuple(Step("come" if number % 2 else "go") for number in range(2 * length + 2))
    return Plan(steps, (0, 1, node))


@pytest.mark.parametrize(
    ("ending", "stopped"),
    [
        (lambda: LimitReached(Status.TIME_LIMIT), Status.TIME_LIMIT),
        (lambda: LimitReached(Status.MEMORY_LIMIT), Status.MEMORY_LIMIT),
        (MemoryError, Status.MEMORY_LIMIT),
        (KeyboardInterrupt, Status.INTERRUPTED),
    ],
)
def test_a_plan_that_is_found_in_time_comes_out_unchecked(
    ending: Callable[[], BaseException],
    stopped: Status,
    files: tuple[str, str],
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    problem = read_hddl(*files)
    checked = plan(problem, attitude="averse", alpha=0.5)
    assert checked.status is Status.OPTIMAL
    assert checked.validated
    assert checked.statistics.validate_seconds is not None

    def end(*_: object) -> None:
        raise ending()

    monkeypatch.setattr(found_plan, "validate", end)
    result = plan(problem, attitude="averse", alpha=0.5)
    assert result.status is Status.SOLVED
    assert not result.validated
    assert result.plan == checked.plan
    assert [priced.step for priced in result.steps] == [priced.step for priced in checked.steps]
    assert [priced.risk_cost for priced in result.steps] == pytest.approx(
        [priced.risk_cost for priced in checked.steps]
    )
    assert [priced.expected_cost for priced in result.steps] == [1, 4]  # as the search has seen them
    assert result.to_dict()["validated"] is False
    assert result.lower_bound == checked.lower_bound

    best = top_plans(problem, 1)
    assert best.status is Status.SOLVED
    assert best.stopped is stopped
    assert [ranked.validated for ranked in best] == [False]

    assert main(["plan", *files]) == 0
    assert "validated             no: the run ended before the plan was checked" in capsys.readouterr().out
    assert main(["plan", *files, "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert (found["status"], found["validated"], found["length"]) == ("solved", False, 2)


def looks(problem: Problem, plan: Plan) -> int:
    limits = CountedLimits()
    assert validate(problem, plan, limits).valid
    return len(limits.looks)


def test_the_work_of_validation_is_linear_in_the_length_of_a_totally_ordered_plan(files: tuple[str, str]) -> None:
    problem = read_hddl(*files)
    small, large = looks(problem, walk(10_000)), looks(problem, walk(20_000))
    assert small > 40
    assert large < 2.2 * small


def test_a_limit_ends_validation_wherever_it_is_reached(files: tuple[str, str]) -> None:
    problem, long = read_hddl(*files), walk(1_000)
    for most in range(looks(problem, long)):
        with pytest.raises(LimitReached):
            validate(problem, long, CountedLimits(last=most + 1))


def test_a_long_plan_is_written_and_read(files: tuple[str, str]) -> None:
    problem, long = read_hddl(*files), walk(5_000)
    text = write_plan(long, problem)
    again = read_plan(text, problem)
    assert write_plan(again, problem) == text
    assert validate(problem, again).valid


def test_variables_that_a_quantified_formula_does_not_mention_cost_nothing() -> None:
    names = [f"?v{number}" for number in range(40)]
    opening = "".join(f"(forall ({name}) (exists ({name}x) " for name in names)
    domain = WALK.replace("(marked ?p) (not (there))", f"{opening} (marked ?p) {'))' * len(names)}")
    problem = read_hddl_text(domain, PROBLEM)
    assert looks(problem, walk(1)) < 100
