"""Properties of risk costs on random distributions, against exact arithmetic where there is any."""

from __future__ import annotations

import math
from decimal import Context, Decimal, localcontext

import pytest
from hypothesis import given
from hypothesis import strategies as st

from statehtn.model import CostDistribution
from statehtn.risk import (
    Attitude,
    Exponential,
    Neutral,
    Utility,
    expected_utility,
    expected_utility_by_trajectories,
    plan_risk_cost,
)

EXPONENTIAL = st.sampled_from([Attitude.AVERSE, Attitude.SEEKING])
ALPHAS = st.floats(-6, math.log10(50)).map(lambda exponent: 10.0**exponent)
COSTS = st.one_of(
    st.integers(0, 20).map(float), st.floats(0, 1e6), st.floats(-6, 6).map(lambda exponent: 10.0**exponent)
)


@st.composite
def laws(draw: st.DrawFn, costs: st.SearchStrategy[float] = COSTS, most: int = 5) -> CostDistribution:
    """Draw a distribution; some of its probabilities are tiny."""
    values = draw(st.lists(costs, min_size=1, max_size=most, unique=True))
    weights = [draw(st.one_of(st.integers(1, 20).map(float), st.floats(1e-12, 1))) for _ in values]
    return CostDistribution.of(
        (weight / math.fsum(weights), value) for weight, value in zip(weights, values, strict=True)
    )


def exact_risk_cost(law: CostDistribution, utility: Utility) -> Decimal:
    """Evaluate the definition with 80 digits and exponents of any size."""
    assert utility.alpha is not None
    slope = Decimal(utility.alpha) * (1 if utility.attitude is Attitude.AVERSE else -1)
    with localcontext(Context(prec=80, Emax=10**15, Emin=-(10**15))):
        total = sum(Decimal(probability) for probability, _ in law.outcomes)
        moment = sum(Decimal(p) / total * (slope * Decimal(cost)).exp() for p, cost in law.outcomes)
        return moment.ln() / slope


@given(laws(), EXPONENTIAL, ALPHAS)
def test_risk_cost_agrees_with_exact_arithmetic(law: CostDistribution, attitude: Attitude, alpha: float) -> None:
    utility = Exponential(attitude, alpha)
    exact = float(exact_risk_cost(law, utility))
    # Besides the relative error: ln(probability) / alpha is known to one rounding of the logarithm only.
    assert utility.risk_cost(law) == pytest.approx(exact, rel=1e-13, abs=1e-14 / alpha if alpha > 1e-3 else 1e-9)


@given(laws(), ALPHAS)
def test_averse_is_above_the_mean_and_seeking_below(law: CostDistribution, alpha: float) -> None:
    mean = Neutral().risk_cost(law)
    averse = Exponential(Attitude.AVERSE, alpha).risk_cost(law)
    seeking = Exponential(Attitude.SEEKING, alpha).risk_cost(law)
    assert law.outcomes[0][1] <= seeking <= mean <= averse <= law.outcomes[-1][1]


@given(laws(), ALPHAS, ALPHAS)
def test_more_curvature_means_more_of_the_attitude(law: CostDistribution, first: float, second: float) -> None:
    low, high = sorted((first, second))
    slack = 1e-12 * law.outcomes[-1][1] + 1e-13 / low
    averse = [Exponential(Attitude.AVERSE, alpha).risk_cost(law) for alpha in (low, high)]
    seeking = [Exponential(Attitude.SEEKING, alpha).risk_cost(law) for alpha in (low, high)]
    assert averse[0] <= averse[1] + slack
    assert seeking[0] >= seeking[1] - slack


@given(laws(), EXPONENTIAL)
def test_it_converges_to_neutral(law: CostDistribution, attitude: Attitude) -> None:
    """The distance from the mean is at most alpha times the square of the range (an eighth of it in the limit)."""
    spread = law.outcomes[-1][1] - law.outcomes[0][1]
    for alpha in (1e-6, 1e-9, 1e-12, 1e-15):
        distance = abs(Exponential(attitude, alpha).risk_cost(law) - law.mean)
        assert distance <= alpha * spread**2 + 1e-12 * law.outcomes[-1][1]


@given(laws(), EXPONENTIAL, ALPHAS, st.integers(0, 1000))
def test_a_certain_cost_shifts_it(law: CostDistribution, attitude: Attitude, alpha: float, shift: int) -> None:
    utility = Exponential(attitude, alpha)
    shifted = CostDistribution.of((probability, cost + shift) for probability, cost in law.outcomes)
    slack = 1e-12 * (law.outcomes[-1][1] + shift) + 1e-14 / alpha
    assert utility.risk_cost(shifted) == pytest.approx(utility.risk_cost(law) + shift, rel=1e-12, abs=slack)


@given(laws(most=3), laws(most=3), EXPONENTIAL, ALPHAS)
def test_it_adds_up_over_independent_costs(
    first: CostDistribution, second: CostDistribution, attitude: Attitude, alpha: float
) -> None:
    utility = Exponential(attitude, alpha)
    both = utility.risk_cost(first.convolve(second))
    largest = first.outcomes[-1][1] + second.outcomes[-1][1]
    assert both == pytest.approx(
        plan_risk_cost([first, second], utility), rel=1e-11, abs=1e-11 * largest + 1e-12 / alpha
    )


SMALL_LAWS = laws(costs=st.integers(0, 40).map(lambda value: value / 4), most=3)


@given(st.lists(SMALL_LAWS, min_size=1, max_size=5), EXPONENTIAL, st.floats(0.01, 2))
def test_theorem_1(plan: list[CostDistribution], attitude: Attitude, alpha: float) -> None:
    """The sum over trajectories (equation 4), the product over segments (equation 5) and `utility(K)` are one."""
    utility = Exponential(attitude, alpha)
    sign = -1 if attitude is Attitude.AVERSE else 1
    by_trajectories = expected_utility_by_trajectories(plan, utility)
    segments = [math.fsum(p * utility.utility(cost) for p, cost in law.outcomes) for law in plan]
    product = math.prod(segments) * (alpha / sign) ** (len(plan) - 1)
    assert product == pytest.approx(by_trajectories, rel=1e-9)
    assert expected_utility(plan, utility) == pytest.approx(by_trajectories, rel=1e-9)


@given(st.lists(SMALL_LAWS, min_size=1, max_size=5))
def test_neutral_utility_is_the_sum_over_trajectories_too(plan: list[CostDistribution]) -> None:
    by_trajectories = expected_utility_by_trajectories(plan, Neutral())
    assert expected_utility(plan, Neutral()) == pytest.approx(by_trajectories, rel=1e-9, abs=1e-9)


@given(st.floats(0, 1e7), EXPONENTIAL, ALPHAS)
def test_printed_utilities_have_the_right_size(risk_cost: float, attitude: Attitude, alpha: float) -> None:
    utility = Exponential(attitude, alpha)
    text = utility.expected_utility_text(risk_cost)
    assert text.startswith("-") == (attitude is Attitude.AVERSE)
    log10 = utility.log10_expected_utility(risk_cost)
    unlimited = Context(prec=20, Emax=10**15, Emin=-(10**15))
    printed = float(unlimited.log10(unlimited.abs(Decimal(text)))) * (-1 if attitude is Attitude.AVERSE else 1)
    assert printed == pytest.approx(log10, rel=1e-6, abs=1e-6)
