"""The conditional value at risk: the mean of the worst cases."""

from __future__ import annotations

from dataclasses import dataclass

from statehtn.model.cost.law import CostLaw
from statehtn.model.expect import expect_law
from statehtn.risk.checks import inner_level, text_of
from statehtn.risk.objective import ValueUnit


@dataclass(frozen=True, slots=True)
class ConditionalValueAtRisk:
    """The mean cost of the worst `1 - level` of all cases; the unit is that of costs.

    It is the least `b + E max(C - b, 0) / (1 - level)` over all budgets `b`. It is a coherent measure of risk and no
    expected utility.

    Source: Rockafellar and Uryasev, *Optimization of conditional value-at-risk*, 2000; Acerbi and Tasche, *On the
    coherence of expected shortfall*, 2002; with costs for losses.

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

    @property
    def weight(self) -> float:
        """That of the worst cases in `MeanCvar`, of which this is one: 1."""
        return 1.0

    def value(self, law: CostLaw) -> float:
        """Return the conditional value at risk of a law."""
        return expect_law(law).cvar(self.level)

    def __str__(self) -> str:
        return f"cvar {text_of(self.level)}"
