"""Utilities: the paper's numbers, edge cases, and what is refused."""

from __future__ import annotations

import math

import pytest

from statehtn.errors import UsageError
from statehtn.model import CostDistribution
from statehtn.risk import (
    UTILITIES,
    Attitude,
    Exponential,
    Neutral,
    expected_utility,
    expected_utility_by_trajectories,
    expected_utility_text,
    plan_expected_cost,
    plan_risk_cost,
    problem_class,
    utility_for,
)

certain = CostDistribution.certain


def law(*outcomes: tuple[float, float]) -> CostDistribution:
    return CostDistribution.of(outcomes)


# Cost distributions recovered from the paper's tables (vehicle: alpha 0.1 and 0.9; satellite: alpha 0.5).
SCHOOL_ROUTE = [
    *map(certain, (0.5, 0.1, 0.4)),
    law((0.8, 2), (0.2, 6)),
    law((0.9, 0.5), (0.1, 3.0)),
    law((0.1, 0.5), (0.9, 2.5)),
    law((0.8, 1.0), (0.2, 3.5)),
]
DODGE_ROUTE = [*map(certain, (0.5, 0.1, 0.4, 4, 0.4, 1.0, 3.0))]
ICE_DECELERATE_ESP = [certain(1), certain(9)]
ICE_ACCELERATE_ESP = [certain(1), law((0.2, 1), (0.8, 11))]
ICE_ACCELERATE = [law((0.1, 0.5), (0.9, 16))]
OVERLOAD, SUPERLOAD = law((0.99, 15), (0.01, 100)), law((0.95, 15), (0.05, 400))


@pytest.mark.parametrize(
    ("laws", "attitude", "alpha", "value", "log10", "cost"),
    [
        (SCHOOL_ROUTE + ICE_ACCELERATE_ESP, "seeking", 0.1, (1.793, 5e-4), 0.254, 18.35),
        (SCHOOL_ROUTE + ICE_ACCELERATE, "seeking", 0.9, (0.117905e-3, 5e-10), -3.928, 22.8),
        (SCHOOL_ROUTE + ICE_DECELERATE_ESP, "averse", 0.1, (-64.159, 5e-4), -1.807, 18.35),
        (DODGE_ROUTE + ICE_DECELERATE_ESP, "averse", 0.9, (-42514702.52, 1), -7.629, 19.4),
        ([certain(15)] * 13 + [OVERLOAD, SUPERLOAD], "seeking", 0.5, (2.60771e-49, 5e-55), -48.58374, 245.1),
        ([certain(15)] * 17, "averse", 0.5, (-4.71603e55, 5e49), -55.674, 255),
    ],
)
def test_the_paper_s_values(
    laws: list[CostDistribution], attitude: str, alpha: float, value: tuple[float, float], log10: float, cost: float
) -> None:
    utility = utility_for(attitude, alpha)
    risk_cost = plan_risk_cost(laws, utility)
    assert plan_expected_cost(laws) == pytest.approx(cost, abs=1e-9)
    printed, half_a_digit = value
    assert expected_utility(laws, utility) == pytest.approx(printed, rel=0, abs=half_a_digit)
    assert float(expected_utility_text(laws, utility)) == pytest.approx(printed, rel=0, abs=half_a_digit)
    assert utility.log10_expected_utility(risk_cost) == pytest.approx(log10, abs=1e-3)
    assert expected_utility_by_trajectories(laws, utility) == pytest.approx(expected_utility(laws, utility), rel=1e-9)


def test_neutral_utility_is_minus_the_expected_cost() -> None:
    laws = [law((0.8, 2), (0.2, 6)), certain(3)]
    assert plan_risk_cost(laws, Neutral()) == pytest.approx(5.8)
    assert expected_utility_text(laws, Neutral()) == "-5.8"
    assert Neutral().expected_utility_text(0.0) == "0"
    assert Neutral().log10_expected_utility(5.8) is None
    assert Neutral().utility(5.8) == -5.8
    assert expected_utility_by_trajectories(laws, Neutral()) == pytest.approx(-5.8)


@pytest.mark.parametrize("attitude", [Attitude.AVERSE, Attitude.SEEKING])
def test_a_certain_cost_is_worth_itself(attitude: Attitude) -> None:
    for alpha in (5e-324, 1e-6, 0.9, 50, 1e300):
        for cost in (0.0, 0.1, 4.0, 1e6):
            assert Exponential(attitude, alpha).risk_cost(certain(cost)) == cost


def test_extreme_alphas_meet_the_mean_and_the_extremes() -> None:
    coin = law((0.5, 2), (0.5, 6))
    for alpha in (5e-324, 1e-300, 1e-15):
        assert Exponential(Attitude.AVERSE, alpha).risk_cost(coin) == pytest.approx(4, abs=1e-13)
        assert Exponential(Attitude.SEEKING, alpha).risk_cost(coin) == pytest.approx(4, abs=1e-13)
    for alpha in (1e15, 1e307, 1.7e308):
        assert Exponential(Attitude.AVERSE, alpha).risk_cost(coin) == pytest.approx(6, abs=1e-13)
        assert Exponential(Attitude.SEEKING, alpha).risk_cost(coin) == pytest.approx(2, abs=1e-13)


