"""Labels of objectives that add up: one price for each action."""

from __future__ import annotations

import math
from functools import cached_property

import statehtn._relax as _relax
from statehtn.core.grounding import Grounding
from statehtn.core.labels import Labels
from statehtn.core.pricing import price
from statehtn.core.scale import MOST_BITS, MOST_UNITS, Scale
from statehtn.limits import Limits
from statehtn.risk import AdditiveObjective


class PriceLabels(Labels):
    """Sums of prices on one scale, which tells costs apart as far as the precision of a label search asks for.

    Args:
        grounding: the ground problem.
        objective: its prices add up.
        limits: they hold while actions are priced.
    """

    worths_are_values = False

    def __init__(self, grounding: Grounding, objective: AdditiveObjective, limits: Limits) -> None:
        super().__init__(grounding, objective)
        self._problem = price(grounding, objective, limits)
        self._prices = self._problem.on(Scale.first(self._problem.bounds()))

    @cached_property
    def valuation(self) -> _relax.Valuation:
        """The sum of the prices."""
        return _relax.PriceSums(self._prices.handle)

    def refine(self, limits: Limits) -> bool:  # noqa: ARG002
        """Return false: there is one scale."""
        return False

    def value(self, trace: _relax.SearchResult) -> float:
        """Return the sum of a plan's own prices."""
        return self._problem.of_plan(trace).cost

    def value_of(self, worth: int) -> float:
        """Return a sum of units as a cost."""
        return self._prices.scale.cost(worth)

    def worth_of(self, value: float) -> int:
        """Return a cost in units, rounded up; at most what the core can hold."""
        exponent = self._prices.scale.exponent
        if math.frexp(value)[1] + exponent > MOST_BITS:
            return MOST_UNITS if value > 0 else -MOST_UNITS
        return math.ceil(math.ldexp(value, exponent))
