"""Scales of fixed point: what a unit of cost is, and the cap from which on prices are no longer distinguished.

A search adds whole units. On a scale a price `p`, of which at least `q` is certain (`RiskCost`), is `floor(q / unit)`
units, or one unit more than the cap where that is less. The following holds for every utility under which prices are
never negative and add up along a plan, and for parts of prices that are due in some states only:

1. No price is rounded up, so that no plan costs more on a scale than in truth. What a search proves to be the least
   cost of any plan, or of any plan that is not among those found, is therefore a lower bound of the true cost, whatever
   the scale.
2. Prices on a scale are those of another problem with the same plans, all finite and added exactly. All that a search
   does with its costs (bounds that are inherited or shifted, landmark cuts) is sound in that problem.
3. Let the cap be the cost of the best plan known. A plan with a price beyond the cap is not better. Any other plan with
   n prices loses less than n units by rounding, and what its prices are uncertain by. So the least cost on the scale
   differs from the true one by less than that, which with `BITS` bits for the best plan is far below `TOLERANCE`.
4. Let B be a lower bound of all plans, and the cap `RAISE * B`, below the cost of the best plan known. If the cheapest
   plan on the scale costs less than the cap, it has no price beyond it, and (3) holds for it on the next scale.
   Otherwise the cap is a new lower bound, `RAISE` times the old one. Either way a few scales lead to one on which (3)
   holds for the best plan.

On a scale on which cheap prices are 0, recursion may cost nothing, and a search may follow it without end below the
cost of the plan that it is about to find. So on the first scale, when no bound is proven, no positive price is 0, and
the cap is raised step by step. Then a unit is at most `B / 2^40`, and where cheap prices are 0, plans that are better
by less than 2^6 units, `2^-34` of their cost, are not asked for (`worth_while`). Exact costs would not avoid this: a
search would go through as many steps of the recursion before it could rule out a plan that is better by more.
"""

from __future__ import annotations

import math
import sys
from collections.abc import Iterable
from dataclasses import dataclass

TOLERANCE = 2.0**-30
"""A plan is optimal if it costs more than is proven of every plan by no more than this part of its cost."""
BITS = 50
"""Of the cost of the best plan in units: so many that rounding is far below `TOLERANCE`."""
MOST_UNITS = 2**62 - 1
"""The largest sum in the core; it stands for every larger one, too."""
MOST_BITS = 59
STEP_BITS = 32  # so many more than the number of steps takes: they lose less than a fourth of the tolerance
RAISE = 2.0**10

_FIRST_BITS = 40  # of the largest price, where all prices are of similar size: plans may cost millions of times as much
_PRECISE_BITS = 32  # of the least price, if the largest one then has no more than BITS
_LEAST_BITS = 11  # of the least price in any case


@dataclass(frozen=True, slots=True)
class Scale:
    """A unit of `2**-exponent` in the domain's own unit, and a cap in units."""

    exponent: int
    cap: int

    @staticmethod
    def first(prices: Iterable[float]) -> Scale:
        """Return the scale to begin with: no price is 0 on it unless it is.

        Its unit is the usual one, `2^-40` of the largest price, where all are within a factor of some hundreds. Where
        they are not, it is finer, as far as the least price needs it for a relative precision of `TOLERANCE`; where
        they are more than `2^39` apart, the most expensive ones are capped.
        """
        positive = [price for price in prices if price > 0]
        if not positive:
            return Scale(0, 1 << BITS)
        least, largest = math.frexp(min(positive))[1], math.frexp(max(positive))[1]
        exponent = max(_FIRST_BITS - largest, min(_PRECISE_BITS - least, BITS - largest), _LEAST_BITS - least)
        return Scale(exponent, 1 << BITS)

    @staticmethod
    def after(best: float | None, bound: float, steps: int = 0) -> Scale:
        """Return the scale to go on with.

        Args:
            best: what the best plan known costs (of several that are wanted: the last one), positive; None for none.
            bound: what is proven of every plan that is not known.
            steps: how many priced steps that plan has.
        """
        cap = bound * RAISE if bound > 0 else math.inf
        cap = min(cap, sys.float_info.max if best is None else best)
        bits = min(max(BITS, STEP_BITS + steps.bit_length()), MOST_BITS)
        exponent = bits + 1 - math.frexp(cap)[1]
        return Scale(exponent, math.floor(math.ldexp(cap, exponent)))

    def units(self, prices: Iterable[float]) -> list[int]:
        """Return prices in units, rounded down, at most one more than the cap."""
        most, exponent = self.cap + 1, self.exponent
        far = math.ldexp(1.0, 63 - exponent) if 63 - exponent < 1024 else math.inf  # beyond every cap
        return [min(math.floor(math.ldexp(price, exponent)), most) if price < far else most for price in prices]

    def cost(self, units: int) -> float:
        """Return an amount of units as a cost in the domain's own unit; at most what a float can hold."""
        try:
            return math.ldexp(units, -self.exponent)
        except OverflowError:
            return sys.float_info.max


def worth_while(units: int, has_free: bool) -> int:
    """Return below how many units a plan is of interest where one of so many is known.

    Args:
        units: what the best plan known costs.
        has_free: whether cheap prices are 0.
    """
    return units - (units >> 34) if has_free else units
