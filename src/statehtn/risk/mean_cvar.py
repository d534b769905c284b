"""The mean and the mean of the worst cases, mixed."""

from __future__ import annotations

from dataclasses import dataclass

from statehtn.errors import UsageError
from statehtn.expected import number
from statehtn.model.cost.law import CostLaw
from statehtn.model.expect import expect_law
from statehtn.risk.checks import inner_level, text_of
from statehtn.risk.neutral import expected_cost
from statehtn.risk.objective import ValueUnit


@dataclass(frozen=True, slots=True)
class MeanCvar:
    """A mixture of the expected cost and the conditional value at risk, `(1 - weight) E C + weight CVaR(C)`.

    The unit is that of costs. It is a coherent measure of risk and no expected utility.

    Source: Rockafellar, Uryasev and Zabarankin, *Generalized deviations in risk analysis*, 2006, with costs for losses.

    Args:
        level: of the CVaR, above 0 and below 1.
        weight: of the CVaR, from 0 to 1.

    Raises:
        UsageError: the level or the weight is out of its range.
    """

    level: float
    weight: float

    unit = ValueUnit.COST
    monotone = True
    concave = True

    def __post_init__(self) -> None:
        object.__setattr__(self, "level", inner_level(self.level))
        weight = number(self.weight, "the weight of the CVaR")
        if not 0 <= weight <= 1:
            raise UsageError(f"the weight of the CVaR must be from 0 to 1, found {weight:g}")
        object.__setattr__(self, "weight", weight + 0.0)

    def value(self, law: CostLaw) -> float:
        """Return the mixture for a law."""
        mean = expected_cost(expect_law(law))
        return mean + self.weight * max(law.cvar(self.level) - mean, 0.0)

    def __str__(self) -> str:
        return f"mean-cvar {text_of(self.level)} {text_of(self.weight)}"
