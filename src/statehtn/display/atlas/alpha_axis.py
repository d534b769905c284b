"""The axis of attitudes: all alphas, infinite ones included, on a line from -1 to 1 with the neutral agent at 0."""

from __future__ import annotations

import math
import statistics
from dataclasses import dataclass

from statehtn.sweeps.attitude_map import AttitudeMap

NICE = (1, 2, 5)
"""Of powers of ten: the alphas at which the axis has ticks."""
APART = 0.09
"""How far apart ticks stand at least."""


@dataclass(frozen=True, slots=True)
class AlphaAxis:
    """The place of an alpha is `u / (1 + |u|)` for `u = alpha * unit`: what matters is spread, the ends are reached.

    Args:
        unit: of 1/alpha, positive: the agent with this alpha stands halfway between neutral and the end.
        low: the least alpha shown.
        high: the largest.
    """

    unit: float
    low: float
    high: float

    @classmethod
    def of(cls, found: AttitudeMap) -> AlphaAxis:
        """Return an axis on which the break points of a map are spread."""
        alphas = [abs(one.low + one.high) / 2 for one in found.breaks]
        mean = found.pieces[0].expected_cost
        far = [alpha for alpha in alphas if math.isfinite(alpha) and alpha * mean > 1e-6]
        return cls(1 / statistics.median(far) if far else max(mean, 1e-9) / 5, found.low, found.high)

    def place(self, alpha: float) -> float:
        """Return where an alpha stands."""
        if math.isinf(alpha):
            return math.copysign(1.0, alpha)
        scaled = alpha * self.unit
        return scaled / (1 + abs(scaled))

    def alpha(self, place: float) -> float:
        """Return the alpha that stands at a place."""
        if abs(place) >= 1:
            return math.copysign(math.inf, place)
        return place / (1 - abs(place)) / self.unit

    def places(self, count: int) -> list[float]:
        """Return places at equal distances, both ends included."""
        low, high = self.place(self.low), self.place(self.high)
        return [low + (high - low) * step / (count - 1) for step in range(count)]

    def ticks(self) -> list[tuple[float, str]]:
        """Return places and their labels, from low to high."""
        centre = math.floor(math.log10(1 / self.unit))
        sizes = [float(f"{digit}e{power}") for power in range(centre - 2, centre + 4) for digit in NICE]
        wanted = [0.0, *sorted(sizes, key=lambda size: abs(math.log(size * self.unit)))]
        taken = {self.place(end): words(end) for end in (self.low, self.high)}
        for alpha in (sign * size for size in wanted for sign in (1, -1)):
            place = self.place(alpha)
            if self.low < alpha < self.high and all(abs(place - other) >= APART for other in taken):
                taken[place] = f"{alpha:g}".replace("-", "\N{MINUS SIGN}")
        return sorted(taken.items())


def words(alpha: float) -> str:
    """Return an alpha as people read it."""
    sign = "\N{MINUS SIGN}" if alpha < 0 else ""
    return f"{sign}\N{INFINITY}" if math.isinf(alpha) else f"{sign}{abs(alpha):.4g}"
