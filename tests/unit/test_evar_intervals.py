"""Intervals with a line below the values of all plans, of the sweep for the entropic value at risk."""

from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from statehtn.sweeps.evar import Interval

VALUES = st.floats(-10, 10)


@given(low=VALUES, high=VALUES, other_low=VALUES, other_high=VALUES)
def test_two_lines_are_not_mixed(low: float, high: float, other_low: float, other_high: float) -> None:
    """A value may be as low as the higher one of two lines; the larger values at both ends would be above that."""
    found = Interval.of(2, 6, low, high).raised(other_low, other_high)
    assert found.bound == max(min(low, high), min(other_low, other_high))
    for share in (0, 0.25, 0.5, 1):
        known = max(one + share * (other - one) for one, other in ((low, high), (other_low, other_high)))
        assert found.at_low + share * (found.at_high - found.at_low) <= known + 1e-12


@given(low=VALUES, high=VALUES, above=st.floats(1e-6, 20), touching=st.floats(2, 6))
def test_the_parts_of_an_interval_are_bounded_no_worse(low: float, high: float, above: float, touching: float) -> None:
    interval = Interval.of(2, 6, low, high)
    value = interval.bound + above
    point = interval.weak_point(value, touching)
    assert 2 < point < 6
    parts = interval.split(point)
    assert [(part.low, part.high) for part in parts] == [(2, point), (point, 6)]
    assert all(part.bound >= interval.bound - 1e-12 for part in parts)
    if max(low, high) > value + 0.3 * abs(high - low):  # enough of it is proven
        assert max(part.bound for part in parts) >= value - 1e-9
