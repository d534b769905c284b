"""Sums of numbers that are not negative."""

from __future__ import annotations

import math
from collections.abc import Iterable


def sum_of_positive(numbers: Iterable[float]) -> float:
    """Return the sum of numbers that are not negative, rounded once; infinite where a float cannot hold it."""
    try:
        return math.fsum(numbers)
    except OverflowError:
        return math.inf
