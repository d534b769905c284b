"""The probability of being late."""

from __future__ import annotations

from dataclasses import dataclass

from statehtn.model.cost.law import CostLaw
from statehtn.model.expect import expect_law
from statehtn.risk.checks import not_negative, text_of
from statehtn.risk.objective import ValueUnit
from statehtn.risk.total_utility import TotalUtility


@dataclass(frozen=True, slots=True)
class Deadline(TotalUtility):
    """The probability that the cost exceeds a budget, `P(C > D)`; a cost of exactly the budget is in time.

    Source: Simon's satisficing agent, as the *target-percentile* criterion of Bouakiz and Kebir, *Target-level
    criterion in Markov decision processes*, 1995.

    Args:
        budget: `D`, at least 0, in the unit of costs.

    Raises:
        UsageError: the budget is negative, or not finite.
    """

    budget: float

    unit = ValueUnit.PROBABILITY
    monotone = True
    concave = False

    def __post_init__(self) -> None:
        object.__setattr__(self, "budget", not_negative(self.budget, "the deadline"))

    def value(self, law: CostLaw) -> float:
        """Return the probability of a larger cost than the budget."""
        return expect_law(law).exceedance(self.budget)

    def __str__(self) -> str:
        return f"deadline {text_of(self.budget)}"
