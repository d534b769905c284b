"""Budgets that a plan must keep with a given probability."""

from __future__ import annotations

from dataclasses import dataclass

from statehtn.errors import UsageError
from statehtn.expected import number, shown
from statehtn.model.cost.law import CostLaw
from statehtn.model.expect import expect_law
from statehtn.risk.checks import not_negative, text_of

TOLERANCE = 1e-12
"""Of probabilities that are compared with one that was asked for."""
FORM = "BUDGET PROBABILITY, such as '25 0.95'"


@dataclass(frozen=True, slots=True)
class Keep:
    """A constraint on plans: `P(C <= budget) >= probability`, to 1e-12.

    Source: Charnes and Cooper, *Chance-constrained programming*, 1959.

    Args:
        budget: at least 0, in the unit of costs.
        probability: above 0, at most 1.

    Raises:
        UsageError: one of them is out of its range.
    """

    budget: float
    probability: float

    def __post_init__(self) -> None:
        object.__setattr__(self, "budget", not_negative(self.budget, "the budget to keep"))
        probability = number(self.probability, "the probability to keep a budget")
        if not 0 < probability <= 1:
            raise UsageError(
                f"the probability to keep a budget must be above 0 and at most 1, such as 0.95, found {probability:g}"
            )
        object.__setattr__(self, "probability", probability)

    @staticmethod
    def of(given: Keep | str) -> Keep:
        """Return a constraint, also from its text, such as `25 0.95`.

        Args:
            given: a `Keep`, or budget and probability as text.

        Raises:
            UsageError: it is neither, or a number is out of its range.
        """
        if isinstance(given, Keep):
            return given
        if not isinstance(given, str):
            raise UsageError(f"a budget to keep is a Keep or the text {FORM}, found {shown(given)}")
        try:
            budget, probability = map(float, given.split())
        except ValueError:
            raise UsageError(f"a budget to keep is written {FORM}; found '{given}'") from None
        return Keep(budget, probability)

    def attained(self, law: CostLaw) -> float:
        """Return the probability with which a total cost of this law keeps the budget."""
        return expect_law(law).cdf(self.budget)

    def holds(self, law: CostLaw) -> bool:
        """Tell whether a total cost of this law keeps the budget with the probability, to 1e-12."""
        return self.attained(law) >= self.probability - TOLERANCE

    def __str__(self) -> str:
        return f"{text_of(self.budget)} {text_of(self.probability)}"
