"""Which objectives policies have, and what is said of those that they do not have."""

from __future__ import annotations

import pytest

import statehtn
from statehtn.cli import main
from statehtn.errors import UnsupportedError, UsageError
from statehtn.risk import OBJECTIVES, objective
from statehtn.risk.policy_objectives import POLICY_OBJECTIVES, check_has_policies, policy_objective_of
from tests.unit.test_objective_classes import CLASSES

GRIPPER = ("domains/gripper-robot/domain.hddl", "domains/gripper-robot/p1.hddl")
OF_POLICIES = f"there are {', '.join(POLICY_OBJECTIVES)}"
COMMANDS = {
    "policy": ["policy", *GRIPPER],
    "export": ["export", *GRIPPER, "--prism", "-", "--policy"],
    "why": ["why", *GRIPPER],
}
Capture = pytest.CaptureFixture[str]


@pytest.mark.parametrize("text", CLASSES)
def test_the_forms_of_policies_are_those_that_have_policies(text: str) -> None:
    name = text.split()[0]
    if name in POLICY_OBJECTIVES:
        check_has_policies(objective(text))
        assert policy_objective_of(text) == objective(text)
        return
    with pytest.raises(UnsupportedError, match=f"no policy can be found by '{name}"):
        check_has_policies(objective(text))
    with pytest.raises(UnsupportedError, match=f"no policy can be found by '{name}':"):
        policy_objective_of(name)


@pytest.mark.parametrize("command", COMMANDS)
def test_an_unknown_objective_is_answered_with_those_of_policies(command: str, capsys: Capture) -> None:
    assert {*OBJECTIVES} - {*POLICY_OBJECTIVES} == {"mean-variance", "mean-deviation", "success-utility"}
    assert main([*COMMANDS[command], "--objective", "succes"]) == 2
    assert capsys.readouterr().err == f"error: unknown objective 'succes' (did you mean 'success'?); {OF_POLICIES}\n"


@pytest.mark.parametrize("command", [*COMMANDS.values(), ["plan", *GRIPPER]])
def test_success_takes_no_argument(command: list[str], capsys: Capture) -> None:
    assert main([*command, "--objective", "success 1"]) == 2
    assert capsys.readouterr().err == "error: objective 'success 1': it takes no numbers, found 1; write success\n"


def test_plan_takes_those_of_plans_and_of_policies(capsys: Capture) -> None:
    assert main(["plan", *GRIPPER, "--objective", "sucess"]) == 2
    assert f"(did you mean 'success'?); there are {', '.join(OBJECTIVES)}, success\n" in capsys.readouterr().err
    assert main(["plan", *GRIPPER, "--objective", " success ", "--quiet"]) == 0


def test_success_compares_no_plans(capsys: Capture) -> None:
    problem = statehtn.read_hddl(*GRIPPER)
    for wrong in ("success", statehtn.Success()):
        with pytest.raises(UsageError, match="plans are not compared by 'success', policies are"):
            statehtn.plan(problem, objective=wrong)  # type: ignore[arg-type]
    assert main(["top", "2", *GRIPPER, "--objective", "success"]) == 2
    assert "'statehtn policy' finds the one that is most likely done" in capsys.readouterr().err


@pytest.mark.parametrize("command", ["policy", "plan"])
def test_the_help_describes_them(command: str, capsys: Capture) -> None:
    assert main([command, "--help"]) == 0
    shown = capsys.readouterr().out
    assert all(f"\n  {form.form}  " in shown for form in POLICY_OBJECTIVES.values())
    assert ("mean-variance L" in shown) == (command == "plan")
