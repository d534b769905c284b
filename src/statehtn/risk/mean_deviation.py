"""Mean and standard deviation, weighed against each other."""

from __future__ import annotations

from dataclasses import dataclass

from statehtn.model.cost.law import CostLaw
from statehtn.model.expect import expect_law
from statehtn.risk.checks import finite_measure, text_of, weight
from statehtn.risk.neutral import expected_cost
from statehtn.risk.objective import ValueUnit


@dataclass(frozen=True, slots=True)
class MeanDeviation:
    """The expected cost plus a multiple of the standard deviation, `E C + L sd(C)`; the unit is that of costs.

    It is a measure of risk and no expected utility. It is not monotone: a plan that wastes money on good days has a
    smaller deviation.

    Source: Markowitz, *Portfolio selection*, 1952, with costs for losses; the risk measure of PERT.

    Args:
        weight: `L`, from 0 to 1e100, without unit.

    Raises:
        UsageError: the weight is out of its range.
    """

    weight: float

    unit = ValueUnit.COST
    concave = False

    def __post_init__(self) -> None:
        object.__setattr__(self, "weight", weight(self.weight, "the weight of the deviation"))

    @property
    def monotone(self) -> bool:
        """False, but where the deviation weighs nothing."""
        return self.weight == 0

    def value(self, law: CostLaw) -> float:
        """Return `E C + L sd(C)`.

        Raises:
            InputError: the standard deviation is infinite, or too large for a float.
        """
        mean = expected_cost(expect_law(law))
        if self.weight == 0:
            return mean
        deviation = finite_measure(law.standard_deviation, "its standard deviation", law)
        return finite_measure(mean + self.weight * deviation, "its weighted deviation", law)

    def __str__(self) -> str:
        return f"mean-deviation {text_of(self.weight)}"
