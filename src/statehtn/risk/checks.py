"""Parameters of objectives: in their range, as floats, and as text."""

from __future__ import annotations

import math

from statehtn.errors import InputError, UsageError
from statehtn.expected import number
from statehtn.model.cost.law import CostLaw

MOST_WEIGHT = 1e100
"""Of a risk beside the mean: its square times a variance is still a number."""


def finite(value: object, what: str) -> float:
    """Return a parameter that is a finite number.

    Raises:
        UsageError: it is none.
    """
    given = number(value, what)
    if not math.isfinite(given):
        raise UsageError(f"{what} must be a finite number, found {given:g}")
    return given


def positive(value: object, what: str) -> float:
    """Return a parameter that is a finite number above 0.

    Raises:
        UsageError: it is none.
    """
    given = number(value, what)
    if not (math.isfinite(given) and given > 0):
        raise UsageError(f"{what} must be a positive finite number, found {given:g}")
    return given


def not_negative(value: object, what: str) -> float:
    """Return a parameter that is a finite number of at least 0.

    Raises:
        UsageError: it is none.
    """
    given = number(value, what)
    if not (math.isfinite(given) and given >= 0):
        raise UsageError(f"{what} must be a finite number of at least 0, found {given:g}")
    return given + 0.0  # no negative zero


def weight(value: object, what: str) -> float:
    """Return a weight of a risk: a number from 0 to `MOST_WEIGHT`.

    Raises:
        UsageError: it is none.
    """
    given = not_negative(value, what)
    if given > MOST_WEIGHT:
        raise UsageError(
            f"{what} must be at most {MOST_WEIGHT:g}, found {given:g}; under any weight of that size plans are "
            f"compared by their risk alone"
        )
    return given


def inner_level(value: object) -> float:
    """Return a level: a probability above 0 and below 1.

    Raises:
        UsageError: it is none.
    """
    given = number(value, "the level")
    if not 0 < given < 1:
        raise UsageError(f"the level must be above 0 and below 1, such as 0.95, found {given:g}")
    return given


def text_of(value: float) -> str:
    """Return the shortest decimal that reads as the number: `0.95`, `25`, `1e-05`."""
    return repr(float(value)).removesuffix(".0")


def finite_measure(value: float, what: str, law: CostLaw) -> float:
    """Return a measure of a law that an objective needs to be finite.

    Raises:
        InputError: it is infinite, or no number.
    """
    if math.isfinite(value):
        return value
    if math.isfinite(law.standard_deviation):
        raise InputError(f"{law}: {what} is too large for a floating-point number; state costs in a larger unit")
    raise InputError(
        f"{law}: {what} is infinite, and so is what it is worth; bound the cost (a truncated law, samples)"
    )
