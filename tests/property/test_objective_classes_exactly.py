"""Objectives on random laws: against their definitions, in their limits, and as their declarations say."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterable
from fractions import Fraction

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from statehtn.model import CostDistribution
from statehtn.model.cost.sum import total_cost
from statehtn.risk import (
    OBJECTIVES,
    AdditiveObjective,
    CallableUtility,
    ConditionalValueAtRisk,
    EntropicValueAtRisk,
    Exponential,
    MeanCvar,
    Neutral,
    Objective,
    OneSwitch,
    Overrun,
    Piecewise,
    ValueUnit,
    certainty_equivalent,
    objective,
)
from tests.exact_laws import Laws
from tests.exact_objectives import exact_objective
from tests.objectives import BY_NAME, COSTS, LEVELS, SLOPES, objectives, piecewise

ROUNDING = 1e-11
"""Of values, relative to themselves and to the largest cost."""


@st.composite
def weights(draw: st.DrawFn, count: int) -> list[float]:
    """Draw probabilities, tenths or of any size."""
    if draw(st.booleans()):
        cuts = sorted(draw(st.lists(st.integers(0, 10), min_size=count - 1, max_size=count - 1)))
        return [(high - low) / 10 for low, high in itertools.pairwise([0, *cuts, 10])]
    sizes = draw(st.lists(st.floats(1e-9, 1), min_size=count, max_size=count))
    return [size / math.fsum(sizes) for size in sizes]


@st.composite
def laws(draw: st.DrawFn, most: int = 4) -> CostDistribution:
    """Draw a law of few outcomes."""
    costs = draw(st.lists(COSTS, min_size=1, max_size=most, unique=True))
    return CostDistribution.of(zip(draw(weights(len(costs))), costs, strict=True))


@st.composite
def ordered_laws(draw: st.DrawFn, spread: bool) -> tuple[CostDistribution, CostDistribution]:
    """Draw two laws on one probability space: the second costs more in every case, and may be spread around that."""
    cases = draw(st.lists(st.tuples(COSTS, COSTS, COSTS, st.integers(1, 9)), min_size=1, max_size=4))
    probabilities = draw(weights(len(cases)))
    better, worse = [], []
    for probability, (cost, more, off, tenths) in zip(probabilities, cases, strict=True):
        better.append((probability, cost))
        share = tenths / 10
        below = min(off, cost + more) if spread else 0.0  # the mean of the two is cost + more
        worse.append((probability * share, cost + more - below))
        worse.append((probability * (1 - share), cost + more + below * share / (1 - share)))
    return CostDistribution.of(better), CostDistribution.of(worse)


def tolerance(wanted: Objective, *laws: CostDistribution) -> float:
    """Return how far values may be off: what a float loses, and a rounding of ln p divided by each slope."""
    slopes = [abs(term.slope) for term in getattr(wanted, "terms", ())]
    if isinstance(wanted, Exponential):
        slopes.append(wanted.alpha)
    largest = max([1e-3, *(law.most for law in laws), *(abs(wanted.value(law)) for law in laws)])
    return ROUNDING * largest + sum(1e-14 / slope for slope in slopes)


def exact_value(wanted: Objective, law: CostDistribution) -> float:
    """Return the value by the definition, in exact arithmetic; costs are tenths."""
    total = sum(Fraction(probability) for probability, _ in law.outcomes)
    exact = Laws().of({Fraction(str(cost)): Fraction(probability) / total for probability, cost in law.outcomes})
    return float(exact_objective(str(wanted)).value(exact))


def test_every_objective_that_has_a_name_is_drawn() -> None:
    assert sorted(BY_NAME) == sorted(OBJECTIVES)


@pytest.mark.parametrize("name", sorted(BY_NAME))
@given(st.data(), laws())
def test_the_value_is_what_the_definition_says(name: str, choice: st.DataObject, law: CostDistribution) -> None:
    wanted = choice.draw(BY_NAME[name])
    assert wanted.value(law) == pytest.approx(exact_value(wanted, law), abs=tolerance(wanted, law))


@given(piecewise(), laws())
def test_a_function_is_valued_as_the_pieces_that_it_has(wanted: Piecewise, law: CostDistribution) -> None:
    function = CallableUtility(wanted.utility)
    assert function.value(law) == wanted.value(law)
    assert function.certainty_equivalent(law) == wanted.certainty_equivalent(law)
    found = wanted.certainty_equivalent(law)
    if found is not None:
        assert law.least <= found <= law.most
        assert -wanted.utility(found) == pytest.approx(wanted.value(law), abs=1e-9)


@given(SLOPES.filter(lambda slope: slope < 1), laws())
def test_the_certain_cost_of_a_function_is_that_of_its_utility(alpha: float, law: CostDistribution) -> None:
    found = CallableUtility(lambda cost: -math.expm1(alpha * cost)).certainty_equivalent(law)
    expected = objective(f"averse {alpha!r}").value(law)
    # Utilities that differ by no more than rounding, beside the largest of them, have no certain cost of their own.
    assume(law.least == law.most or math.expm1(alpha * expected) > 1e-9 * math.expm1(alpha * law.most))
    assert found == pytest.approx(expected, rel=1e-6, abs=1e-6)


@given(objectives(), COSTS)
def test_a_certain_cost_has_itself_as_its_value(wanted: Objective, cost: float) -> None:
    law = CostDistribution.certain(cost)
    if wanted.unit == ValueUnit.COST and not isinstance(wanted, Overrun):
        assert wanted.value(law) == certainty_equivalent(wanted, law) == cost


@given(objectives())
def test_the_text_form_is_read_back(wanted: Objective) -> None:
    assert objective(str(wanted)) == wanted
    assert str(objective(str(wanted))) == str(wanted)


@given(objectives(), ordered_laws(spread=False))
def test_who_is_monotone_never_wants_to_pay_more(
    wanted: Objective, pair: tuple[CostDistribution, CostDistribution]
) -> None:
    better, worse = pair
    assert better.dominates(worse)
    if wanted.monotone:
        assert wanted.value(better) <= wanted.value(worse) + tolerance(wanted, *pair)


@given(objectives(), ordered_laws(spread=True))
def test_who_is_averse_never_wants_to_pay_more_or_less_surely(
    wanted: Objective, pair: tuple[CostDistribution, CostDistribution]
) -> None:
    better, worse = pair
    assert better.dominates(worse, order=2)
    if wanted.concave:
        assert wanted.value(better) <= wanted.value(worse) + tolerance(wanted, *pair)


EVEN = CostDistribution.of([(0.5, 0), (0.5, 10)])


@pytest.mark.parametrize(
    ("text", "better", "worse"),
    [
        ("mean-variance 1", EVEN, CostDistribution.certain(10)),
        ("mean-deviation 2", EVEN, CostDistribution.certain(10)),
        ("seeking 1", CostDistribution.certain(5), EVEN),
        ("exponentials linear=0 -1:1", CostDistribution.certain(5), EVEN),
        ("deadline 4", CostDistribution.certain(5), EVEN),
        ("quantile 0.5", CostDistribution.certain(5), EVEN),
        ("piecewise 0:0 4:-1 5:-1", CostDistribution.certain(4), CostDistribution.of([(0.5, 0), (0.5, 8)])),
    ],
)
def test_who_is_not_declared_so_is_not(text: str, better: CostDistribution, worse: CostDistribution) -> None:
    wanted = objective(text)
    assert not wanted.concave
    assert better.dominates(worse, order=2)
    assert wanted.value(better) > wanted.value(worse)
    if better.dominates(worse):
        assert not wanted.monotone


@given(st.lists(laws(3), min_size=1, max_size=4), objectives())
def test_prices_add_up(plan: list[CostDistribution], wanted: Objective) -> None:
    if isinstance(wanted, AdditiveObjective):
        total = total_cost(plan)
        prices = math.fsum(wanted.risk_cost(law) for law in plan)
        assert prices == pytest.approx(wanted.value(total), abs=len(plan) * tolerance(wanted, total))


@given(laws(), SLOPES, LEVELS, st.floats(-20, 200))
def test_limits(law: CostDistribution, alpha: float, level: float, wealth: float) -> None:
    mean, averse = Neutral().value(law), objective(f"averse {alpha!r}").value(law)
    near = 1e-6 * max(1, law.most)
    tiny = math.exp(-30 - alpha * law.most)  # against e^(alpha C), whatever C is
    assert OneSwitch(alpha, alpha * max(tiny, 1e-300), 0).value(law) == pytest.approx(mean, abs=near)
    assert OneSwitch(alpha, 1, law.most + 40 / alpha).value(law) == pytest.approx(mean, abs=near)
    assert OneSwitch(alpha, 1, -40 / alpha).value(law) == pytest.approx(averse, abs=near)
    assert mean - near <= OneSwitch(alpha, 1, wealth).value(law) <= averse + near
    cvar, evar = ConditionalValueAtRisk(level).value(law), EntropicValueAtRisk(level).value(law)
    assert mean - near <= cvar <= evar + near <= law.most + 2 * near
    assert ConditionalValueAtRisk(1e-12).value(law) == pytest.approx(mean, abs=near)
    assert EntropicValueAtRisk(1e-16).value(law) == pytest.approx(mean, abs=near)
    assert MeanCvar(level, 0).value(law) == pytest.approx(mean, abs=near)
    assert MeanCvar(level, 1).value(law) == pytest.approx(cvar, abs=near)


@given(laws(), SLOPES, st.lists(st.floats(-50, 500), min_size=2, max_size=6))
def test_the_richer_pay_less_for_certainty(law: CostDistribution, alpha: float, wealths: Iterable[float]) -> None:
    values = [OneSwitch(alpha, 1, wealth).value(law) for wealth in sorted(wealths)]
    slack = tolerance(OneSwitch(alpha, 1, 0), law)
    assert all(richer <= poorer + slack for poorer, richer in itertools.pairwise(values))


@given(laws(), laws(), SLOPES)
def test_preferences_switch_once_as_wealth_grows(law: CostDistribution, other: CostDistribution, alpha: float) -> None:
    agents = [OneSwitch(alpha, 1, wealth) for wealth in range(-20, 200, 10)]
    slack = max(tolerance(agent, law, other) for agent in agents)
    differences = [agent.value(law) - agent.value(other) for agent in agents]
    signs = [difference > 0 for difference in differences if abs(difference) > 10 * slack]
    assert sum(one != two for one, two in itertools.pairwise(signs)) <= 1


@pytest.mark.parametrize("wealth", [-30_000.0, 0.0, 12_000.0, 30_000.0])
@pytest.mark.parametrize("text", ["one-switch alpha=0.9 tradeoff=20 wealth={}", "exponentials linear=3 0.9:2 -0.5:4"])
def test_exponents_of_thousands_of_digits_do_not_overflow(text: str, wealth: float) -> None:
    law = CostDistribution.of([(0.25, 10_000), (0.5, 10_100), (0.25, 12_000)])  # e^(0.9 * 12000) has 4690 digits
    wanted = objective(text.format(wealth))
    assert wanted.value(law) == pytest.approx(exact_value(wanted, law), rel=1e-12)
