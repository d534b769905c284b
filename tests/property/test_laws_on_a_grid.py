"""Laws in the core against fractions: sums, values, bounds, and which law is as good as another one."""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction
from itertools import accumulate, pairwise

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

import statehtn._relax as _relax
from statehtn.core.law_objectives import EXPONENTIAL
from statehtn.risk.objectives import objective
from tests.exact_laws import Laws
from tests.exact_objectives import exact_objective
from tests.grid_laws import Law, above, add, cvar, excess, laws, mean, quantile, shifted, summed
from tests.lotteries import ALPHAS, FINITE, texts
from tests.shares import share_of_examples

SHARE = share_of_examples(3)

ROUNDING = 1e-9
Value = Callable[[Law], Fraction]


def expected(disutility: Callable[[int], Fraction]) -> Value:
    return lambda law: sum((p * disutility(cost) for cost, p in law.items()), Fraction(0))


@st.composite
def objectives(draw: st.DrawFn) -> tuple[_relax.LawObjective, Value]:
    """An objective of the core, and its value by fractions. The step of the grid is a quarter."""
    step, level = Fraction(1, 4), Fraction(draw(st.sampled_from(("0.5", "0.9", "0.95", "0.05", "0.999"))))
    budget = draw(st.integers(0, 24))
    kinds = ("deadline", "overrun", "piecewise", "quantile", "cvar", "mean-cvar", "evar", "exponential", "table")
    match draw(st.sampled_from(kinds)):
        case "deadline":
            late = _relax.ExpectedDisutility(0.0, 0.0, [(float(budget), 1.0, 0.0)])
            return late, lambda law: above(law, budget)
        case "overrun":
            kink = Fraction(2 * budget + 1, 2)
            over = _relax.ExpectedDisutility(0.0, 0.0, [(float(kink), 0.0, float(step))])
            return over, lambda law: step * excess(law, kink)
        case "piecewise":
            slopes = draw(st.lists(st.integers(0, 4), min_size=2, max_size=4))
            kinks = sorted(draw(st.sets(st.integers(0, 24), min_size=len(slopes) - 1, max_size=len(slopes) - 1)))
            rises = [later - before for before, later in pairwise(slopes)]
            core = _relax.ExpectedDisutility(
                -3.0, float(slopes[0]), [(float(at), 0.0, float(rise)) for at, rise in zip(kinks, rises, strict=True)]
            )
            return (
                core,
                lambda law: (
                    -3 + slopes[0] * mean(law) + sum(r * excess(law, at) for at, r in zip(kinks, rises, strict=True))
                ),
            )
        case "quantile":
            return _relax.QuantileOfLaw(float(level), float(step)), lambda law: step * quantile(law, level)
        case "cvar":
            return _relax.MeanCvarOfLaw(float(level), 1.0, float(step)), lambda law: step * cvar(law, level)
        case "mean-cvar":
            weight = Fraction(draw(st.integers(0, 4)), 4)
            mixed = _relax.MeanCvarOfLaw(float(level), float(weight), float(step))
            return mixed, lambda law: step * ((1 - weight) * mean(law) + weight * cvar(law, level))
        case "evar":
            exact = exact_objective(f"evar {float(level)!r}").value
            evar = _relax.EvarOfLaw(float(level), float(step))
            return evar, lambda law: exact(Laws().of({step * cost: p for cost, p in law.items()}))
        case "exponential":
            text = draw(st.one_of(texts(("averse ", "seeking "), ALPHAS), FINITE["one-switch"], FINITE["exponentials"]))
            certain = EXPONENTIAL[type(objective(text))](objective(text), step, 0.0)
            exact = exact_objective(text).value
            return certain, lambda law: exact(Laws().of({step * cost: p for cost, p in law.items()}))
    table = list(accumulate(draw(st.lists(st.integers(0, 3), min_size=2, max_size=30)), initial=-5))
    tabled = _relax.TabulatedDisutility([float(value) for value in table])
    return tabled, expected(lambda cost: Fraction(table[min(cost, len(table) - 1)]))


def table_for(objective: _relax.LawObjective) -> _relax.LawTable:
    return _relax.LawTable(objective.last, objective.is_flat_beyond)


@SHARE
@given(parts=st.lists(laws(), min_size=1, max_size=5))
def test_a_sum_is_the_convolution(parts: list[Law]) -> None:
    table, total = _relax.LawTable(), 0
    for part in parts:
        total = table.sum(total, add(table, part))
    at, probabilities = table.outcomes(total)
    exact = summed(*parts)
    assert at == sorted(exact)
    assert probabilities == pytest.approx([float(exact[cost]) for cost in sorted(exact)], rel=1e-14)


