"""Lists of actions without a decomposition: one is found and checked, or it is proven that there is none."""

from __future__ import annotations

import itertools
import json
from pathlib import Path

import pytest

import statehtn
from statehtn import Status, Step
from statehtn.cli import main
from tests.test_minimal import DOMAIN, PROBLEM

Capture = pytest.CaptureFixture[str]
DELIVERY = """
(define (domain delivery)
  (:types place)
  (:predicates (at ?p - place) (fresh))
  (:functions (total-cost) - number)
  (:task tour :parameters (?p - place))
  (:method go-on :parameters (?p ?q - place) :task (tour ?p) :precondition (fresh)
    :ordered-subtasks (and (drive ?p ?q) (tour ?q)))
  (:method stop :parameters (?p - place) :task (tour ?p) :ordered-subtasks ())
  (:action drive :parameters (?p ?q - place) :precondition (and (at ?p) (not (= ?p ?q)))
    :effect (and (at ?q) (not (at ?p)) (increase (total-cost) 2)))
  (:action rest :parameters () :effect (not (fresh))))
"""
TWO_TOURS = """
(define (problem p) (:domain delivery) (:objects a B c - place)
  (:htn :tasks (and (tour a) (rest))) (:init (at a) (fresh)))
"""


@pytest.fixture
def delivery() -> statehtn.Problem:
    return statehtn.read_hddl_text(DELIVERY, TWO_TOURS)


def test_a_decomposition_is_found_and_shown(delivery: statehtn.Problem) -> None:
    validation = statehtn.validate(delivery, ["(drive a b)", "(DRIVE b a)", Step("rest")])
    assert validation.valid
    assert str(validation) == "valid"
    plan = validation.plan
    assert plan is not None
    assert [str(step) for step in plan.steps] == ["(drive a B)", "(drive B a)", "(rest)"]
    assert "(tour B)" in str(plan.decomposition)
    assert statehtn.validate(delivery, plan).valid
    assert statehtn.read_plan(statehtn.write_plan(plan, delivery), delivery).roots
    assert validation.expected_cost == 4


@pytest.mark.parametrize(
    ("actions", "words"),
    [
        (["(drive a b)"], "no decomposition of the initial network has them"),  # there is a task left
        (["(rest)", "(rest)"], "no decomposition"),
        (["(rest)", "(drive a b)", "(drive b a)"], "no decomposition"),  # nobody is fresh any more
        (["(drive b a)", "(rest)"], "step 1 (drive B a): its precondition does not hold"),
        (["(fly a b)"], "there is no action 'fly'"),
        (["(drive a)"], "expected 2 arguments, found 1"),
        ([], "no decomposition"),
    ],
)
def test_what_is_no_plan(delivery: statehtn.Problem, actions: list[str], words: str) -> None:
    validation = statehtn.validate(delivery, actions)
    assert not validation.valid
    assert validation.plan is None
    assert validation.stopped is None
    assert any(words in reason for reason in validation.reasons)
    assert str(validation).startswith("invalid:\n- ")


def test_every_list_is_judged_as_brute_force_does(delivery: statehtn.Problem) -> None:
    ways = [f"(drive {one} {other})" for one, other in itertools.permutations("abc", 2)]
    for length in range(4):
        for actions in itertools.product([*ways, "(rest)"], repeat=length):
            assert statehtn.validate(delivery, actions).valid == _is_plan(actions), actions


def _is_plan(actions: tuple[str, ...]) -> bool:
    """Tell whether a tour from a, with one rest among it, does this; after the rest it cannot go on."""
    if actions.count("(rest)") != 1:
        return False
    place = "a"
    for number, action in enumerate(actions):
        if action == "(rest)":
            return number == len(actions) - 1 or (number == len(actions) - 2 and _ends(actions[number + 1], place))
        start, end = action.strip("()").split()[1:]
        if start != place:
            return False
        place = end
    return False


def _ends(action: str, place: str) -> bool:
    """Tell whether the tour was decomposed for this drive while everybody was fresh: its first action is the drive."""
    return action.startswith(f"(drive {place} ")


