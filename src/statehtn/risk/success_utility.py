"""Probabilities of success times utilities of actions, along a plan that counts on one outcome of each."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

from statehtn.errors import UsageError
from statehtn.expected import shown
from statehtn.model.cost.distribution import CostDistribution
from statehtn.model.cost.law import CostLaw, checked_function
from statehtn.model.expect import expect_law
from statehtn.risk.checks import positive, text_of
from statehtn.risk.exponential import Exponential
from statehtn.risk.objective import ValueUnit
from statehtn.risk.utility import Attitude, FunctionType, PlanUtility

NEAR_ONE = 1e-13
"""The rounding of a logarithm of a mean that is near 1."""
INTEGRATED = 1e-6
"""The error of a mean of a function under a law that is no list of outcomes."""


@dataclass(frozen=True, slots=True)
class SuccessUtility:
    """Minus the logarithm of a product along a plan: the probabilities of success, times the utilities of the actions.

    A step succeeds when the outcome comes that the plan counts on; a step that does not ends the plan with utility 0.
    The utility of an action is the mean utility of what that outcome costs, above 0 and at most 1. So every action has
    a price, `-ln p - ln u`, and prices add up: it is additive, and the plan of least value has the largest product. The
    probability may depend on the state, which is what the outcomes counted on before have made it.

    Source: equation 8 of the paper, after Magnenat, Chappelier and Mondada, *Integration of online learning into HTN
    planning for robotic tasks*, 2012.

    Args:
        utility: of the cost of an action. An alpha, positive, per unit of cost, for `u = e^(-alpha cost)`; or a
            function of a cost, at least 0 in the domain's unit, that is above 0 and at most 1: a plan with the same
            actions in larger units would not stay the best one under utilities above 1.

    Raises:
        UsageError: it is neither.
    """

    utility: float | Callable[[float], float]

    unit = ValueUnit.LOG_UTILITY
    monotone = True
    concave = False
    allows_segmentation = True
    plan_utility = PlanUtility.SUCCESS

    def __post_init__(self) -> None:
        if callable(self.utility):
            if isinstance(self.utility, type):
                raise UsageError(f"the utility of an action is a function of its cost, found {shown(self.utility)}")
            return
        object.__setattr__(self, "utility", positive(self.utility, "alpha"))

    @property
    def function_type(self) -> FunctionType:
        """The family of the utility of an action."""
        return FunctionType.OTHER if callable(self.utility) else FunctionType.EXPONENTIAL

    def risk_cost(self, law: CostLaw) -> float:
        """Return the price of a cost, minus the logarithm of its mean utility: at least 0.

        Raises:
            UsageError: a utility is not above 0, or above 1.
        """
        if not callable(self.utility):
            return self.utility * Exponential(Attitude.SEEKING, self.utility).risk_cost(expect_law(law))
        checked = checked_function(self.utility, "the utility of an action")

        def utility(cost: float) -> float:
            worth = checked(cost)
            if not 0 < worth <= 1:
                raise UsageError(
                    f"the utility of an action must be above 0 and at most 1, found {worth:g} for a cost of {cost:g}"
                )
            return worth

        return max(0.0, -math.log(expect_law(law).expectation(utility)))

    def price_error(self, law: CostLaw) -> float:
        """Return by how much `risk_cost` may be off beyond its rounding as a number."""
        if callable(self.utility):
            return NEAR_ONE if isinstance(law, CostDistribution) else INTEGRATED
        return self.utility * law.exponential_mean_error(-self.utility)

    def outcome_price(self, probability: float) -> float:
        """Return the price of counting on an outcome of a probability above 0, minus its logarithm."""
        return max(0.0, -math.log(probability))

    def value(self, law: CostLaw) -> float:
        """Return the price of a cost, which certainly comes."""
        return self.risk_cost(law)

    def expected_utility(self, value: float) -> float:
        """Return the product that a value stands for."""
        return math.exp(-value)

    def __str__(self) -> str:
        if callable(self.utility):
            return f"success-utility {getattr(self.utility, '__name__', type(self.utility).__name__)}"
        return f"success-utility alpha={text_of(self.utility)}"