@SHARE
@given(parts=st.lists(laws(), min_size=1, max_size=4), last=st.integers(0, 40), is_flat=st.booleans())
def test_what_lies_beyond_a_bound_keeps_its_mean(parts: list[Law], last: int, is_flat: bool) -> None:
    table, total = _relax.LawTable(float(last), is_flat), 0
    for part in parts:
        total = table.sum(total, add(table, part))
    at, probabilities = table.outcomes(total)
    exact = summed(*parts)
    assert [cost for cost in at if cost <= last] == sorted(cost for cost in exact if cost <= last)
    beyond = above(exact, last)
    assert sum(p for cost, p in zip(at, probabilities, strict=True) if cost > last) == pytest.approx(float(beyond))
    if beyond:
        expected = last + 1 if is_flat else last + excess(exact, last) / beyond
        assert at[-1] == pytest.approx(float(expected))


@SHARE
@given(parts=st.lists(laws(most=60), min_size=2, max_size=4), most=st.integers(1, 10))
def test_smaller_laws_are_rounded_down(parts: list[Law], most: int) -> None:
    table, total = _relax.LawTable(most_outcomes=most), 0
    for part in parts:
        total = table.sum(total, add(table, part))
    at, probabilities = table.outcomes(total)
    assert len(at) <= most
    exact = summed(*parts)
    for cost in exact:
        less = sum(p for other, p in zip(at, probabilities, strict=True) if other > cost)
        assert less <= above(exact, cost) + ROUNDING


@SHARE
@given(parts=st.lists(laws(most=60), min_size=2, max_size=4), most=st.integers(1, 10))
def test_smaller_laws_that_keep_their_means_are_less_risky(parts: list[Law], most: int) -> None:
    table, total = _relax.LawTable(most_outcomes=most, keeps_means=True), 0
    for part in parts:
        total = table.sum(total, add(table, part))
    at, probabilities = table.outcomes(total)
    assert len(at) <= most
    exact = summed(*parts)
    assert sum(p * cost for cost, p in zip(at, probabilities, strict=True)) == pytest.approx(float(mean(exact)))
    for cost in at:
        less = sum(p * max(other - cost, 0.0) for other, p in zip(at, probabilities, strict=True))
        assert less <= excess(exact, Fraction(cost)) + ROUNDING


@SHARE
@given(objective=objectives(), parts=st.lists(laws(), min_size=1, max_size=4))
def test_values(objective: tuple[_relax.LawObjective, Value], parts: list[Law]) -> None:
    core, value = objective
    table, total = table_for(core), 0
    for part in parts:
        total = table.sum(total, add(table, part))
    assert core.value(table, total) == pytest.approx(float(value(summed(*parts))), rel=1e-12, abs=1e-12)


@SHARE
@given(objective=objectives(), law=laws(), to_come=st.lists(laws(), min_size=1, max_size=3), floor=st.integers(0, 8))
def test_bounds_of_sums(objective: tuple[_relax.LawObjective, Value], law: Law, to_come: list[Law], floor: int) -> None:
    core, value = objective
    rest = summed(*to_come)
    floored: Law = {}
    for cost, p in rest.items():
        floored[max(cost, floor)] = floored.get(max(cost, floor), Fraction(0)) + p
    exact = float(value(summed(law, floored)))
    table = table_for(core)
    others = _relax.LawTable(core.last, True) if core.is_flat_beyond else _relax.LawTable()
    bound = core.bound_of_sum(table, add(table, law), others, add(others, rest), float(floor))
    assert bound <= exact
    assert bound == pytest.approx(exact, rel=ROUNDING, abs=ROUNDING)
    certain = core.bound(table, add(table, law), float(floor))
    assert certain <= float(value(shifted(law, floor)))
    assert certain == pytest.approx(float(value(shifted(law, floor))), rel=ROUNDING, abs=ROUNDING)


@SHARE
@given(objective=objectives(), laws_=st.tuples(laws(), laws()), least=st.integers(0, 6), data=st.data())
def test_a_law_that_is_as_good_never_loses(
    objective: tuple[_relax.LawObjective, Value], laws_: tuple[Law, Law], least: int, data: st.DataObject
) -> None:
    core, value = objective
    table = table_for(core)
    one, other = (add(table, law) for law in laws_)
    assume(_relax.is_as_good(core, table, one, other, float(least), _relax.LawOptions()))
    for _ in range(5):
        rest = shifted(data.draw(laws(most=30)), least)
        ours, theirs = (value(summed(law, rest)) for law in laws_)
        assert ours <= theirs + Fraction(1, 10**10) * max(1, abs(theirs))
