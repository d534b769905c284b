"""What laws can be asked beside their mean: expectations, orders, and what scipy makes of them."""

from __future__ import annotations

import math
from fractions import Fraction

import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy import stats

from statehtn import CostDistribution, CostLaw, InputError, UnsupportedError, UsageError
from statehtn.model import CostSum
from statehtn.model.chance import Scenario
from statehtn.model.cost.scenario_cost import ScenarioCost
from tests.property.test_cost_laws import TENTHS, laws

GAMMA = CostDistribution.from_scipy(stats.gamma(2, scale=3))
POISSON = CostDistribution.from_scipy(stats.poisson(4))
JAM = CostDistribution.of([(0.8, 2), (0.2, 6.5)])
CONTINUOUS = [
    GAMMA,
    POISSON,
    CostDistribution.from_scipy(stats.uniform(1, 3)),
    CostDistribution.from_scipy(stats.weibull_min(1.5, loc=2, scale=4)),
]
SCENARIOS = (Scenario("snow", 0.25, frozenset()), Scenario("none", 0.75, frozenset()))


def fractions(law: CostDistribution) -> list[tuple[Fraction, Fraction]]:
    return [(Fraction(str(probability)), Fraction(str(cost))) for probability, cost in law.outcomes]


def overrun(law: CostDistribution, budget: Fraction) -> Fraction:
    return sum((p * max(cost - budget, Fraction(0)) for p, cost in fractions(law)), Fraction(0))


def at_most(law: CostDistribution, budget: Fraction) -> Fraction:
    return sum((p for p, cost in fractions(law) if cost <= budget), Fraction(0))


@given(laws(), TENTHS)
def test_measures_are_sums_over_the_outcomes(law: CostDistribution, budget: float) -> None:
    exact = overrun(law, Fraction(str(budget)))
    assert law.expected_overrun(budget) == pytest.approx(float(exact), abs=1e-12)
    squares = sum(p * max(cost - Fraction(str(budget)), Fraction(0)) ** 2 for p, cost in fractions(law))
    assert law.semi_deviation(budget) == pytest.approx(math.sqrt(squares), abs=1e-9)
    assert law.semi_deviation() == law.semi_deviation(law.mean)
    assert law.expectation(lambda cost: cost * cost) == pytest.approx(law.variance + law.mean**2, abs=1e-9)
    assert law.variance == pytest.approx(law.standard_deviation**2, abs=1e-12)


@given(laws(), laws())
def test_dominance_is_looked_at_everywhere(law: CostDistribution, other: CostDistribution) -> None:
    grid = [Fraction(tenths, 10) for tenths in range(61)]  # all costs that there are
    assert law.dominates(other) == all(at_most(law, x) >= at_most(other, x) for x in grid)
    assert law.dominates(other, order=2) == all(overrun(law, x) <= overrun(other, x) for x in grid)
    assert law.dominates(law)
    assert law.dominates(law, order=2)


@given(laws(), laws())
def test_one_cost_is_above_another_or_not(law: CostDistribution, other: CostDistribution) -> None:
    above = sum(p * q for p, cost in fractions(law) for q, less in fractions(other) if cost > less)
    assert law.probability_above(other) == pytest.approx(float(above), abs=1e-12)


@given(laws())
def test_scipy_gives_back_what_it_got(law: CostDistribution) -> None:
    frozen = law.to_scipy()
    found = CostDistribution.from_scipy(frozen)
    assert isinstance(found, CostDistribution)
    assert [cost for _, cost in found.outcomes] == [cost for _, cost in law.outcomes]
    assert [p for p, _ in found.outcomes] == pytest.approx([p for p, _ in law.outcomes], abs=1e-12)
    assert frozen.mean() == pytest.approx(law.mean, abs=1e-9)
    assert frozen.cdf(law.least) == pytest.approx(law.cdf(law.least), abs=1e-12)


def test_a_list_of_outcomes_may_be_shifted_by_scipy() -> None:
    moved = CostDistribution.from_scipy(stats.rv_discrete(values=([0.5, 2], [0.25, 0.75]))(loc=1))
    assert moved == CostDistribution.of([(0.25, 1.5), (0.75, 3)])


@pytest.mark.parametrize("law", CONTINUOUS, ids=str)
def test_integrals_over_laws_of_scipy(law: CostLaw) -> None:
    assert law.expectation(lambda cost: cost) == pytest.approx(law.mean, rel=1e-10)
    assert law.variance == pytest.approx(law.expectation(lambda cost: (cost - law.mean) ** 2), rel=1e-9)
    for budget in (2.5, 7.0):
        assert law.expected_overrun(budget) == pytest.approx(law.expectation(lambda c: max(c - budget, 0)), abs=1e-9)  # noqa: B023
        assert law.exceedance(budget) == pytest.approx(law.expectation(lambda c: float(c > budget)), abs=1e-7)  # noqa: B023
    assert vars(law)["frozen"] is law.to_scipy()


