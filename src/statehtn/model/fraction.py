"""The fraction that a float stands for."""

from __future__ import annotations

from fractions import Fraction
from functools import lru_cache

DIGITS = 10**6
"""A decimal with so large a denominator has more digits than one usually writes ..."""
DENOMINATOR = 360_360_000
"""... and stands for a fraction with this denominator where one becomes the same float: for a half to a fifteenth of
anything with up to three decimals."""
MOST = 2**40
"""Up to so large a numerator hardly any other float is taken for such a fraction."""


@lru_cache(2**16)
def fraction_of(number: float) -> Fraction:
    """Return the fraction that a finite float stands for: 1/3 and its like, else the decimal that it prints as.

    Floating-point division rounds correctly, so that the fraction becomes the same float again.
    """
    decimal = Fraction(repr(number))
    if decimal.denominator > DIGITS and abs(scaled := number * DENOMINATOR) < MOST:
        numerator = round(scaled)
        if numerator / DENOMINATOR == number:
            return Fraction(numerator, DENOMINATOR)
    return decimal