def test_a_limit_leaves_it_open(delivery: statehtn.Problem) -> None:
    validation = statehtn.validate(delivery, ["(drive a b)", "(rest)"], memory_limit=1e6, time_limit=60)
    assert validation.valid
    endless = statehtn.validate(delivery, ["(drive a b)", "(drive b a)"] * 500 + ["(rest)"], memory_limit=1e6)
    assert endless.valid
    assert len(endless.costs) == 1001


def test_one_reason_once(delivery: statehtn.Problem) -> None:
    validation = statehtn.validate(delivery, ["(fly a b)"] * 100)
    assert validation.reasons[0] == (
        "step 1 (fly a B): there is no action 'fly' (likewise 99 more: steps 2, 3, 4, 5, 6 ...)"
    )
    assert len(validation.reasons) == 1


@pytest.mark.parametrize(
    "text",
    [
        "(drive a b)\n(rest)\n",
        "; found by another planner\n0: (drive a b)\n1: (REST)  ; at last\n",
        "0.000: (drive a b) [1.0]\n1.000: (rest) [1.0]\n",
        "==>\n0 drive a b\n1 rest\n<==\n",
        "(drive a b)\n\n( rest )",
    ],
)
def test_files_of_actions(tmp_path: Path, text: str, capsys: Capture) -> None:
    names = [str(tmp_path / name) for name in ("d.hddl", "p.hddl", "plan")]
    for name, content in zip(names, (DELIVERY, TWO_TOURS, text), strict=True):
        Path(name).write_text(content)
    assert main(["validate", *names]) == 0
    shown = capsys.readouterr().out
    assert "valid: these actions have a decomposition" in shown
    assert "(tour a)  by go-on" in shown
    assert main(["validate", *names, "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert (found["valid"], found["actions"]) == (True, ["(drive a B)", "(rest)"])
    problem = statehtn.read_hddl_text(DELIVERY, TWO_TOURS)
    assert statehtn.validate(problem, statehtn.read_plan(found["plan"], problem)).valid


def test_invalid_files_as_json(tmp_path: Path, capsys: Capture) -> None:
    names = [str(tmp_path / name) for name in ("d.hddl", "p.hddl", "plan")]
    for name, content in zip(names, (DOMAIN, PROBLEM, "(take-train)\n(take-train)\n"), strict=True):
        Path(name).write_text(content)
    assert main(["validate", *names, "--json"]) == 1
    found = json.loads(capsys.readouterr().out)
    assert (found["valid"], found["plan"], found["stopped"], found["executed"]) == (False, None, None, 1)
    assert main(["validate", *names, "--time-limit", "0.000001", "--json"]) == 20
    found = json.loads(capsys.readouterr().out)
    assert (found["valid"], found["stopped"]) == (None, Status.TIME_LIMIT.value)
    Path(names[2]).write_text("(take-train)\nand then home\n")
    assert main(["validate", *names]) == 30
    assert "plan:2:1: expected an action such as (drive a b), found 'and then home'" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("domain", "code"),
    [
        (DELIVERY, 0),
        (DELIVERY.replace("(tour ?p) :ordered-subtasks ()", "(tour ?p) :ordered-subtasks (and (rest))"), 1),
    ],
)
@pytest.mark.parametrize("text", ["", "\n", "; nothing to do\n", "==>\n<==\n"])
def test_an_empty_list_is_a_list(tmp_path: Path, domain: str, code: int, text: str, capsys: Capture) -> None:
    names = [str(tmp_path / name) for name in ("d.hddl", "p.hddl", "plan")]
    for name, content in zip(names, (domain, TWO_TOURS.replace("(rest)", ""), text), strict=True):
        Path(name).write_text(content)
    assert main(["plan", *names[:2], "--quiet"]) == 0
    assert (capsys.readouterr().out == "") == (code == 0)
    assert main(["validate", *names, "--json"]) == code
    found = json.loads(capsys.readouterr().out)
    assert (found["valid"], found["actions"]) == (code == 0, [])
