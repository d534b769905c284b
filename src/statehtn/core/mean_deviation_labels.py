"""Labels of a mean and standard deviations: the mean and the variance."""

from __future__ import annotations

import math
import sys
from collections.abc import Sequence

import statehtn._relax as _relax
from statehtn.core.finite_labels import CoreMix, FiniteLabels
from statehtn.core.grounding import Grounding
from statehtn.core.pricing import price
from statehtn.core.switches import LabelSwitches
from statehtn.limits import Limits
from statehtn.model.cost.law import CostLaw
from statehtn.risk import MeanDeviation, Neutral
from statehtn.risk.checks import finite_measure

ROUNDING = 2.0**-50
"""Of the difference of a cost and the mean, by the size of the costs."""


class Variance:
    """The variance as a price: it adds up over independent costs, in the square of their unit."""

    def risk_cost(self, law: CostLaw) -> float:
        """Return the variance, less what differences from a mean that is rounded may have added to it.

        Raises:
            InputError: it is infinite.
        """
        variance = finite_measure(law.variance, "its variance", law)
        return max(0.0, variance - ROUNDING * 2 * math.sqrt(variance) * (law.mean + math.sqrt(variance)))

    def __str__(self) -> str:
        return "variance"


class MeanDeviationLabels(FiniteLabels):
    """Labels of a mean and so many standard deviations.

    Args:
        grounding: the ground problem.
        objective: the weight of the deviation.
        switches: refinements to leave out.
        limits: they hold while actions are priced.

    Raises:
        InputError: a cost has no finite variance; the message names the action.
        LimitReached: a limit was reached.
    """

    def __init__(self, grounding: Grounding, objective: MeanDeviation, switches: LabelSwitches, limits: Limits) -> None:
        self._weight = objective.weight
        problems = [price(grounding, pricing, limits) for pricing in (Neutral(), Variance())]
        super().__init__(grounding, objective, problems, switches, bounds_mixes=True)

    def _core(
        self, prices: Sequence[_relax.PricedProblem], mixes: Sequence[CoreMix], options: _relax.FiniteOptions
    ) -> _relax.Valuation:
        (means, variances), (of_means, of_variances) = prices, self._prices.exponents
        return _relax.MeanDeviation(self._weight, means, variances, of_means, of_variances, tuple(mixes), options)

    def _next_weights(self, points: Sequence[Sequence[float]], values: Sequence[float]) -> list[float]:
        """Return the chord of the level of the best plan, from no variance to the least mean.

        The value is concave: no point above the chord is better. So if no plan is below it, that plan is the best. A
        chord that is too steep for a float is as good as upright.
        """
        room = min(values) - min(mean for mean, _ in points)
        if self._weight == 0 or room <= 0:
            return [1.0, 0.0]
        return [1.0, min(self._weight * (self._weight / room), sys.float_info.max)]
