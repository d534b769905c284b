"""Mean and variance, weighed against each other."""

from __future__ import annotations

from dataclasses import dataclass

from statehtn.model.cost.law import CostLaw
from statehtn.model.expect import expect_law
from statehtn.risk.checks import finite_measure, text_of, weight
from statehtn.risk.neutral import expected_cost
from statehtn.risk.objective import ValueUnit
from statehtn.risk.utility import FunctionType, PlanUtility


@dataclass(frozen=True, slots=True)
class MeanVariance:
    """The expected cost plus a multiple of the variance, `E C + L Var C`; it adds up over independent costs.

    The unit is that of costs, so that of `L` is one over it. It is not monotone: a plan that wastes money on good days
    has a lower variance. For small `L` it is close to the certainty equivalent of `averse 2L`.

    Source: Markowitz, *Portfolio selection*, 1952, with costs for losses.

    Args:
        weight: `L`, from 0 to 1e100, per unit of cost.

    Raises:
        UsageError: the weight is out of its range.
    """

    weight: float

    unit = ValueUnit.COST
    concave = False
    function_type = FunctionType.OTHER
    allows_segmentation = True
    plan_utility = PlanUtility.SUM

    def __post_init__(self) -> None:
        object.__setattr__(self, "weight", weight(self.weight, "the weight of the variance"))

    @property
    def monotone(self) -> bool:
        """False, but where the variance weighs nothing."""
        return self.weight == 0

    def risk_cost(self, law: CostLaw) -> float:
        """Return the price of a cost, `E C + L Var C`.

        Raises:
            InputError: the variance is infinite, or too large for a float.
        """
        mean = expected_cost(expect_law(law))
        if self.weight == 0:
            return mean
        variance = finite_measure(law.variance, "its variance", law)
        return finite_measure(mean + self.weight * variance, "its weighted variance", law)

    def value(self, law: CostLaw) -> float:
        """Return `E C + L Var C`; see `risk_cost`."""
        return self.risk_cost(law)

    def __str__(self) -> str:
        return f"mean-variance {text_of(self.weight)}"
