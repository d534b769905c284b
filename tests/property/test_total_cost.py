"""The distribution of a plan's total cost: exact where it can be, and close where it is put on a grid."""

from __future__ import annotations

import math
from functools import reduce

import pytest
from hypothesis import given
from hypothesis import strategies as st

from statehtn.model.costs import CostDistribution

np = pytest.importorskip("numpy", reason="the distributions are arrays")

from statehtn.experiments.report.total_cost import TotalCost, total_cost  # noqa: E402


@st.composite
def laws(draw: st.DrawFn, digits: int = 1) -> CostDistribution:
    weights = draw(st.lists(st.integers(1, 9), min_size=1, max_size=3))
    costs = draw(st.lists(st.integers(0, 10**digits * 20), min_size=len(weights), max_size=len(weights)))
    return CostDistribution.of(
        (weight / sum(weights), cost / 10**digits) for weight, cost in zip(weights, costs, strict=True)
    )


def chance_of_at_most(total: TotalCost, cost: float) -> float:
    return float(total.probabilities[total.costs <= cost + 1e-6].sum())


@given(st.lists(laws(), max_size=5))
def test_it_is_the_convolution(parts: list[CostDistribution]) -> None:
    expected = reduce(CostDistribution.convolve, parts, CostDistribution.certain(0))
    total = total_cost(parts)
    assert total.is_exact
    assert total.mean == pytest.approx(sum(law.mean for law in parts))
    for _, cost in expected.outcomes:
        chance = math.fsum(p for p, c in expected.outcomes if c <= cost + 1e-6)
        assert chance_of_at_most(total, cost) == pytest.approx(chance)
    assert len(total.costs) <= len(expected.outcomes)  # sums that only rounding tells apart are one


@given(st.lists(laws(digits=6), min_size=3, max_size=6), st.integers(10, 60))
def test_a_grid_keeps_the_mean_and_the_ends_and_moves_nothing_far(parts: list[CostDistribution], points: int) -> None:
    exact, coarse = total_cost(parts), total_cost(parts, points)
    assert len(coarse.costs) <= points
    assert coarse.is_exact == (len(exact.costs) <= points) or coarse.is_exact is False
    assert coarse.probabilities.sum() == pytest.approx(1)
    assert coarse.mean == pytest.approx(exact.mean)
    assert coarse.least == pytest.approx(exact.least)
    assert coarse.most == pytest.approx(exact.most)
    moved = len(parts) * (exact.most - exact.least) / (points - 1) + 1e-6
    for cost in np.linspace(exact.least, exact.most, 7).tolist():
        assert chance_of_at_most(coarse, cost + moved) >= chance_of_at_most(exact, cost) - 1e-9
        assert chance_of_at_most(coarse, cost - moved) <= chance_of_at_most(exact, cost) + 1e-9


@given(st.lists(laws(), min_size=1, max_size=4), st.floats(0.001, 0.999))
def test_a_quantile_is_the_least_cost_that_is_not_exceeded(parts: list[CostDistribution], share: float) -> None:
    total = total_cost(parts)
    quantile = total.quantile(share)
    assert chance_of_at_most(total, quantile) >= share - 1e-9
    below = total.costs[total.costs < quantile - 1e-6]
    assert not len(below) or chance_of_at_most(total, float(below[-1])) < share + 1e-9


def test_a_long_plan_with_odd_costs() -> None:
    parts = [CostDistribution.of([(0.3, math.sqrt(i + 1)), (0.7, math.pi * (i + 1))]) for i in range(200)]
    total = total_cost(parts)
    assert not total.is_exact
    assert total.mean == pytest.approx(sum(law.mean for law in parts))
    variance = sum(0.3 * 0.7 * (math.sqrt(i + 1) - math.pi * (i + 1)) ** 2 for i in range(200))
    found = float(total.probabilities @ (total.costs - total.mean) ** 2)
    assert found == pytest.approx(variance, rel=0.01)
