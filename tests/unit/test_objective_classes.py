"""Objectives as objects: what they are told, what they refuse, and which of the paper's classes they are in."""

from __future__ import annotations

import math
from collections.abc import Callable
from decimal import Decimal
from fractions import Fraction
from typing import Any

import numpy
import pytest
from scipy import stats

import statehtn
from statehtn import CostDistribution, InputError, Keep, UsageError
from statehtn.model import CostLaw, CostSum
from statehtn.risk import (
    OBJECTIVES,
    AdditiveObjective,
    CallableUtility,
    Exponentials,
    MeanDeviation,
    Objective,
    OneSwitch,
    Piecewise,
    Term,
    certainty_equivalent,
    objective,
    problem_class,
)

EVEN = CostDistribution.of([(0.5, 0), (0.5, 10)])
GAMMA = CostDistribution.from_scipy(stats.gamma(2, scale=3))


def loss(cost: float) -> float:
    return -cost


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("cvr 0.95", "unknown objective 'cvr' (did you mean 'cvar'?); there are neutral, averse"),
        ("", "unknown objective ''"),
        ("cvar", "objective 'cvar': it takes 1 number, found 0; write cvar LEVEL"),
        ("cvar 1", "objective 'cvar 1': the level must be above 0 and below 1, such as 0.95, found 1"),
        ("quantile 0", "the level must be above 0 and below 1"),
        ("evar nan", "the level must be above 0 and below 1"),
        ("mean-cvar 0.9", "it takes 2 numbers, found 1; write mean-cvar LEVEL W"),
        ("mean-cvar 0.9 1.1", "the weight of the CVaR must be from 0 to 1, found 1.1"),
        ("neutral 3", "it takes no numbers, found 1; write neutral"),
        ("averse", "it takes 1 number, found 0; write averse A"),
        ("seeking -1", "alpha must be a positive finite number, found -1"),
        ("averse x", "'x' is no number; write averse A"),
        ("mean-variance -1", "the weight of the variance must be a finite number of at least 0, found -1"),
        ("mean-deviation inf", "the weight of the deviation must be a finite number of at least 0, found inf"),
        ("deadline -1", "the deadline must be a finite number of at least 0"),
        ("overrun 1 2", "it takes 1 number, found 2; write overrun D"),
        ("one-switch alpha=1 tradeoff=1", "wealth is missing; write one-switch alpha=A tradeoff=D wealth=W"),
        ("one-switch", "alpha and tradeoff and wealth are missing"),
        ("one-switch alfa=1 tradeoff=1 wealth=1", "it has no parameter 'alfa' (did you mean 'alpha'?)"),
        ("one-switch alpha=1 alpha=1 tradeoff=1 wealth=1", "alpha is there twice"),
        ("one-switch alpha=1 tradeoff=0 wealth=1", "the tradeoff must be a positive finite number, found 0"),
        ("one-switch alpha=1 tradeoff=1 wealth=inf", "the wealth must be a finite number"),
        ("one-switch alpha=1e200 tradeoff=1 wealth=1e200", "alpha times the wealth is too large"),
        ("exponentials 1:1", "linear is missing"),
        ("exponentials linear=0 1:0", "must be above 0, found 0 for all"),
        (
            "exponentials linear=1 1:-1",
            "the weight of the exponential of slope 1 must be a finite number of at least 0",
        ),
        ("exponentials linear=1 0:1", "must not be 0"),
        ("exponentials linear=1 1:1 1:2", "each slope of an exponential comes once, found 1 twice"),
        ("exponentials linear=1 3", "'3' is no pair of numbers with a colon between"),
        ("piecewise 0:0", "needs at least two points, found 1"),
        ("piecewise 0:0 10:1", "a utility of the cost must not rise, found 0 for 0 and 1 for 10"),
        ("piecewise 5:0 5:-1", "must be in the order of their costs, found 5 after 5"),
        ("piecewise 0:0 1:-inf", "the utility of a point must be a finite number"),
    ],
)
def test_what_is_wrong_with_a_text_is_said_in_one_line(text: str, words: str) -> None:
    with pytest.raises(UsageError) as error:
        objective(text)
    assert words in str(error.value)
    assert "\n" not in str(error.value)


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (lambda: objective(statehtn.Neutral), "an objective is its text form"),
        (lambda: objective(3), "an objective is its text form"),
        (lambda: Piecewise([1, 2]), "a point of a utility is a pair (cost, utility)"),
        (lambda: Piecewise(7), "must be a list"),
        (lambda: Exponentials(1, [3]), "an exponential is a pair (slope, weight)"),
        (lambda: CallableUtility(float), "a utility is a function of the total cost"),
        (lambda: CallableUtility("loss"), "a utility is a function of the total cost"),
        (lambda: objective("neutral").value(3), "expected the law of a cost"),
        (lambda: Keep.of("25"), "a budget to keep is written BUDGET PROBABILITY"),
        (lambda: Keep.of("25 often"), "a budget to keep is written BUDGET PROBABILITY"),
        (lambda: Keep.of(25), "a budget to keep is a Keep or the text"),
        (lambda: Keep.of("25 1.5"), "must be above 0 and at most 1, such as 0.95, found 1.5"),
        (lambda: Keep(25, 0), "must be above 0 and at most 1"),
        (lambda: Keep(-1, 0.5), "the budget to keep must be a finite number of at least 0"),
    ],
)
def test_what_is_wrong_with_an_object_is_said_in_one_line(make: Callable[[], object], words: str) -> None:
    with pytest.raises(UsageError) as error:
        make()
    assert words in str(error.value)
    assert "\n" not in str(error.value)


