"""What a utility function offers to everyone else: the agent's risk attitude, and the price of an uncertain cost to it.

Costs are positive and minimised, in the domain's own unit; utilities are maximised. The paper writes costs as negative
numbers.
"""

from __future__ import annotations

from enum import IntEnum, StrEnum
from typing import Literal, Protocol

from statehtn.model.cost.law import CostLaw
from statehtn.risk.objective import AdditiveObjective

DIGITS = 10
"""Significant digits of a printed expected utility: enough for every value in the paper's tables."""


class Attitude(StrEnum):
    """What an agent thinks of risk (paper section 2.2.2)."""

    NEUTRAL = "neutral"
    AVERSE = "averse"
    SEEKING = "seeking"


AttitudeName = Literal["neutral", "averse", "seeking"]
"""The names of the attitudes, for type checkers."""


class FunctionType(IntEnum):
    """The RA-parameter `l`: the family of the utility function."""

    LINEAR = 0
    EXPONENTIAL = 1
    OTHER = 2


class PlanUtility(IntEnum):
    """The RA-parameter `n`: how the expected utility of a plan follows from those of its actions."""

    PRODUCT = 0
    """Paper equation 5: a product over segments, `(alpha / a)^(s - 1) EU(o_1) ... EU(o_s)`."""
    SUM = 1
    """Paper equation 7: `EU(o_1) + ... + EU(o_s)`."""
    SUCCESS = 2
    """Paper equation 8: a product of the probabilities of success, and one of the utilities of the actions."""
    TRAJECTORY = 3
    """Paper equation 9: of one trajectory, the sum over its actions of a probability times a utility."""
    TRAJECTORIES = 4
    """Paper equation 4, written `*`: the sum over all trajectories, which no values of single actions determine."""


class Utility(AdditiveObjective, Protocol):
    """A utility function of the total cost under which every action has a price of its own.

    The price is `risk_cost`, the certainty-equivalent cost: the certain cost that the agent likes exactly as much as
    the uncertain one. Risk costs have the unit of costs, are minimised, and add up along a plan; minimising their sum
    `K` maximises the plan's expected utility, which is `utility(K)`.
    """

    @property
    def attitude(self) -> Attitude:
        """The risk attitude."""
        ...

    @property
    def alpha(self) -> float | None:
        """The curving coefficient, per unit of cost; None where there is none."""
        ...

    @property
    def function_type(self) -> FunctionType:
        """The family of the function."""
        ...

    @property
    def allows_segmentation(self) -> bool:
        """True if actions can be priced one by one (the RA-parameter `m` of the paper's definition)."""
        ...

    @property
    def plan_utility(self) -> PlanUtility:
        """How the plan's expected utility is defined."""
        ...

    def risk_cost(self, law: CostLaw) -> float:
        """Return the certainty-equivalent cost, the price of a cost to the agent (`EU(o)` of the paper's equation 10).

        It lies between the least and the largest cost that is possible.

        Raises:
            InputError: it is infinite.
        """
        ...

    def utility(self, cost: float) -> float:
        """Return the utility of a certain cost (paper equation 1); infinite where a float cannot hold it."""
        ...

    def log10_expected_utility(self, risk_cost: float) -> float | None:
        """Return the paper's log10(EU) column for a plan whose risk costs sum to `risk_cost`.

        It is `log10 EU` for a seeking agent, `-log10 |EU|` for an averse one, and None for a neutral one.
        """
        ...

    def expected_utility_text(self, risk_cost: float, digits: int = DIGITS) -> str:
        """Return the expected utility of such a plan as a decimal number with at most `digits` significant digits.

        It is computed in the log domain, so no size of exponent overflows.
        """
        ...
