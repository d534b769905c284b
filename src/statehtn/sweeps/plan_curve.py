"""What a plan is worth to exponential agents of every alpha, from the laws of its actions."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Callable, Iterable
from functools import lru_cache

from statehtn.errors import InputError
from statehtn.model.cost.distribution import CostDistribution
from statehtn.model.cost.law import CostLaw
from statehtn.sweeps.minorants import certainty_equivalent, parts_of, tilted_mean

FAR = 1e12
"""Times the largest cost: a best x beyond it, or below its inverse, is an end."""
HALVINGS = 200  # of an interval of floats; far fewer are needed


class PlanCurve:
    """The certainty equivalent of a plan as a function of the slope: alpha of an averse agent, -alpha of a seeking one.

    It rises with the slope from the least total cost through the mean, at 0, to the largest; slopes may be infinite.
    Two are equal if they are the same function for the same reason: the laws of the plan's actions.

    Args:
        laws: of the costs of the plan's actions, which are independent.
    """

    def __init__(self, laws: Iterable[CostLaw]) -> None:
        counts = Counter(part for law in laws for part in parts_of(law))
        self.constant = math.fsum(law.least * count for law, count in counts.items() if law.least == law.most)
        self.counts = {law: count for law, count in counts.items() if law.least != law.most}
        self._at: Callable[[float], float] = lru_cache(maxsize=None)(self._computed)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, PlanCurve) and (self.constant, self.counts) == (other.constant, other.counts)

    def __hash__(self) -> int:
        return hash((self.constant, frozenset(self.counts.items())))

    def at(self, slope: float) -> float:
        """Return the certainty equivalent at a slope; infinite where it is, or cannot be computed."""
        return self._at(slope)

    def _computed(self, slope: float) -> float:
        return self.constant + math.fsum(count * _equivalent(law, slope) for law, count in self.counts.items())

    def divergence(self, x: float) -> float:
        """Return `a K'(a) - K(a)` at `a = 1/x`: the relative entropy of the law that the agent sees to the true one.

        It is minus the slope of the certainty equivalent as a function of x, and rises as x falls.
        """
        return math.fsum(count * _divergence(law, x) for law, count in self.counts.items())

    def best_x(self, radius: float) -> float:
        """Return the x at which `f(x) + radius x` is least, where f is the certainty equivalent at `alpha = 1/x`.

        The function is convex in x, and its slope is the radius less the divergence.

        Args:
            radius: positive.
        """
        if not self.counts:
            return 0.0
        unit = max(law.most if math.isfinite(law.most) else law.mean for law in self.counts)
        low, high = unit, unit
        while self.divergence(high) > radius:
            low, high = high, 2 * high
            if high > unit * FAR:
                return math.inf
        while low == high or self.divergence(low) <= radius:
            low, high = low / 2, low
            if low < unit / FAR:
                return 0.0
        return bisected(lambda x: self.divergence(x) <= radius, low, high)

    def evar(self, radius: float) -> tuple[float, float]:
        """Return the least value of `f(x) + radius x`, and the x at which it is had."""
        x = self.best_x(radius)
        if math.isinf(x):
            return math.inf, x
        value = self.at(math.inf if x == 0 else 1 / x) + radius * x
        worst = self.at(math.inf)
        return (worst, 0.0) if worst <= value else (value, x)


def bisected(is_beyond: Callable[[float], bool], low: float, high: float, precision: float = 0.0) -> float:
    """Return the least number of an interval that is beyond a point, where the upper end is and the lower one is not.

    It is exact to a part of the interval's width, or to the next float.
    """
    precise = (high - low) * precision
    for _ in range(HALVINGS):
        middle = low + (high - low) / 2
        if not low < middle < high or high - low <= precise:
            break
        low, high = (low, middle) if is_beyond(middle) else (middle, high)
    return high


def _equivalent(law: CostLaw, slope: float) -> float:
    if slope < 0:
        return law.least if math.isinf(slope) else law.exponential_mean(slope)
    try:
        return certainty_equivalent(law, math.inf if slope == 0 else 1 / slope)
    except InputError:
        return math.inf


def _divergence(law: CostLaw, x: float) -> float:
    """Return what a law contributes to the divergence; infinite where the certainty equivalent is."""
    try:
        own = certainty_equivalent(law, x)
        if isinstance(law, CostDistribution):
            return max(0.0, tilted_mean(law, x) - own) / x
        step = x / 1024
        return (own - certainty_equivalent(law, x + step)) / step
    except InputError:
        return math.inf
