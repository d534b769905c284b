"""The judge of objectives is right itself: on laws whose values are known, and against plain definitions."""

from __future__ import annotations

import math
from fractions import Fraction

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.exact_laws import Law, Laws
from tests.exact_objectives import exact_objective
from tests.lotteries import FAMILIES
from tests.one_attitude import is_best_for_none

LAWS = Laws()


def law(*outcomes: tuple[str, str]) -> Law:
    return LAWS.of({Fraction(cost): Fraction(p) for p, cost in outcomes})


COIN = law(("0.5", "2"), ("0.5", "6"))
LATE = law(("0.9", "3"), ("0.1", "13"))


def value(text: str, of: Law) -> float:
    return float(exact_objective(text).value(of))


@pytest.mark.parametrize(
    ("text", "of", "expected"),
    [
        ("neutral", COIN, 4),
        ("averse 0.5", COIN, math.log((math.e + math.exp(3)) / 2) * 2),
        ("seeking 0.5", COIN, -math.log((math.exp(-1) + math.exp(-3)) / 2) * 2),
        ("mean-variance 0.5", COIN, 4 + 0.5 * 4),
        ("mean-deviation 3", COIN, 4 + 3 * 2),
        ("deadline 2", COIN, 0.5),
        ("deadline 1.9", COIN, 1),
        ("overrun 3", COIN, 1.5),
        ("piecewise 0:10 4:8 5:0", COIN, -(9 - 8) / 2),
        ("quantile 0.9", LATE, 3),
        ("quantile 0.91", LATE, 13),
        ("cvar 0.9", LATE, 13),
        ("cvar 0.8", LATE, 8),
        ("mean-cvar 0.8 0.25", LATE, 0.75 * 4 + 0.25 * 8),
        ("evar 0.9", LATE, 13),
        ("evar 0.5", law(("1", "7")), 7),
        ("exponentials linear=2", LATE, 4),
        ("exponentials 0.5:3", COIN, math.log((math.e + math.exp(3)) / 2) * 2),
        ("exponentials -0.5:3", COIN, -math.log((math.exp(-1) + math.exp(-3)) / 2) * 2),
        ("one-switch alpha=0.9 tradeoff=20 wealth=1000", LATE, 4),
        (
            "one-switch alpha=0.9 tradeoff=20 wealth=-1000",
            LATE,
            math.log(0.9 * math.exp(2.7) + 0.1 * math.exp(11.7)) / 0.9,
        ),
    ],
)
def test_known_values(text: str, of: Law, expected: float) -> None:
    assert value(text, of) == pytest.approx(expected, rel=1e-12)


def test_certainty_equivalents_are_what_makes_the_utility_equal() -> None:
    alpha, tradeoff, wealth = 0.5, 2.0, 6.0

    def utility(x: float) -> float:
        return x - tradeoff / alpha * math.exp(-alpha * x)

    certain = value(f"one-switch alpha={alpha} tradeoff={tradeoff} wealth={wealth}", LATE)
    assert utility(wealth - certain) == pytest.approx(0.9 * utility(wealth - 3) + 0.1 * utility(wealth - 13), rel=1e-12)


def test_entropic_value_at_risk_is_the_infimum() -> None:
    def bound(of: Law, a: float) -> float:
        return (math.log(sum(p * math.exp(a * cost) for cost, p in of.in_floats)) - math.log(0.5)) / a

    for of in (COIN, LATE, law(("0.2", "0"), ("0.3", "1"), ("0.5", "5"))):
        assert value("evar 0.5", of) == pytest.approx(min(bound(of, i / 1000) for i in range(1, 20_000)), rel=1e-6)


@given(text=st.sampled_from(list(FAMILIES)).flatmap(FAMILIES.get), data=st.data())
def test_what_holds_of_every_objective(text: str, data: st.DataObject) -> None:
    """A bound is a bound, and rises with what is added; a certain cost is worth itself, where values are costs."""
    costs = st.dictionaries(st.integers(0, 30), st.integers(1, 9), min_size=1, max_size=4)
    one, other = (
        LAWS.of({Fraction(cost, 2): Fraction(weight, sum(drawn.values())) for cost, weight in drawn.items()})
        for drawn in (data.draw(costs), data.draw(costs))
    )
    objective = exact_objective(text)
    total = LAWS.sum(one, other)
    assert objective.bound(one) <= objective.value(one)
    assert objective.bound(one) <= objective.bound(total) <= objective.value(total)
    if text.split()[0] not in ("deadline", "overrun", "piecewise", "success-utility"):
        certain = law(("1", "7"))
        assert value(text, certain) == pytest.approx(7, rel=1e-15)
        assert one.least <= objective.value(one)


def test_a_plan_that_is_best_for_no_exponential_utility() -> None:
    certain, gamble = law(("1", "6.2")), law(("0.3", "2"), ("0.7", "9"))
    punctual = law(("0.8", "6"), ("0.2", "20"))
    assert value("deadline 6", punctual) < min(value("deadline 6", certain), value("deadline 6", gamble))
    assert is_best_for_none(punctual, [certain, gamble, punctual])
    assert not is_best_for_none(certain, [certain, gamble, punctual])
    assert not is_best_for_none(gamble, [certain, gamble, punctual])