@pytest.mark.parametrize(
    ("function", "words"),
    [
        (lambda cost: cost, "the utility '<lambda>' rises: 0 for a cost of 0, 10 for 10"),
        (lambda cost: -cost if cost < 9.99 else 5, "rises: -0 for a cost of 0, 5 for 10"),
        (lambda cost: math.log(5 - cost), "the utility '<lambda>' fails for a cost of 10 with ValueError"),
        (lambda cost: -math.inf if cost > 5 else 0, "must be finite, found -inf"),
        (lambda cost: "bad", "must be a number, found 'bad'"),  # noqa: ARG005
        (lambda: 1, "fails for a cost of 0 with TypeError"),
    ],
)
def test_functions_that_are_no_utilities(function: Callable[..., object], words: str) -> None:
    with pytest.raises(UsageError) as error:
        objective(function).value(EVEN)
    assert words in str(error.value)


def test_functions_are_objectives() -> None:
    wanted = objective(loss)
    assert isinstance(wanted, CallableUtility)
    assert str(wanted) == "utility loss"
    assert objective(wanted) is wanted
    assert wanted.value(EVEN) == 5
    assert wanted.certainty_equivalent(EVEN) == pytest.approx(5)
    assert objective(lambda cost: numpy.float64(-cost)).value(EVEN) == 5
    half: Callable[[float], Any] = lambda cost: Decimal(-cost) / 2  # noqa: E731
    assert objective(half).value(EVEN) == 2.5


@pytest.mark.parametrize(
    ("function", "law", "expected"),
    [
        (lambda cost: -float(cost > 4), EVEN, None),  # a jump: no certain cost is half as bad
        (lambda cost: 0.0, EVEN, None),  # noqa: ARG005 (flat: every cost is as bad)
        (lambda cost: -min(cost, 6.0), EVEN, 3),
        (lambda cost: -max(cost - 5, 0), EVEN, 7.5),
        (lambda cost: -max(cost - 5, 0), CostDistribution.of([(0.5, 0), (0.5, 4)]), None),
        (lambda cost: -math.exp(cost), CostDistribution.certain(3), 3),
        (lambda cost: -cost, GAMMA, 6),
        (lambda cost: -math.expm1(cost / 10), GAMMA, -20 * math.log(0.7)),
    ],
)
def test_the_certain_cost_that_is_as_bad(
    function: Callable[[float], float], law: CostLaw, expected: float | None
) -> None:
    found = certainty_equivalent(objective(function), law)
    assert found == (None if expected is None else pytest.approx(expected, rel=1e-7))


