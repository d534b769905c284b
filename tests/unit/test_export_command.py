"""`statehtn export --prism`: the decision process that can be reached, and the chain of a policy."""

from __future__ import annotations

from pathlib import Path

import pytest

from statehtn.cli.program import main

GRIPPER = ("domains/gripper-robot/domain.hddl", "domains/gripper-robot/p1.hddl")


def values(file: Path, *formulas: str) -> list[float]:
    stormpy = pytest.importorskip("stormpy", reason="Storm is not installed (extra 'check')")
    program = stormpy.parse_prism_program(str(file))
    found = []
    for formula in formulas:
        (wanted,) = stormpy.parse_properties(formula, program)
        model = stormpy.build_model(program, [wanted])
        result = stormpy.model_checking(model, wanted, only_initial_states=True)
        found.append(float(result.get_value(model.initial_states[0])))
    return found


def test_the_decision_process(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "gripper.prism"
    assert main(["export", *GRIPPER, "--prism", str(file)]) == 0
    assert "states" in capsys.readouterr().out
    assert "mdp" in file.read_text(encoding="utf-8").splitlines()
    most, least, quick = values(file, 'Pmax=? [F "done"]', 'R{"cost"}min=? [F "done"]', 'Pmax=? [F{"cost"}<=5 "done"]')
    assert most == pytest.approx(1)
    assert quick == pytest.approx(0.75)
    assert least == pytest.approx(5, rel=1e-5)


def test_the_chain_of_the_best_policy(tmp_path: Path) -> None:
    file = tmp_path / "policy.prism"
    assert main(["export", *GRIPPER, "--policy", "--prism", str(file)]) == 0
    assert "dtmc" in file.read_text(encoding="utf-8").splitlines()
    (cost,) = values(file, 'R{"cost"}=? [F "done"]')
    assert cost == pytest.approx(5, rel=1e-5)


@pytest.mark.parametrize(
    "options", [("--objective", "success"), ("--attitude", "averse", "--alpha", "0.3"), ("--precision", "0.1")]
)
def test_the_decision_process_has_no_objective(
    options: tuple[str, ...], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file = tmp_path / "gripper.prism"
    assert main(["export", *GRIPPER, "--prism", str(file), *options]) == 2
    assert f"error: {options[0]} says which policy is the best" in capsys.readouterr().err
    assert not file.exists()


def test_giving_up_is_a_decision_of_the_process(tmp_path: Path) -> None:
    file = tmp_path / "gripper.prism"
    assert main(["export", *GRIPPER, "--prism", str(file), "--failure-cost", "2"]) == 0
    (cost,) = values(file, 'R{"cost"}min=? [F ("done" | "failed")]')
    assert cost == pytest.approx(2, rel=1e-5)


def test_a_failure_cost_that_is_too_large_for_whole_numbers(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["export", *GRIPPER, "--prism", "-", "--failure-cost", "1e300"]) == 31
    assert "the costs of this problem and the failure cost of 1e+300 have no unit" in capsys.readouterr().err
    assert main(["export", *GRIPPER, "--policy", "--prism", "-", "--failure-cost", "1e300"]) == 2
    assert "too large beside the costs" in capsys.readouterr().err


def test_no_policy_no_file(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "policy.prism"
    arguments = ["export", *GRIPPER, "--policy", "--prism", str(file), "--objective", "averse 0.7"]
    assert main(arguments) == 10
    assert not file.exists()
    assert "unsolvable" in capsys.readouterr().err
