"""Costs from samples, counts and scipy's distributions, from their making to plans, JSON and HDDL."""

from __future__ import annotations

import json
import math
import pickle
import subprocess
import sys

import numpy
import pytest
from scipy import stats

import statehtn
from statehtn.model import CostDistribution, CostSum
from statehtn.model.cost.sampled import SampledCost
from statehtn.model.cost.scipy_law import ScipyCost
from statehtn.model.cost.sum import TotalCost
from statehtn.model.plan import Plan, Step

AV = ("domains/av/domain.hddl", "domains/av/p1.hddl")
AVERSE = statehtn.utility_for("averse", 0.4)
SEEKING = statehtn.utility_for("seeking", 0.4)
NEUTRAL = statehtn.utility_for("neutral")


@pytest.fixture(scope="module")
def vehicle() -> statehtn.Problem:
    return statehtn.read_hddl(*AV)


def test_samples_are_as_likely_as_they_were_frequent() -> None:
    law = CostDistribution.from_samples(numpy.array([2, 6, 2, 2]))
    assert law.outcomes == ((0.75, 2.0), (0.25, 6.0))
    assert isinstance(law, SampledCost)
    assert law.count == 4
    assert str(law) == "2 w.p. 0.75, 6 w.p. 0.25"


@pytest.mark.parametrize(
    ("data", "most", "message"),
    [
        ([], None, "at least one observation, found none"),
        ([1, -2], None, "an observed cost must be a finite number of at least 0, found -2"),
        ([1, math.nan], None, "finite number of at least 0, found nan"),
        ([1, "x"], None, "an observed cost must be a number, found 'x'"),
        ([1, None], None, "an observed cost must be a number, found None"),
        ([1, 9], 5, "an observed cost of 9 is above the largest possible cost, 5"),
        ([1], math.inf, "the largest possible cost must be a finite number"),
    ],
)
def test_wrong_samples(data: list[float], most: float | None, message: str) -> None:
    with pytest.raises(statehtn.InputError, match=message):
        CostDistribution.from_samples(data, most=most)


def test_bounds_cover_the_truth_as_often_as_they_promise() -> None:
    truth = CostDistribution.of([(0.7, 1), (0.25, 3), (0.05, 8)])
    generator = numpy.random.default_rng(11)
    missed = 0
    sets = 300
    for _ in range(sets):
        law = CostDistribution.from_samples(truth.sample(25, generator), most=8)
        bounds = [law.risk_cost_bounds(utility, confidence=0.8) for utility in (AVERSE, NEUTRAL, SEEKING)]
        prices = [utility.risk_cost(truth) for utility in (AVERSE, NEUTRAL, SEEKING)]
        missed += not all(low <= price <= high for (low, high), price in zip(bounds, prices, strict=True))
        for utility, (low, high) in zip((AVERSE, NEUTRAL, SEEKING), bounds, strict=True):
            assert low <= utility.risk_cost(law) <= high
    assert missed <= 0.2 * sets


def test_the_band_is_no_wider_than_it_need_be() -> None:
    """For a law without atoms the inequality is nearly an equation."""
    costs = numpy.arange(1, 401)
    generator = numpy.random.default_rng(12)
    missed = 0
    for _ in range(200):
        best, worst = CostDistribution.from_samples(generator.integers(1, 401, 25), most=400).band(confidence=0.8)
        assert worst is not None
        steps = [numpy.searchsorted([c for _, c in law.outcomes], costs, "right") for law in (best, worst)]
        high, low = (
            numpy.concatenate([[0], numpy.cumsum([p for p, _ in law.outcomes])])[at]
            for law, at in zip((best, worst), steps, strict=True)
        )
        missed += bool((costs / 400 > high + 1e-12).any() or (costs / 400 < low - 1e-12).any())
    assert 0.05 < missed / 200 < 0.27  # 0.2 and what chance adds


def test_bounds_shrink_with_data_and_need_a_largest_cost() -> None:
    generator = numpy.random.default_rng(2)
    widths = []
    for count in (10, 1000, 100_000):
        law = CostDistribution.from_samples(generator.integers(1, 5, count), most=5)
        low, high = law.risk_cost_bounds(AVERSE)
        widths.append(high - low)
    assert widths[0] > 5 * widths[1] > 25 * widths[2]
    unbounded = CostDistribution.from_samples([1, 2, 3])
    assert unbounded.risk_cost_bounds(AVERSE)[1] == math.inf
    assert unbounded.band()[1] is None
    assert CostDistribution.from_samples([1], most=4).risk_cost_bounds(NEUTRAL) == (0, 4)
    for confidence in (0, 1, -1, math.nan):
        with pytest.raises(statehtn.UsageError, match="confidence must be above 0 and below 1"):
            unbounded.risk_cost_bounds(AVERSE, confidence)


