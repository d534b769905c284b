"""How far from optimal a known plan may be between two alphas that were searched.

Let `V` be the least certainty equivalent of any plan as a function of the slope: alpha of an averse agent, -alpha of a
seeking one. What is proven of V at the ends of an interval says something of V inside it:

1. V rises with the slope, since the certainty equivalent of every plan does.
2. For seeking agents and `x = 1/|slope|` the certainty equivalent of a plan, `-x ln E[e^(-C/x)]`, is concave in x (it
   is the perspective of a concave function), and so is V, the least of them: V is nowhere below its chord.
3. For averse agents it is convex in x, and the least of convex functions is neither. Two further runs, at prices that
   are lines below the certainty equivalents, give a chord below V (`statehtn.sweeps.minorants`).

The gap of a plan is the largest difference of its certainty equivalent to the best of these bounds. It is at an end of
the interval with (1) and (3), since a convex function less a line is convex; with (2) it is that of a concave function.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

from statehtn.sweeps.minorants import minorant
from statehtn.sweeps.plan_curve import PlanCurve

SECTIONS = 24  # of an interval in which a maximum is sought; each takes off a third of it, and the error is quadratic
STEPS = 16  # of the search for the point where a line should touch


@dataclass(frozen=True, slots=True)
class Point:
    """A slope that was searched, and what is proven there of the certainty equivalent of every plan."""

    slope: float
    bound: float


@dataclass(slots=True)
class Segment:
    """The slopes between two that were searched.

    Args:
        low: the lower one.
        high: the upper one.
        chord: what two further runs have proven of V at both ends, in the order of the slopes; None without them.
        is_complete: every plan that may be best somewhere on it is known.
    """

    low: Point
    high: Point
    chord: tuple[float, float] | None = None
    is_complete: bool = False

    @property
    def is_seeking(self) -> bool:
        """Whether (2) holds: all slopes are negative."""
        return self.high.slope < 0

    @property
    def is_averse(self) -> bool:
        """Whether (3) can be had: all slopes are positive."""
        return self.low.slope > 0

    @property
    def ends(self) -> tuple[float, float]:
        """The lower and the upper end of x for an averse agent."""
        return inverse(self.high.slope), inverse(self.low.slope)

    def gap(self, plan: PlanCurve) -> float:
        """Return by how much a plan may be worse than the best one somewhere between the ends."""
        gap = plan.at(self.high.slope) - self.low.bound
        if self.is_seeking:
            gap = min(gap, self._gap_to_chord(plan))
        if self.chord is not None:
            at_low, at_high = plan.at(self.low.slope), plan.at(self.high.slope)
            gap = min(gap, max(at_low - self.chord[0], at_high - self.chord[1]))
        return max(gap, 0.0)

    def _gap_to_chord(self, plan: PlanCurve) -> float:
        """Return the largest difference of a seeking agent's certainty equivalent to the chord, both concave in x."""
        start, end = inverse(self.low.slope), inverse(self.high.slope)
        rise = (self.high.bound - self.low.bound) / (end - start)

        def difference(x: float) -> float:
            return plan.at(-math.inf if x == 0 else -1 / x) - (self.low.bound + (x - start) * rise)

        return largest(difference, start, end)

    def touching(self, plan: PlanCurve) -> tuple[float, float]:
        """Return the x at which lines should touch, so that they prove most of a plan, and the gap that would remain.

        The error at the lower end of x rises with the point, that at the upper end falls.
        """
        low, high = self.ends
        at_low, at_high = plan.at(self.high.slope), plan.at(self.low.slope)

        def errors(at: float) -> tuple[float, float]:
            ends = [minorant(law, low, high, at) for law in plan.counts]
            counts = plan.counts.values()
            sums = (
                plan.constant + math.fsum(count * end[upper] for count, end in zip(counts, ends, strict=True))
                for upper in (False, True)
            )
            return tuple(value - line for value, line in zip((at_low, at_high), sums, strict=True))  # type: ignore[return-value]

        least, most = low, high
        for _ in range(STEPS):
            at = (least + most) / 2
            below, above = errors(at)
            least, most = (least, at) if below > above else (at, most)
        return at, max(below, above)


def inverse(slope: float) -> float:
    """Return x of a slope: infinite for 0, and 0 for an infinite one."""
    return math.inf if slope == 0 else 1 / abs(slope)


def largest(function: Callable[[float], float], low: float, high: float) -> float:
    """Return the largest value of a concave function on an interval, to rounding: by sections in three parts."""
    best = max(function(low), function(high))
    for _ in range(SECTIONS):
        third = (high - low) / 3
        first, second = function(low + third), function(high - third)
        best = max(best, first, second)
        low, high = (low + third, high) if first < second else (low, high - third)
    return best
