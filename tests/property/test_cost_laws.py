"""Laws of costs: sums against enumeration, questions against numpy, integrals against closed forms."""

from __future__ import annotations

import itertools
import math
from fractions import Fraction

import numpy
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy import stats

import statehtn.model.cost.total as totals
from statehtn.model import CostDistribution, CostLaw, CostSum
from statehtn.model.cost.numerics.moment_generating import CLOSED_FORMS, _closed_form, _integrated, exponential_mean
from statehtn.model.cost.scipy_law import ScipyCost
from statehtn.model.cost.sum import TotalCost, on_grid, total_cost

TENTHS = st.integers(0, 60).map(lambda value: value / 10)


@st.composite
def laws(draw: st.DrawFn, most: int = 4) -> CostDistribution:
    """Draw a law whose probabilities are tenths."""
    costs = draw(st.lists(TENTHS, min_size=1, max_size=most, unique=True))
    cuts = sorted(draw(st.lists(st.integers(1, 9), min_size=len(costs) - 1, max_size=len(costs) - 1, unique=True)))
    weights = [(high - low) / 10 for low, high in itertools.pairwise([0, *cuts, 10])]
    return CostDistribution.of(zip(weights, costs, strict=True))


def enumerated(plan: list[CostDistribution]) -> dict[Fraction, Fraction]:
    """The law of the sum, over all combinations of outcomes."""
    found: dict[Fraction, Fraction] = {}
    for combination in itertools.product(*(law.outcomes for law in plan)):
        cost = sum((Fraction(str(cost)) for _, cost in combination), Fraction(0))
        found[cost] = found.get(cost, Fraction(0)) + math.prod(Fraction(str(p)) for p, _ in combination)
    return found


@given(st.lists(laws(), max_size=5))
def test_the_sum_is_what_enumeration_gives(plan: list[CostDistribution]) -> None:
    expected = enumerated(plan)
    found = total_cost(plan)
    assert type(found) is CostDistribution
    assert found.outcomes == tuple((float(expected[cost]), float(cost)) for cost in sorted(expected))


@given(st.lists(laws(), max_size=5), st.sampled_from([1.0, 0.25, 1e6]), st.integers(0, 3))
def test_packed_weights_are_those_of_pairs(plan: list[CostDistribution], unit: float, copies: int) -> None:
    plan = [CostDistribution.of((p, cost * unit) for p, cost in law.outcomes) for law in plan * copies]
    packed = totals.exact_total(plan)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(totals, "MOST_BYTES", -1)
        assert totals.exact_total(plan) == packed


def test_long_plans_have_exact_laws() -> None:
    law = CostDistribution.of([(0.3, 0.5), (0.6, 1.25), (0.1, 7)])
    total = total_cost([law] * 300)
    assert type(total) is CostDistribution
    assert len(total.outcomes) > 5000
    assert total.mean == pytest.approx(300 * law.mean, rel=1e-14)
    assert total.variance == pytest.approx(300 * law.variance, rel=1e-13)


@given(st.lists(laws(), min_size=2, max_size=5), st.floats(0.01, 0.99))
def test_the_grid_is_within_its_error(plan: list[CostDistribution], level: float) -> None:
    exact = total_cost(plan)
    uncertain = [law for law in plan if law.least < law.most]
    if len(uncertain) < 2:
        return
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(totals, "CELLS", 64)  # coarse, so that errors show
        grid = on_grid(CostSum(tuple(plan)), uncertain)
    error = grid.cost_error
    assert 0 < error < len(uncertain) * (exact.most - exact.least) / (64 - 2 * len(uncertain) - 2)
    assert (grid.cut_probability, grid.cut_cost) == (0, 0)
    assert (grid.mean, grid.standard_deviation) == pytest.approx((exact.mean, exact.standard_deviation), abs=1e-9)
    assert grid.cvar(level) == pytest.approx(exact.cvar(level), abs=error + 1e-9)
    budget = exact.quantile(level)
    assert exact.exceedance(budget + error) - 1e-9 <= grid.exceedance(budget)
    assert grid.exceedance(budget) <= exact.exceedance(budget - error - 1e-9) + 1e-9
    # A quantile jumps where the level meets the distribution function, which is rounded.
    assert exact.quantile(max(level - 1e-9, 0)) - error - 1e-9 <= grid.quantile(level)
    assert grid.quantile(level) <= exact.quantile(min(level + 1e-9, 1)) + error + 1e-9


