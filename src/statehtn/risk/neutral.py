"""The risk-neutral utility: an uncertain cost is worth its expected value."""

from __future__ import annotations

from dataclasses import dataclass

from statehtn.expected import number, whole_number
from statehtn.model.cost.law import CostLaw
from statehtn.model.expect import expect_law
from statehtn.risk.objective import ValueUnit
from statehtn.risk.utility import DIGITS, Attitude, FunctionType, PlanUtility

DOUBLE_DIGITS = 17


@dataclass(frozen=True, slots=True)
class Neutral:
    """The linear utility `-cost` (paper equation 1, first case).

    Costs are positive, in the domain's unit, and minimised. The value is the expected cost.
    """

    unit = ValueUnit.COST
    monotone = True
    concave = True

    @property
    def attitude(self) -> Attitude:
        """The risk attitude."""
        return Attitude.NEUTRAL

    @property
    def alpha(self) -> None:
        """No coefficient: a linear function has no curvature."""
        return None

    @property
    def function_type(self) -> FunctionType:
        """The family of the function."""
        return FunctionType.LINEAR

    @property
    def allows_segmentation(self) -> bool:
        """True: expected costs add up."""
        return True

    @property
    def plan_utility(self) -> PlanUtility:
        """A sum over the actions."""
        return PlanUtility.SUM

    def risk_cost(self, law: CostLaw) -> float:
        """Return the expected cost."""
        return expected_cost(expect_law(law))

    def value(self, law: CostLaw) -> float:
        """Return the expected cost."""
        return self.risk_cost(law)

    def utility(self, cost: float) -> float:
        """Return minus the cost: the utility is linear."""
        return -number(cost, "a cost")

    def log10_expected_utility(self, risk_cost: float) -> None:
        """Return None: the paper prints no logarithm for the neutral attitude."""

    def expected_utility_text(self, risk_cost: float, digits: int = DIGITS) -> str:
        """Return minus the expected cost as a decimal number."""
        shown = min(max(1, whole_number(digits, "the number of digits")), DOUBLE_DIGITS)
        return format(0.0 - number(risk_cost, "a risk cost"), f".{shown}g")

    def __str__(self) -> str:
        return "neutral"


def expected_cost(law: CostLaw) -> float:
    """Return the mean of a law, within its range, which rounding or probabilities that sum to 1 + 1e-10 could leave."""
    return min(max(law.mean, law.least), law.most)
