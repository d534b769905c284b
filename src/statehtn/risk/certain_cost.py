"""The certain cost that has a given utility, for a utility that is only known as a function."""

from __future__ import annotations

import math
from collections.abc import Callable

NEAR = 1e-9  # relative; a utility that keeps its value over a wider range is flat there
JUMP = 1e-6  # of all that a utility falls; by no more a continuous one falls from one float to the next
ROUNDING = 1e-12  # of utilities, relative to how much they differ


def certain_cost(utility: Callable[[float], float], expected: float, least: float, most: float) -> float | None:
    """Return the cost between two others at which a utility that does not rise has a value, found by bisection.

    Args:
        utility: of a cost.
        expected: the value, such as the expected utility of a law between the two costs.
        least: the first cost.
        most: the second cost; may be infinite.

    Returns:
        the cost; None where the utility is flat at that value, or jumps over it, so that there is no single one.
    """
    if least == most:
        return least
    if math.isinf(most):
        most = max(2 * least, 1.0)
        while utility(most) >= expected and most < math.inf:
            most *= 2
        if math.isinf(most):
            return None
    at_least, at_most = utility(least), utility(most)
    slack = ROUNDING * max(abs(at_least), abs(at_most), abs(expected))
    if not at_most - slack <= expected <= at_least + slack:
        return None
    before = _last(lambda cost: utility(cost) > expected + slack, least, most)
    after = _last(lambda cost: utility(cost) >= expected - slack, least, most)
    if after - before > NEAR * max(after, most - least):
        return None
    is_jump = utility(before) - utility(math.nextafter(after, math.inf)) > JUMP * (at_least - at_most)
    return None if is_jump else before + (after - before) / 2


def _last(holds: Callable[[float], bool], low: float, high: float) -> float:
    """Return the last cost at which a condition holds that holds up to some cost; the lower end if it never does."""
    if holds(high):
        return high
    while low < (middle := low + (high - low) / 2) < high:
        if holds(middle):
            low = middle
        else:
            high = middle
    return low