def test_values_that_are_costs_are_certainty_equivalents() -> None:
    for text in (
        "neutral",
        "averse 0.3",
        "one-switch alpha=1 tradeoff=1 wealth=5",
        "cvar 0.5",
        "quantile 0.7",
        "evar 0.3",
    ):
        assert certainty_equivalent(objective(text), EVEN) == objective(text).value(EVEN)
    for text in ("deadline 4", "overrun 4"):
        assert certainty_equivalent(objective(text), EVEN) is None
    assert certainty_equivalent(objective("piecewise 0:0 5:0 10:-8"), EVEN) == pytest.approx(7.5)
    assert certainty_equivalent(objective("piecewise 0:0 20:-20"), GAMMA) == pytest.approx(6)


CLASSES = {
    **dict.fromkeys(("neutral",), "PS10011"),
    **dict.fromkeys(("averse 1", "seeking 1"), "PS10110"),
    **dict.fromkeys(("mean-variance 1",), "PS10211"),
    **dict.fromkeys(("success-utility alpha=1",), "PS10112"),
    **dict.fromkeys(("one-switch alpha=1 tradeoff=1 wealth=1",), "PS1120*"),
    **dict.fromkeys(
        ("exponentials linear=1 1:1", "deadline 1", "overrun 1", "piecewise 0:0 1:-1"),
        "PS1020*",
    ),
    **dict.fromkeys(("mean-deviation 1", "evar 0.5", "quantile 0.5", "cvar 0.5", "mean-cvar 0.5 0.5"), None),
}


@pytest.mark.parametrize(("text", "expected"), CLASSES.items())
def test_the_class_of_the_paper(text: str, expected: str | None) -> None:
    found = problem_class("state", objective(text))
    assert (None if found is None else str(found)) == expected
    if expected is not None:
        assert str(problem_class("plan", objective(text))) == expected.replace("PS", "PP")


def test_every_objective_has_a_class_or_none() -> None:
    assert sorted({text.split()[0] for text in CLASSES}) == sorted(OBJECTIVES)
    assert str(problem_class("state", objective(loss))) == "PS1020*"
    with pytest.raises(UsageError, match="unknown solver 'magic'"):
        problem_class("magic", objective("neutral"))


def test_prices_are_what_makes_an_objective_additive() -> None:
    additive = {text.split()[0] for text in CLASSES if isinstance(objective(text), AdditiveObjective)}
    assert additive == {"neutral", "averse", "seeking", "mean-variance", "success-utility"}
    assert all(isinstance(objective(text), Objective) for text in CLASSES)


def test_numbers_of_all_kinds_are_taken_and_written_in_short() -> None:
    assert (
        str(objective("one-switch wealth=40 alpha=0.90 tradeoff=2e1")) == "one-switch alpha=0.9 tradeoff=20 wealth=40"
    )
    assert str(statehtn.Deadline(Decimal("25.50"))) == "deadline 25.5"
    assert str(statehtn.Quantile(Fraction(1, 4))) == "quantile 0.25"
    assert str(statehtn.MeanVariance(numpy.float64(1e-5))) == "mean-variance 1e-05"
    assert str(Piecewise([(numpy.int64(0), 0), (10, -2.5)])) == "piecewise 0:0 10:-2.5"
    assert statehtn.MeanDeviation(-0.0) == MeanDeviation(0)
    assert str(statehtn.Exponential(statehtn.Attitude.AVERSE, 1)) == "averse 1"
    assert hash(Exponentials(1, [[0.5, 1]])) == hash(Exponentials(1.0, ((0.5, 1.0),)))


