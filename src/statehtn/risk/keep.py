"""Budgets that plans are to keep with a probability: a constraint beside any objective."""

from __future__ import annotations

from dataclasses import dataclass

from statehtn.errors import UsageError
from statehtn.expected import number, shown
from statehtn.model.cost.law import CostLaw

TOLERANCE = 1e-12
"""Of a probability that is compared with the one asked for."""


@dataclass(frozen=True, slots=True)
class Keep:
    """Only plans whose total cost is at most `budget` with at least this probability (a chance constraint).

    Source: Charnes and Cooper, *Chance-constrained programming*, 1959.

    Args:
        budget: at least 0, in the domain's unit.
        probability: above 0 and at most 1.

    Raises:
        UsageError: a number is out of its range.
    """

    budget: float
    probability: float

    def __post_init__(self) -> None:
        if not number(self.budget, "a budget to keep") >= 0:
            raise UsageError(f"a budget to keep must be at least 0, found {self.budget:g}")
        if not 0 < number(self.probability, "the probability of keeping a budget") <= 1:
            raise UsageError(
                f"the probability of keeping a budget must be above 0 and at most 1, found {self.probability:g}"
            )

    @staticmethod
    def of(given: Keep | str) -> Keep:
        """Return a constraint from its text, a budget and a probability, such as `25 0.95`.

        Raises:
            UsageError: it is none.
        """
        if isinstance(given, Keep):
            return given
        try:
            budget, probability = map(float, given.split())
        except (AttributeError, ValueError):
            expected = "a budget to keep is written as a budget and a probability, such as '25 0.95'"
            raise UsageError(f"{expected}; found {shown(given)}") from None
        return Keep(budget, probability)

    def __str__(self) -> str:
        return f"{self.budget!r} {self.probability!r}"

    def attained(self, law: CostLaw) -> float:
        """Return the probability with which a cost of this law keeps the budget."""
        return law.cdf(self.budget)

    def holds(self, law: CostLaw) -> bool:
        """Tell whether a cost of this law keeps the budget often enough, to 1e-12."""
        return self.attained(law) >= self.probability - TOLERANCE
