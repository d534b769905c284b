"""What floats stand for."""

from __future__ import annotations

from fractions import Fraction

from hypothesis import given
from hypothesis import strategies as st

from statehtn.model import CostDistribution
from statehtn.model.cost.sum import total_cost
from statehtn.model.fraction import fraction_of


@given(st.floats(allow_nan=False, allow_infinity=False))
def test_it_is_the_same_float(number: float) -> None:
    assert float(fraction_of(number)) == number


@given(st.integers(-3000, 3000), st.integers(1, 15), st.sampled_from((1, 10, 100, 1000)))
def test_small_fractions_of_short_decimals(numerator: int, denominator: int, tens: int) -> None:
    exact = Fraction(numerator, denominator * tens)
    assert fraction_of(float(exact)) == exact


@given(st.integers(-(10**9), 10**9), st.integers(0, 6))
def test_what_is_written_with_few_digits_is_a_decimal(digits: int, places: int) -> None:
    exact = Fraction(digits, 10**places)
    assert fraction_of(float(exact)) == exact


def test_thirds_add_up_to_whole_numbers() -> None:
    third = CostDistribution.of([(0.5, 1 / 3), (0.5, 2 / 3)])
    assert [cost for _, cost in total_cost([third] * 3).outcomes] == [1, 4 / 3, 5 / 3, 2]