def test_counts_with_a_prior() -> None:
    assert CostDistribution.from_counts({2: 17, 6: 2}, prior=0).outcomes == ((17 / 19, 2.0), (2 / 19, 6.0))
    assert CostDistribution.from_counts({2: 17, 6: 2}).outcomes == ((18 / 21, 2.0), (3 / 21, 6.0))
    seen = CostDistribution.from_counts({2: 17, 6: 2}, prior={6: 1, 30: 0.5})
    assert seen.outcomes == ((17 / 20.5, 2.0), (3 / 20.5, 6.0), (0.5 / 20.5, 30.0))
    assert CostDistribution.from_counts({1: 0, 2: 0}, prior=0.5).outcomes == ((0.5, 1.0), (0.5, 2.0))


@pytest.mark.parametrize(
    ("counts", "prior", "message"),
    [
        ({}, 1, "counts and prior are all 0"),
        ({1: 0}, 0, "counts and prior are all 0"),
        ({1: -1}, 1, "the count of 1 must be a finite number of at least 0, found -1"),
        ({1: 1}, -1, "the prior weight of 1 must be"),
        ({-1: 1}, 1, "a cost must be a finite number of at least 0, found -1"),
        ([1, 2], 1, "counts are a mapping"),
    ],
)
def test_wrong_counts(counts: dict[float, float], prior: float, message: str) -> None:
    with pytest.raises(statehtn.InputError, match=message):
        CostDistribution.from_counts(counts, prior)


def test_finite_distributions_of_scipy_become_lists_of_outcomes() -> None:
    law = CostDistribution.from_scipy(stats.randint(2, 4))
    assert isinstance(law, CostDistribution)
    assert law.outcomes == ((0.5, 2.0), (0.5, 3.0))
    shifted = CostDistribution.from_scipy(stats.binom(3, 0.5, loc=1))
    assert isinstance(shifted, CostDistribution)
    assert [cost for _, cost in shifted.outcomes] == [1, 2, 3, 4]
    own = stats.rv_discrete(values=([1, 5], [0.25, 0.75]))
    assert CostDistribution.from_scipy(own()) == CostDistribution.of([(0.25, 1), (0.75, 5)])


@pytest.mark.parametrize(
    ("distribution", "message"),
    [
        (stats.norm(10, 1), "norm\\(loc=10\\) can be as low as -inf, but a cost is at least 0; truncate it"),
        (stats.uniform(-1, 3), "can be as low as -1"),
        (stats.gamma, "the family 'gamma' without parameters"),
        (stats.gamma(-1), "the parameters of 'gamma' are out of their range"),
        (stats.gamma([1, 2]), "the parameters of 'gamma' must be numbers"),
        (stats.foldcauchy(1), "has no finite mean"),
        (stats.pareto(0.9), "has no finite mean"),
        (stats.zipf(3), "has infinitely many outcomes"),
        (3, "expected a frozen distribution such as"),
    ],
)
def test_what_is_no_cost(distribution: object, message: str) -> None:
    with pytest.raises(statehtn.StateHtnError, match=message):
        CostDistribution.from_scipy(distribution)


def test_laws_of_scipy_compare_print_and_pickle() -> None:
    law = CostDistribution.from_scipy(stats.gamma(2, scale=3))
    assert law == CostDistribution.from_scipy(stats.gamma(a=2, scale=3.0))
    assert law != CostDistribution.from_scipy(stats.gamma(2, scale=4))
    assert hash(law) == hash(CostDistribution.from_scipy(stats.gamma(2, 0, 3)))
    assert str(law) == "gamma(a=2, scale=3)"
    assert pickle.loads(pickle.dumps(law)) == law
    first, second = (stats.rv_histogram(([1, weight], [0, 1, 2]))() for weight in (1, 2))
    assert CostDistribution.from_scipy(first) != CostDistribution.from_scipy(second)
    uniform = CostDistribution.from_scipy(first).exponential_mean(0.7)
    assert uniform == pytest.approx(CostDistribution.from_scipy(stats.uniform(0, 2)).exponential_mean(0.7))


