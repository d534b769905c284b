"""The value at risk: a budget that is kept with a given probability."""

from __future__ import annotations

from dataclasses import dataclass

from statehtn.model.cost.law import CostLaw
from statehtn.model.expect import expect_law
from statehtn.risk.checks import inner_level, text_of
from statehtn.risk.objective import ValueUnit


@dataclass(frozen=True, slots=True)
class Quantile:
    """The least budget `b` with `P(C <= b) >= level`, to 1e-12 of the level; the unit is that of costs.

    It is monotone, but blind to what happens beyond it: no measure of an agent that shuns risk. It is no expected
    utility.

    Source: the value at risk of Jorion, *Value at Risk*, 1997, with costs for losses.

    Args:
        level: above 0 and below 1.

    Raises:
        UsageError: the level is out of its range.
    """

    level: float

    unit = ValueUnit.COST
    monotone = True
    concave = False

    def __post_init__(self) -> None:
        object.__setattr__(self, "level", inner_level(self.level))

    def value(self, law: CostLaw) -> float:
        """Return the quantile of a law."""
        return expect_law(law).quantile(self.level)

    def __str__(self) -> str:
        return f"quantile {text_of(self.level)}"
