"""Linear equations of policies."""

from __future__ import annotations

import math

import pytest

from statehtn.policies.equations import FEW, solution


@pytest.mark.parametrize("count", [3, FEW + 1])
def test_equations_without_a_single_solution_have_infinite_ones(count: int) -> None:
    """A circle that is never left: dense equations say so, and sparse ones; without a warning."""
    circle = [(node, (node + 1) % count, 1.0) for node in range(count)]
    assert solution(circle, [1.0] * count, count) == [math.inf] * count
    half = [(row, column, 0.5) for row, column, _ in circle]
    assert solution(half, [1.0] * count, count) == pytest.approx([2.0] * count)