def test_a_problem_with_continuous_costs(vehicle: statehtn.Problem) -> None:
    brake = CostDistribution.from_scipy(stats.gamma(2, scale=0.5))
    problem = statehtn.with_cost(vehicle, "brake", stats.gamma(2, scale=0.5), 0.25)
    assert problem == statehtn.with_cost(vehicle, "brake", brake, 0.25)
    result = statehtn.plan(problem, attitude="averse", alpha=0.2)
    assert result.status == "optimal"
    law = next(step.law for step in result.steps if step.step.action == "brake")
    assert law == CostSum((brake, CostDistribution.certain(0.25)))
    price = result.utility.risk_cost(law)
    assert price == pytest.approx(0.25 - 2 * math.log(1 - 0.2 * 0.5) / 0.2)
    entry = next(entry for entry in result.to_dict()["plan"] if entry["action"] == "brake")
    assert entry == {
        "action": "brake",
        "arguments": ["l5"],
        "expected_cost": 1.25,
        "risk_cost": price,
        "outcomes": None,
        "law": "gamma(a=2, scale=0.5) + 0.25",
    }
    json.dumps(result.to_dict(), allow_nan=False)
    assert "gamma(a=2, scale=0.5) + 0.25" in str(result)
    assert result.plan is not None
    total = result.plan.cost_distribution()
    assert isinstance(total, TotalCost)
    assert total.mean == pytest.approx(result.expected_cost)
    drawn = result.plan.simulate(20_000, seed=1)
    assert drawn.mean() == pytest.approx(total.mean, abs=5 * total.standard_deviation / math.sqrt(20_000))
    assert (drawn > 22).mean() == pytest.approx(total.exceedance(22), abs=0.02)


def test_laws_under_conditions(vehicle: statehtn.Problem) -> None:
    slippery = "(and (slippery ?from ?to) (not (esp-active)))"
    problem = statehtn.with_cost(vehicle, "accelerate", stats.uniform(5, 10), when=slippery)
    law = CostDistribution.from_scipy(stats.uniform(5, 10))
    plan = statehtn.plan(vehicle, attitude="seeking", alpha=0.9).plan
    assert plan is not None
    before, after = (statehtn.validate(p, plan).costs for p in (vehicle, problem))
    changed = [step for step, old, new in zip(plan.steps, before, after, strict=True) if old != new]
    assert [str(step) for step in changed] == ["(accelerate l4 e)"]
    assert after[6] == law
    assert statehtn.plan(problem).expected_cost == pytest.approx(18.35)


def test_an_infinite_price_names_the_action(vehicle: statehtn.Problem) -> None:
    problem = statehtn.with_cost(vehicle, "brake", stats.lognorm(1))
    assert statehtn.plan(problem, attitude="seeking", alpha=1)
    with pytest.raises(statehtn.InputError, match=r"the cost of \(brake l\d\): lognorm\(s=1\): .* is infinite"):
        statehtn.plan(problem, attitude="averse", alpha=0.01)


def test_what_has_no_hddl_says_so(vehicle: statehtn.Problem) -> None:
    law = CostDistribution.from_scipy(stats.gamma(2, scale=0.5))
    assert isinstance(law, ScipyCost)
    problem = statehtn.with_cost(vehicle, "brake", law)
    with pytest.raises(statehtn.UnsupportedError, match=r"the cost of action 'brake' is gamma.*law.discretised\(20\)"):
        statehtn.write_hddl(problem)
    written = statehtn.write_hddl(statehtn.with_cost(vehicle, "brake", law.discretised(5)))
    assert statehtn.plan(statehtn.read_hddl_text(*written)).expected_cost == pytest.approx(
        statehtn.plan(problem).expected_cost
    )


def test_callables_may_answer_with_laws(vehicle: statehtn.Problem) -> None:
    problem = statehtn.with_cost(vehicle, "brake", lambda _place: stats.gamma(2, scale=0.5))
    direct = statehtn.plan(statehtn.with_cost(vehicle, "brake", stats.gamma(2, scale=0.5)))
    assert statehtn.plan(problem).steps == direct.steps
    with pytest.raises(statehtn.UnsupportedError, match=r"the external cost of \(brake l\d\) is gamma"):
        statehtn.tabulate_costs(problem)
    wrong = statehtn.with_cost(vehicle, "brake", lambda _place: stats.norm(1, 1))
    with pytest.raises(statehtn.InputError, match=r"the external cost of \(brake l\d\): norm\(loc=1\) can be as low"):
        statehtn.plan(wrong)
    with pytest.raises(statehtn.InputError, match="the family 'gamma' without parameters"):
        statehtn.with_cost(vehicle, "brake", stats.gamma)


def test_plans_know_what_they_cost(vehicle: statehtn.Problem) -> None:
    result = statehtn.plan(vehicle, attitude="seeking", alpha=0.9)
    assert result.plan is not None
    law = result.plan.cost_distribution()
    assert isinstance(law, CostDistribution)
    assert len(law.outcomes) == 24
    assert law.mean == pytest.approx(22.8)
    assert (law.least, law.most) == (5.5, 32)
    assert AVERSE.risk_cost(law) == pytest.approx(sum(AVERSE.risk_cost(step.law) for step in result.steps))
    drawn = result.plan.simulate(50_000, seed=4)
    assert {round(cost, 6) for cost in drawn} <= {round(cost, 6) for _, cost in law.outcomes}
    assert (drawn <= 20).mean() == pytest.approx(law.cdf(20), abs=0.01)
    assert (result.plan.simulate(10, seed=4) == result.plan.simulate(10, seed=4)).all()
    read = statehtn.read_plan(statehtn.write_plan(result.plan, vehicle), vehicle)
    with pytest.raises(statehtn.UsageError, match="does not know what its steps cost"):
        read.cost_distribution()
    costs = statehtn.validate(vehicle, read).costs
    assert read.with_costs(costs).cost_distribution() == law
    with pytest.raises(statehtn.UsageError, match="needs a cost for each, found 1"):
        read.with_costs(costs[:1])
    with pytest.raises(statehtn.UsageError, match="runs must be from 1"):
        result.plan.simulate(0, seed=1)
    assert Plan((Step("a"),)) == Plan((Step("a"),), costs=(law,))


