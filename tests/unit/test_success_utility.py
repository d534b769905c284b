"""Success probabilities times utilities: prices of costs, and what no utility may be."""

from __future__ import annotations

import math

import pytest

import statehtn
from statehtn import CostDistribution
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


def test_one_trajectory() -> None:
    assert trajectory_utility([(0.5, 2), (0.25, 4)], lambda cost: -cost) == -2
    with pytest.raises(UsageError, match="between 0 and 1"):
        trajectory_utility([(1.5, 2)], lambda cost: -cost)
    with pytest.raises(UsageError, match="pair"):
        trajectory_utility([3], lambda cost: -cost)