def test_terms_keep_weights_that_no_float_holds() -> None:
    poor, rich = OneSwitch(2, 1, -1000), OneSwitch(2, 1, 1000)
    assert poor.terms == (Term(2.0, math.log(0.5) + 2000),)
    assert rich.terms == (Term(2.0, math.log(0.5) - 2000),)
    nearly = OneSwitch(0.5, 0.5 * math.e, 2.0)  # ln(D/A) and A W nearly cancel
    assert abs(nearly.terms[0].log_weight) < 1e-16
    assert Exponentials(0, [(1, 2), (-1, 0)]).terms == (Term(1.0, math.log(2)),)
    assert (Exponentials(0, [(1, 2), (-1, 0)]).concave, Exponentials(0, [(-1, 2)]).concave) == (True, False)


def test_budgets_are_kept_to_a_rounding() -> None:
    law = CostDistribution.of([(0.1, 3)] * 9 + [(0.1, 30)])
    assert Keep(25, 0.9).attained(law) < 0.9 or Keep(25, 0.9).attained(law) == pytest.approx(0.9)
    assert Keep(25, 0.9).holds(law)
    assert not Keep(25, 0.9 + 1e-9).holds(law)
    assert Keep(30, 1).holds(law)
    assert str(Keep.of(" 25.0  0.90 ")) == "25 0.9"
    assert Keep.of(Keep(25, 0.9)) == Keep.of("25 0.9")
    assert objective("quantile 0.9").value(law) == 3


HEAVY = CostDistribution.from_scipy(stats.lognorm(1))
HEAVIER = CostDistribution.from_scipy(stats.pareto(1.5))


@pytest.mark.parametrize(
    ("text", "law"),
    [
        ("averse 1", HEAVY),
        ("one-switch alpha=1 tradeoff=1 wealth=1", HEAVY),
        ("evar 0.9", HEAVY),
        ("mean-variance 1", HEAVIER),
        ("mean-deviation 1", HEAVIER),
    ],
)
def test_what_is_infinite_is_an_error(text: str, law: CostLaw) -> None:
    with pytest.raises(InputError, match="infinite"):
        objective(text).value(law)


@pytest.mark.parametrize(
    "text", ["neutral", "mean-variance 0", "mean-deviation 0", "cvar 0.9", "quantile 0.9", "deadline 5"]
)
def test_what_is_finite_is_none(text: str) -> None:
    assert math.isfinite(objective(text).value(HEAVIER))


@pytest.mark.parametrize("text", [text for text in CLASSES if text != "exponentials linear=1 1:1"])
def test_laws_of_scipy_are_valued_as_lists_that_are_near(text: str) -> None:
    """Both ends of every cell, which enclose the law, enclose the value."""
    frozen = stats.gamma(2, scale=0.2)
    law = CostDistribution.from_scipy(frozen)
    edges = numpy.linspace(0, 12, 4001)
    masses = numpy.diff(frozen.cdf(edges))
    masses[-1] += frozen.sf(edges[-1])
    below, above = (
        CostDistribution.of(zip((masses / masses.sum()).tolist(), ends.tolist(), strict=True))
        for ends in (edges[:-1], edges[1:])
    )
    wanted = objective(text)
    assert wanted.value(below) - 1e-7 <= wanted.value(law) <= wanted.value(above) + 1e-7


@pytest.mark.parametrize("text", CLASSES)
def test_sums_are_valued_as_their_total(text: str) -> None:
    parts = (EVEN, CostDistribution.of([(0.25, 1), (0.75, 2.5)]), CostDistribution.certain(0.5))
    wanted = objective(text)
    assert wanted.value(CostSum(parts)) == pytest.approx(wanted.value(CostSum(parts).total), rel=1e-12)
