"""What a law of costs is worth to each objective, compared with exact arithmetic."""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction

import pytest
from hypothesis import given
from hypothesis import strategies as st

from statehtn import CostDistribution, objective
from statehtn.model.cost.sum import total_cost
from statehtn.risk import Keep
from tests.exact_laws import Law, Laws
from tests.exact_objectives import exact_objective
from tests.lotteries import FAMILIES, budgets
from tests.shares import share_of_examples

SHARE = share_of_examples(3)

Drawn = Mapping[Fraction, Fraction]


@st.composite
def outcomes(draw: st.DrawFn) -> Drawn:
    weights = draw(st.dictionaries(st.integers(0, 20), st.integers(1, 12), min_size=1, max_size=5))
    unit = draw(st.sampled_from((Fraction(1, 2), Fraction(1), Fraction(1, 10), Fraction(7, 4))))
    return {cost * unit: Fraction(weight, sum(weights.values())) for cost, weight in weights.items()}


def both(drawn: list[Drawn]) -> tuple[Law, object]:
    """The law of the sum of independent costs: the judge's and the planner's."""
    laws = Laws()
    exact = laws.zero
    for part in drawn:
        exact = laws.sum(exact, laws.of(part))
    parts = (CostDistribution.of((float(p), float(cost)) for cost, p in part.items()) for part in drawn)
    return exact, total_cost(list(parts))


@pytest.mark.parametrize("family", FAMILIES)
@SHARE
@given(data=st.data(), drawn=st.lists(outcomes(), min_size=1, max_size=4))
def test_values(family: str, data: st.DataObject, drawn: list[Drawn]) -> None:
    text = data.draw(FAMILIES[family])
    exact, law = both(drawn)
    expected = float(exact_objective(text).value(exact))
    assert objective(text).value(law) == pytest.approx(expected, rel=1e-11, abs=1e-12)


@SHARE
@given(drawn=st.lists(outcomes(), min_size=1, max_size=4), keep=budgets())
def test_budgets(drawn: list[Drawn], keep: tuple[tuple[Fraction, Fraction], ...]) -> None:
    exact, law = both(drawn)
    for budget, probability in keep:
        kept = Keep(float(budget), float(probability))
        assert kept.attained(law) == pytest.approx(float(exact.at_most(budget)), abs=1e-14)
        assert kept.holds(law) == (exact.at_most(budget) >= probability - Fraction(1, 10**12))