def test_a_rare_disaster_keeps_its_digits() -> None:
    """Close to certainty nearly everything cancels: ln(1 + p (e^x - 1)) is p (e^x - 1), to 12 digits."""
    rare = law((1 - 1e-13, 0), (1e-13, 2))
    assert Exponential(Attitude.AVERSE, 1).risk_cost(rare) == pytest.approx(1e-13 * math.expm1(2), rel=1e-9, abs=0)
    assert Exponential(Attitude.SEEKING, 1).risk_cost(rare) == pytest.approx(-1e-13 * math.expm1(-2), rel=1e-9, abs=0)


def test_utility_is_equation_1_with_positive_costs() -> None:
    assert Exponential(Attitude.AVERSE, 0.5).utility(3) == pytest.approx(-math.exp(1.5) / 0.5)
    assert Exponential(Attitude.SEEKING, 0.5).utility(3) == pytest.approx(math.exp(-1.5) / 0.5)
    assert Exponential(Attitude.AVERSE, 50).utility(1e6) == -math.inf
    assert Exponential(Attitude.SEEKING, 50).utility(1e6) == 0


@pytest.mark.parametrize(
    ("attitude", "alpha", "risk_cost", "digits", "text"),
    [
        (Attitude.AVERSE, 0.5, 0.0, 10, "-2"),
        (Attitude.SEEKING, 1.0, 0.0, 10, "1"),
        (Attitude.AVERSE, 1.0, math.log(10) * 130, 6, "-1e+130"),
        (Attitude.AVERSE, 1.0, math.log(10) * 4000, 3, "-1e+4000"),
        (Attitude.SEEKING, 1.0, math.log(10) * 4000, 3, "1e-4000"),
        (Attitude.AVERSE, 1.0, 9999.996 * math.log(10), 3, "-9.91e+9999"),
        (Attitude.AVERSE, 1.0, 9999.99999 * math.log(10), 3, "-1e+10000"),
        (Attitude.AVERSE, 50.0, 1e6, 10, "-2.489961e+21714722"),
        (Attitude.AVERSE, 0.9, 20.3, 4, "-9.557e+07"),
    ],
)
def test_expected_utility_as_text(attitude: Attitude, alpha: float, risk_cost: float, digits: int, text: str) -> None:
    assert Exponential(attitude, alpha).expected_utility_text(risk_cost, digits) == text


def test_probabilities_that_sum_to_one_only_roughly_stay_within_bounds() -> None:
    rough = law((0.5 + 4e-10, 7), (0.5 + 4e-10, 8))
    for utility in (Neutral(), Exponential(Attitude.AVERSE, 1e-12), Exponential(Attitude.SEEKING, 100)):
        assert 7 <= utility.risk_cost(rough) <= 8
    assert Neutral().risk_cost(law((1 + 5e-10, 7))) == 7


@pytest.mark.parametrize(
    ("attitude", "alpha", "message"),
    [
        ("averse", None, "the averse attitude needs alpha"),
        ("seeking", None, "the seeking attitude needs alpha"),
        ("neutral", 0.5, "takes no alpha"),
        ("averse", 0.0, "positive finite"),
        ("seeking", -1.0, "positive finite"),
        ("averse", math.inf, "positive finite"),
        ("averse", math.nan, "positive finite"),
        ("bold", 1.0, "unknown attitude 'bold'; there are neutral, averse, seeking"),
    ],
)
def test_wrong_arguments_are_usage_errors(attitude: str, alpha: float | None, message: str) -> None:
    with pytest.raises(UsageError, match=message):
        utility_for(attitude, alpha)


def test_an_exponential_utility_is_not_neutral() -> None:
    with pytest.raises(UsageError, match="averse or seeking"):
        Exponential(Attitude.NEUTRAL, 1.0)


def test_every_utility_of_the_registry_names_its_attitude() -> None:
    for attitude, make in UTILITIES.items():
        utility = make(None if attitude is Attitude.NEUTRAL else 0.5)
        assert utility.attitude is attitude
        assert utility.alpha == (None if attitude is Attitude.NEUTRAL else 0.5)
        assert utility == utility_for(attitude, utility.alpha)


@pytest.mark.parametrize(
    ("solver", "attitude", "alpha", "text"),
    [
        ("state", "neutral", None, "PS10011"),
        ("plan", "neutral", None, "PP10011"),
        ("state", "averse", 0.9, "PS10110"),
        ("state", "seeking", 0.9, "PS10110"),
        ("plan", "averse", 0.9, "PP10110"),
    ],
)
def test_problem_classes(solver: str, attitude: str, alpha: float | None, text: str) -> None:
    assert str(problem_class(solver, utility_for(attitude, alpha))) == text


def test_an_unknown_solver_has_no_problem_class() -> None:
    with pytest.raises(UsageError, match="unknown solver 'sat'"):
        problem_class("sat", Neutral())
