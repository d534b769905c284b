"""A cost with a law in each scenario answers for the mixture, whatever the laws are."""

from __future__ import annotations

import math

import pytest

from statehtn import CostDistribution, CostLaw, UsageError
from statehtn.model.chance import Scenario
from statehtn.model.cost.scenario_cost import ScenarioCost, by_scenario, sum_of, total_by_scenario, total_of

WEATHER = (Scenario("snow", 0.25, frozenset({("snow",)})), Scenario("sun", 0.75, frozenset()))
LISTED = ScenarioCost(WEATHER, (CostDistribution.of([(0.5, 8), (0.5, 12)]), CostDistribution.certain(2)))


def continuous() -> ScenarioCost:
    stats = pytest.importorskip("scipy.stats")
    laws = CostDistribution.from_scipy(stats.uniform(4, 4)), CostDistribution.from_scipy(stats.uniform(0, 8))
    return ScenarioCost(WEATHER, laws)


def test_lists_of_outcomes_are_mixed() -> None:
    mixed = CostDistribution.of([(0.75, 2), (0.125, 8), (0.125, 12)])
    assert LISTED.mixture == mixed == total_of([LISTED])
    assert (LISTED.least, LISTED.most, LISTED.mean) == (2, 12, mixed.mean)
    assert LISTED.standard_deviation == pytest.approx(mixed.standard_deviation)
    for slope in (-0.3, 0.001, 0.7, 200.0):
        assert LISTED.exponential_mean(slope) == pytest.approx(mixed.exponential_mean(slope), rel=1e-14)
    assert LISTED.cvar(0.8) == mixed.cvar(0.8)
    assert LISTED.quantile(0.8) == 8
    assert (LISTED.cdf(8), LISTED.exceedance(8)) == (0.875, 0.125)
    assert LISTED.expectation(math.sqrt) == pytest.approx(mixed.expectation(math.sqrt))
    assert LISTED.expected_overrun(9) == 3 / 8
    assert str(LISTED) == str(mixed)


def test_continuous_laws_are_mixed() -> None:
    law = continuous()
    assert law.mixture is None
    assert (law.least, law.most, law.mean) == (0, 8, 4.5)
    assert law.cdf(6) == pytest.approx(0.25 * 0.5 + 0.75 * 0.75)
    assert law.cdf(law.quantile(0.9)) == pytest.approx(0.9, abs=1e-12)
    assert (law.quantile(0), law.quantile(1)) == (0, 8)
    drawn = law.sample(200_000, __import__("numpy").random.default_rng(1))
    worst = sorted(drawn.tolist())[-20_000:]
    assert law.cvar(0.9) == pytest.approx(sum(worst) / len(worst), abs=0.01)
    assert law.standard_deviation == pytest.approx(drawn.std(), rel=0.01)
    assert "a law for each of 2 scenarios" in str(law)


def test_sums_are_those_in_each_scenario() -> None:
    total = total_by_scenario([LISTED, LISTED, CostDistribution.certain(1)])
    assert isinstance(total, ScenarioCost)
    assert total.given("sun") == CostDistribution.certain(5)
    assert total.given(0) == CostDistribution.of([(0.25, 17), (0.5, 21), (0.25, 25)])
    assert total_of([LISTED, LISTED]) != LISTED.mixture.convolve(LISTED.mixture)  # type: ignore[arg-type, union-attr]
    assert sum_of([LISTED, LISTED]).mean == 2 * LISTED.mean
    assert sum_of([LISTED]) is LISTED
    with pytest.raises(UsageError, match=r"no scenario 'snwo'.* \(did you mean 'snow'\?\)"):
        total.given("snwo")


def test_one_law_for_all_scenarios_is_that_law() -> None:
    one: CostLaw = CostDistribution.certain(3)
    assert by_scenario(WEATHER, [one, CostDistribution.certain(3)]) is one
    assert total_by_scenario([one]) == one