@given(st.lists(TENTHS, min_size=1, max_size=40), st.data())
def test_questions_are_answered_as_numpy_does(data: list[float], choice: st.DataObject) -> None:
    law = CostDistribution.from_samples(data)
    count = choice.draw(st.integers(1, len(data)))
    level = count / len(data)
    assert law.mean == pytest.approx(numpy.mean(data), abs=1e-12)
    assert law.standard_deviation == pytest.approx(numpy.std(data), abs=1e-9)
    assert law.quantile(level) == numpy.quantile(data, level, method="inverted_cdf")
    assert law.quantile(0) == min(data)
    worst = sorted(data)[len(data) - count :]
    assert law.cvar(1 - level) == pytest.approx(numpy.mean(worst), abs=1e-9)
    assert law.cvar(1) == max(data) == law.most
    budget = choice.draw(TENTHS)
    assert law.exceedance(budget) == pytest.approx(sum(cost > budget for cost in data) / len(data), abs=1e-12)
    assert law.cdf(budget) == pytest.approx(1 - law.exceedance(budget), abs=1e-12)


@st.composite
def closed(draw: st.DrawFn) -> ScipyCost:
    """Draw a law whose moment generating function is known."""
    size = st.floats(-2, 2).map(lambda exponent: 10.0**exponent)
    shape = st.floats(0.2, 8)
    scale, loc = draw(size), draw(st.sampled_from([0, 1, 7.5]))
    low = draw(st.floats(-3, 3))
    frozen = draw(
        st.sampled_from(
            [
                stats.uniform(loc, scale),
                stats.expon(loc, scale),
                stats.gamma(draw(shape), loc, scale),
                stats.chi2(draw(shape), loc, scale),
                stats.invgauss(draw(shape), loc, scale),
                stats.halfnorm(loc, scale),
                stats.truncnorm(low, low + draw(st.floats(0.5, 8)), loc - low * scale, scale),
            ]
        )
    )
    law = CostDistribution.from_scipy(frozen)
    assert isinstance(law, ScipyCost)
    assert law.family in CLOSED_FORMS
    return law


@settings(max_examples=25, deadline=None)
@given(closed(), st.sampled_from([-1, 1]), st.floats(-5, 2).map(lambda exponent: 10.0**exponent))
def test_integrals_are_what_closed_forms_say(law: ScipyCost, sign: int, size: float) -> None:
    slope = sign * size / law.standard_deviation
    expected = _closed_form(law, slope)
    if expected is None:  # not accurate there
        return
    found, error = _integrated(law, slope)
    if math.isinf(expected[0]):
        assert math.isinf(found)
        return
    reach = abs(found - law.least)
    assert found == pytest.approx(expected[0], abs=error + 1e-10 * reach + 1e-12 * law.least)
    assert error <= 1e-9 * reach


CONTINUOUS = [
    stats.gamma(0.3, scale=2),
    stats.beta(0.5, 2, loc=1, scale=10),
    stats.weibull_min(1.5, scale=2),
    stats.rayleigh(scale=3),
    stats.triang(0.2, loc=1, scale=3),
    stats.loguniform(1, 50),
    stats.poisson(3),
    stats.geom(0.3),
    stats.nbinom(2, 0.4, loc=1),
]
HEAVY = [stats.lognorm(0.5), stats.pareto(3), stats.weibull_min(0.7), stats.lomax(2.5), stats.invgamma(3)]


@pytest.mark.parametrize("frozen", CONTINUOUS + HEAVY, ids=lambda frozen: frozen.dist.name)
def test_attitudes_are_on_their_sides_of_the_mean(frozen: object) -> None:
    law = CostDistribution.from_scipy(frozen)
    seeking = [law.exponential_mean(-size) for size in (3, 0.3, 1e-6)]
    assert law.least <= seeking[0] <= seeking[1] <= seeking[2] <= law.mean
    if math.isfinite(law.standard_deviation):
        assert seeking[2] == pytest.approx(law.mean, rel=1e-4)
    if frozen in HEAVY:
        for size in (1e-6, 0.1, 10):
            with pytest.raises(Exception, match=r"E\[e\^\(alpha C\)\] is infinite"):
                law.exponential_mean(size)
    else:
        averse = [law.exponential_mean(size) for size in (1e-6, 0.1, 0.2)]
        assert law.mean <= averse[0] <= averse[1] <= averse[2] <= law.most


@pytest.mark.parametrize("frozen", CONTINUOUS + HEAVY, ids=lambda frozen: frozen.dist.name)
def test_questions_to_scipy_agree_with_its_samples(frozen: object) -> None:
    law = CostDistribution.from_scipy(frozen)
    runs = 40_000
    drawn = numpy.sort(law.sample(runs, numpy.random.default_rng(7)))
    seen = CostDistribution.from_samples(drawn)
    slack = math.sqrt(math.log(2 / 1e-6) / (2 * runs))  # the inequality of Dvoretzky, Kiefer and Wolfowitz
    for level in (0.05, 0.5, 0.9):
        cost = law.quantile(level)
        assert law.cdf(cost) == pytest.approx(seen.cdf(cost), abs=slack)
        assert law.exceedance(cost) == pytest.approx(1 - law.cdf(cost), abs=1e-9)
        assert law.cvar(level) >= max(cost, law.mean) - 1e-9
    if law.standard_deviation < 10 and frozen not in HEAVY:
        assert law.cvar(0.9) == pytest.approx(seen.cvar(0.9), rel=0.05)