@pytest.mark.parametrize("question", ["quantile", "cvar"])
def test_levels_are_probabilities(question: str) -> None:
    for law in (CostDistribution.certain(1), CostDistribution.from_scipy(stats.gamma(2))):
        for level in (-0.1, 1.5, math.nan):
            with pytest.raises(statehtn.UsageError, match="must be between 0 and 1"):
                getattr(law, question)(level)
        assert getattr(law, question)(1) == law.most


def test_laws_can_be_drawn() -> None:
    pytest.importorskip("matplotlib")
    import matplotlib as mpl

    mpl.use("Agg")
    for law in (
        CostDistribution.of([(0.5, 1), (0.5, 3)]),
        CostDistribution.certain(0),
        CostDistribution.from_scipy(stats.gamma(2)),
        CostSum((CostDistribution.from_scipy(stats.gamma(2)), CostDistribution.certain(1))),
    ):
        axes = law.plot()
        heights = axes.lines[0].get_ydata()
        assert heights[0] == 0
        assert max(heights) == pytest.approx(1, abs=1e-3)
        axes.figure.clear()


def test_two_laws_in_one_figure() -> None:
    mpl = pytest.importorskip("matplotlib")
    mpl.use("Agg")
    from matplotlib import pyplot

    bus, train = CostDistribution.of([(0.7, 20), (0.3, 45)]), CostDistribution.of([(0.5, 25), (0.4, 30), (0.1, 60)])
    figure, (left, right) = pyplot.subplots(1, 2)
    bus.plot(left)
    train.plot(right)
    figure.canvas.draw()
    for axes in (left, right):
        inside, legend = axes.get_window_extent(), axes.get_legend().get_window_extent()
        assert inside.contains(*legend.min)
        assert inside.contains(*legend.max)
    pyplot.close(figure)

    axes = bus.plot()
    assert train.plot(axes, label="the train") is axes
    curves = [line for line in axes.lines if len(line.get_xdata()) > 2]
    assert [curve.get_label() for curve in curves] == ["20 w.p. 0.7, 45 w.p. 0.3", "the train"]
    assert len({curve.get_color() for curve in curves}) == 2
    assert {tuple(curve.get_xdata()[[0, -1]]) for curve in curves} == {axes.get_xlim()}
    assert [line.get_color() for line in axes.lines] == [curve.get_color() for curve in curves for _ in range(4)]
    assert CostDistribution.certain(3).plot(axes, color="black").lines[-1].get_color() == "black"
    pyplot.close(axes.figure)


def test_scipy_and_numpy_are_only_imported_when_they_are_needed() -> None:
    code = (
        "import statehtn, sys; p = statehtn.read_hddl(*sys.argv[1:]); r = statehtn.plan(p, attitude='averse', alpha=1);"
        "r.plan.cost_distribution().quantile(0.9); print({'numpy', 'scipy'} & set(sys.modules))"
    )
    run = subprocess.run([sys.executable, "-c", code, *AV], capture_output=True, text=True, check=True)
    assert run.stdout.strip() == "set()"


ERRAND = """
(define (domain errand) (:predicates (there)) (:functions (total-cost) - number)
  (:action go :parameters () :effect (and (there) (increase (total-cost) 1))))
"""
ONE_ERRAND = "(define (problem p) (:domain errand) (:htn :subtasks (go)) (:init))"


def test_a_law_of_many_samples_stays_one_object() -> None:
    law = CostDistribution.from_samples([2 + number / 1000 for number in range(3000)], most=9)
    problem = statehtn.with_cost(statehtn.read_hddl_text(ERRAND, ONE_ERRAND), "go", law)
    result = statehtn.plan(problem, attitude="averse", alpha=0.5)
    assert result.steps[0].law is law
    text = statehtn.write_hddl(problem)[0]
    assert text.count("(increase (total-cost)") == 3000
    again = statehtn.plan(statehtn.read_hddl_text(text, ONE_ERRAND), attitude="averse", alpha=0.5)
    assert again.risk_cost == pytest.approx(result.risk_cost, rel=1e-12)
