"""The expected overrun of a budget."""

from __future__ import annotations

from dataclasses import dataclass

from statehtn.model.cost.law import CostLaw
from statehtn.model.expect import expect_law
from statehtn.risk.checks import not_negative, text_of
from statehtn.risk.objective import ValueUnit
from statehtn.risk.total_utility import TotalUtility


@dataclass(frozen=True, slots=True)
class Overrun(TotalUtility):
    """What is paid above a budget in the mean over all cases, `E max(C - D, 0)`; the unit is that of costs.

    All costs up to the budget are equally good, so no single certain cost is as bad as a law that is never above it.

    Source: Fishburn, *Mean-risk analysis with risk associated with below-target returns*, 1977 (his exponent 1), with
    costs for losses.

    Args:
        budget: `D`, at least 0, in the unit of costs.

    Raises:
        UsageError: the budget is negative, or not finite.
    """

    budget: float

    unit = ValueUnit.COST
    monotone = True
    concave = True

    def __post_init__(self) -> None:
        object.__setattr__(self, "budget", not_negative(self.budget, "the budget"))

    def value(self, law: CostLaw) -> float:
        """Return the expected overrun of a law."""
        return expect_law(law).expected_overrun(self.budget)

    def certainty_equivalent(self, law: CostLaw) -> None:
        """Return None: an overrun is no certain cost."""

    def __str__(self) -> str:
        return f"overrun {text_of(self.budget)}"