@pytest.mark.parametrize("law", CONTINUOUS, ids=str)
@pytest.mark.parametrize("other", [*CONTINUOUS, JAM], ids=str)
def test_either_is_above_the_other_or_they_are_equal(law: CostLaw, other: CostLaw) -> None:
    equal = 0.0
    if law is POISSON and other in (POISSON, JAM):
        mass = stats.poisson(4).pmf
        equal = 0.8 * mass(2) if other is JAM else math.fsum(mass(range(100)) ** 2)
    above, below = law.probability_above(other), other.probability_above(law)
    assert above + below + equal == pytest.approx(1, abs=1e-7)
    if law is other:
        assert above == pytest.approx((1 - equal) / 2, abs=1e-9)


def test_continuous_laws_are_compared() -> None:
    larger = CostDistribution.from_scipy(stats.gamma(2, scale=4))
    assert GAMMA.dominates(larger)
    assert not larger.dominates(GAMMA)
    assert not larger.dominates(GAMMA, order=2)
    certain = CostDistribution.certain(6)  # its mean
    assert certain.dominates(GAMMA, order=2)
    assert not certain.dominates(GAMMA)
    assert not GAMMA.dominates(certain, order=2)


@given(laws(), st.sampled_from([0.1, 0.5, 0.9, 0.99, 0.999999]))
def test_the_entropic_value_at_risk_is_the_least_chernoff_bound(law: CostDistribution, level: float) -> None:
    found = law.evar(level)
    for power in range(-30, 31):
        bound = law.entropic(2.0**power) - math.log1p(-level) / 2.0**power
        assert found <= bound + 1e-9
    assert law.cvar(level) <= found + 1e-9
    assert found <= law.most
    assert law.evar(0) == law.mean
    assert law.evar(1) == law.most


def test_the_entropic_value_at_risk_of_scipy_laws() -> None:
    normal = CostDistribution.from_scipy(stats.truncnorm(-12, 12, loc=24, scale=2))
    assert normal.evar(0.95) == pytest.approx(24 + 2 * math.sqrt(-2 * math.log(0.05)), rel=1e-9)  # a closed form
    with pytest.raises(InputError, match="the entropic value at risk"):
        CostDistribution.from_scipy(stats.lognorm(0.5)).evar(0.9)


def test_entropic_is_averse_seeking_and_neutral() -> None:
    assert JAM.entropic(0) == JAM.mean
    assert JAM.entropic(0.5) == JAM.exponential_mean(0.5) > JAM.mean > JAM.entropic(-0.5)
    with pytest.raises(UsageError, match="alpha must be a finite number"):
        JAM.entropic(math.inf)


def test_sums_and_mixtures_are_asked_the_same() -> None:
    both = CostSum((JAM, JAM))
    assert both.expected_overrun(7) == pytest.approx(0.32 * 1.5 + 0.04 * 6)
    assert both.variance == pytest.approx(2 * JAM.variance)
    assert both.dominates(JAM.convolve(JAM)) and JAM.convolve(JAM).dominates(both)  # noqa: PT018
    assert both.to_scipy().mean() == pytest.approx(2 * JAM.mean)
    mixed = ScenarioCost(SCENARIOS, (CostDistribution.certain(8), JAM))
    assert mixed.expectation(lambda cost: cost) == pytest.approx(0.25 * 8 + 0.75 * JAM.mean)
    assert mixed.to_scipy().sf(6.5) == pytest.approx(0.25)
    assert JAM.dominates(mixed)
    assert mixed.probability_above(JAM) == pytest.approx(0.25 + 0.75 * 0.2 * 0.8)
    assert mixed.evar(0.5) > mixed.cvar(0.5)
    smooth = ScenarioCost(SCENARIOS, (GAMMA, JAM))
    assert JAM.probability_above(smooth) + smooth.probability_above(JAM) + 0.75 * (0.64 + 0.04) == pytest.approx(1)
    with pytest.raises(UnsupportedError, match="ask for the laws that it mixes"):
        smooth.to_scipy()


def test_functions_that_fail_are_named() -> None:
    with pytest.raises(UsageError, match="the function fails for a cost of 2 with ValueError"):
        JAM.expectation(lambda cost: math.log(cost - 5))
    with pytest.raises(UsageError, match="must be finite"):
        JAM.expectation(lambda _: math.inf)
    with pytest.raises(UsageError, match="the order of stochastic dominance is 1 or 2"):
        JAM.dominates(JAM, order=3)
    with pytest.raises(InputError, match="cannot be integrated well enough"):
        GAMMA.expectation(lambda cost: math.exp(min(cost, 700)) if cost < 1e6 else 1e300)
