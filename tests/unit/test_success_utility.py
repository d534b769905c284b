"""Success probabilities times utilities: prices of costs, and what no utility may be."""

from __future__ import annotations

import json
import math
from pathlib import Path

import pytest

import statehtn
from statehtn import CostDistribution
from statehtn.cli import main
from statehtn.errors import UsageError
from statehtn.risk import SuccessUtility, objective, trajectory_utility

LAW = CostDistribution.of([(0.25, 1), (0.75, 3)])


def test_prices_are_logarithms_of_mean_utilities() -> None:
    wanted = objective("success-utility alpha=0.5")
    assert isinstance(wanted, SuccessUtility)
    assert wanted.value(LAW) == pytest.approx(-math.log(0.25 * math.exp(-0.5) + 0.75 * math.exp(-1.5)), rel=1e-12)
    assert wanted.value(CostDistribution.certain(4)) == pytest.approx(2, rel=1e-15)
    of_a_function = SuccessUtility(lambda cost: math.exp(-0.5 * cost))
    assert of_a_function.value(LAW) == pytest.approx(wanted.value(LAW), rel=1e-12)
    assert wanted.expected_utility(wanted.value(LAW)) == pytest.approx(LAW.expectation(lambda c: math.exp(-c / 2)))
    assert wanted.outcome_price(0.25) == pytest.approx(math.log(4))


@pytest.mark.parametrize("worth", [0, -1, 1.5])
def test_utilities_are_above_0_and_at_most_1(worth: float) -> None:
    with pytest.raises(UsageError, match="above 0 and at most 1"):
        SuccessUtility(lambda _: worth).value(LAW)


@pytest.mark.parametrize("utility", [0, -1, math.inf, "much", float])
def test_alpha_is_a_positive_number(utility: object) -> None:
    with pytest.raises(UsageError):
        SuccessUtility(utility)


def test_a_plan_of_actions_with_one_outcome_is_that_of_a_seeking_agent() -> None:
    """All probabilities are 1, so that only the utilities count."""
    problem = statehtn.read_hddl("domains/av/domain.hddl", "domains/av/p1.hddl")
    found = statehtn.plan(problem, objective="success-utility alpha=0.3")
    seeking = statehtn.plan(problem, objective="seeking 0.3")
    assert found.value == pytest.approx(0.3 * seeking.value, rel=1e-9)
    assert (found.status, found.problem_class, found.value_unit) == (seeking.status, "PS10112", "log-utility")
    assert found.risk_cost is None


COUNTED = [
    {"probability": 0.5, "added": ["(in-hand ball)"], "deleted": ["(hand-empty)", "(on-belt ball)"]},
    {"probability": 1.0, "added": ["(hand-empty)"], "deleted": ["(in-hand ball)"]},
]
SHOWN = "0.5: (in-hand ball), not (hand-empty), not (on-belt ball)"


def test_what_a_plan_counts_on_is_said_of_each_step(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    files = ("domains/gripper-robot/domain.hddl", "domains/gripper-robot/p1.hddl")
    plan = str(tmp_path / "plan.txt")
    assert main(["plan", *files, "--objective", "success-utility alpha=0.1", "--output", plan]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert [line.endswith(SHOWN) for line in lines if "ball)" in line] == [True, False]
    assert main(["validate", *files, plan, "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["outcomes"] == COUNTED
    assert main(["validate", *files, plan]) == 0
    shown = capsys.readouterr().out
    assert "counts on" in shown.splitlines()[0]
    assert SHOWN in shown
    problem = statehtn.read_hddl(*files)
    found = statehtn.plan(problem, objective="success-utility alpha=0.1")
    assert found.to_dict()["plan"][0] | COUNTED[0] == found.to_dict()["plan"][0]
    assert "added" not in found.to_dict()["plan"][1]
    assert "counts on" in found.steps._repr_html_()
    assert SHOWN in statehtn.validate(problem, found.plan)._repr_html_()


def test_plans_of_actions_with_one_outcome_count_on_none(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    files, plan = ("domains/av/domain.hddl", "domains/av/p1.hddl"), str(tmp_path / "plan.txt")
    assert main(["plan", *files, "--objective", "success-utility alpha=0.1", "--output", plan]) == 0
    assert main(["validate", *files, plan]) == 0
    assert "counts on" not in capsys.readouterr().out
    assert main(["validate", *files, plan, "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["outcomes"] is None


def test_one_trajectory() -> None:
    assert trajectory_utility([(0.5, 2), (0.25, 4)], lambda cost: -cost) == -2
    with pytest.raises(UsageError, match="between 0 and 1"):
        trajectory_utility([(1.5, 2)], lambda cost: -cost)
    with pytest.raises(UsageError, match="pair"):
        trajectory_utility([3], lambda cost: -cost)