@pytest.mark.parametrize("frozen", [*CONTINUOUS[:6], HEAVY[0]], ids=lambda frozen: frozen.dist.name)
def test_discretised_laws_keep_the_mean(frozen: object) -> None:
    law = CostDistribution.from_scipy(frozen)
    assert isinstance(law, ScipyCost)
    few = law.discretised(8)
    assert len(few.outcomes) == 8
    assert few.mean == pytest.approx(law.mean, rel=1e-8)
    assert few.exponential_mean(-0.4) >= law.exponential_mean(-0.4)
    if frozen not in HEAVY:
        assert few.exponential_mean(0.3) <= law.exponential_mean(0.3)
    assert law.discretised(1).outcomes[0][1] == pytest.approx(law.mean, rel=1e-9)


PARTS: list[CostLaw] = [
    CostDistribution.of([(0.3, 1), (0.7, 4)]),
    CostDistribution.from_scipy(stats.gamma(2, scale=1.5)),
    CostDistribution.from_scipy(stats.uniform(1, 3)),
    CostDistribution.from_scipy(stats.poisson(2)),
    CostDistribution.certain(2),
]


def test_sums_with_continuous_costs_agree_with_simulation() -> None:
    law = total_cost([*PARTS, PARTS[1]])
    assert isinstance(law, TotalCost)
    assert law.mean == pytest.approx(3.1 + 3 + 2.5 + 2 + 2 + 3)
    assert law.standard_deviation**2 == pytest.approx(1.89 + 4.5 + 0.75 + 2 + 4.5)
    assert (law.least, law.most) == (4, math.inf)
    assert law.cost_error < 0.02
    assert law.cut_probability < 1e-9
    runs = 100_000
    drawn = CostSum((*PARTS, PARTS[1])).sample(runs, numpy.random.default_rng(3))
    slack = math.sqrt(math.log(2 / 1e-6) / (2 * runs))
    for cost in (6, 10, 15, 20, 30):
        low, high = numpy.mean(drawn <= cost - law.cost_error), numpy.mean(drawn <= cost + law.cost_error)
        assert low - slack <= law.cdf(cost) <= high + slack
    worst = numpy.sort(drawn)[int(0.95 * runs) :]
    assert law.cvar(0.95) == pytest.approx(worst.mean(), rel=0.01)
    slope = 0.2
    assert law.exponential_mean(slope) == pytest.approx(
        CostDistribution(law.outcomes).exponential_mean(slope), abs=0.02
    )
    parts = [part.exponential_mean(slope) for part in [*PARTS, PARTS[1]]]
    assert law.exponential_mean(slope) == pytest.approx(sum(parts), rel=1e-14)


def test_one_law_among_free_actions_is_itself() -> None:
    assert total_cost([CostDistribution.certain(0), PARTS[1]]) is PARTS[1]
    assert total_cost([]) == CostDistribution.certain(0)
    assert total_cost([CostDistribution.certain(0.1), CostDistribution.certain(0.2)]) == CostDistribution.certain(0.3)


def test_long_plans_go_to_the_grid_and_stay_near() -> None:
    generator = numpy.random.default_rng(5)
    plan = [
        CostDistribution.of([(0.5, float(low)), (0.5, float(low + more))]) for low, more in generator.random((60, 2))
    ]
    law = total_cost(plan)
    assert isinstance(law, TotalCost)
    spread = sum(step.most - step.least for step in plan)
    assert law.cost_error < 60 * spread / 2**16 / 2
    assert CostDistribution(law.outcomes).mean == pytest.approx(law.mean, abs=law.cost_error)
    assert CostDistribution(law.outcomes).standard_deviation == pytest.approx(law.standard_deviation, rel=1e-3)


def test_many_equal_actions_stay_exact() -> None:
    step = CostDistribution.of([(0.8, 0.1), (0.2, 0.7)])
    law = total_cost([step] * 300)
    assert type(law) is CostDistribution
    assert len(law.outcomes) == 301
    assert law.mean == pytest.approx(300 * 0.22)
    assert law.exceedance(200) == pytest.approx(stats.binom(300, 0.2).sf(283), rel=1e-9)


def test_exponential_means_are_kept() -> None:
    law = CostDistribution.from_scipy(stats.rayleigh(scale=2))
    assert isinstance(law, ScipyCost)
    exponential_mean.cache_clear()
    assert law.exponential_mean(0.5) == law.exponential_mean(0.5)
    assert exponential_mean.cache_info().hits == 1
    assert 0 < law.exponential_mean_error(0.5) < 1e-9
