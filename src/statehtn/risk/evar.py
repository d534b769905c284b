"""The entropic value at risk."""

from __future__ import annotations

from dataclasses import dataclass

from statehtn.model.cost.law import CostLaw
from statehtn.model.expect import expect_law
from statehtn.risk.checks import inner_level, text_of
from statehtn.risk.objective import ValueUnit


@dataclass(frozen=True, slots=True)
class EntropicValueAtRisk:
    """The least bound that Chernoff's inequality gives for the cost at a level; the unit is that of costs.

    It is the infimum over all `a > 0` of `ln E[e^(a C)] / a + ln(1 / (1 - level)) / a`: at least the conditional value
    at risk of the level, at most the largest possible cost. It is also the largest expected cost under all laws whose
    Kullback-Leibler divergence from the stated one is at most `ln(1 / (1 - level))`, so that it guards against wrong
    probabilities. It is a measure of risk and no expected utility.

    Source: Ahmadi-Javid, *Entropic value-at-risk: a new coherent risk measure*, 2012, with costs for losses.

    Args:
        level: above 0 and below 1.

    Raises:
        UsageError: the level is out of its range.
    """

    level: float

    unit = ValueUnit.COST
    monotone = True
    concave = True

    def __post_init__(self) -> None:
        object.__setattr__(self, "level", inner_level(self.level))

    def value(self, law: CostLaw) -> float:
        """Return the entropic value at risk of a law.

        Raises:
            InputError: `E[e^(a C)]` is infinite for all `a > 0`, or cannot be computed.
        """
        return expect_law(law).evar(self.level)

    def __str__(self) -> str:
        return f"evar {text_of(self.level)}"
