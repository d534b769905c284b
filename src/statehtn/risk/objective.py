"""What a plan is chosen by: a functional of the law of its total cost, minimised."""

from __future__ import annotations

from enum import StrEnum
from typing import Protocol, runtime_checkable

from statehtn.model.cost.law import CostLaw


class ValueUnit(StrEnum):
    """The unit of an objective's values."""

    COST = "cost"
    """The domain's own. A certain cost has itself as its value, but for overruns."""
    PROBABILITY = "probability"
    UTILITY = "utility"
    """Minus the expected utility."""
    LOG_UTILITY = "log-utility"
    """Minus the natural logarithm of the expected utility."""


@runtime_checkable
class Objective(Protocol):
    """What plans are compared by: `value` of the law of a plan's total cost, minimised.

    `str` of an objective is its text form, from which `statehtn.objective` makes it again (`cvar 0.95`).
    """

    @property
    def unit(self) -> ValueUnit:
        """The unit of its values."""
        ...

    @property
    def monotone(self) -> bool:
        """True if a law is never worse than one of larger costs (in the usual stochastic order)."""
        ...

    @property
    def concave(self) -> bool:
        """True if a law is never worse than one that is larger in the increasing convex order: it is averse to risk."""
        ...

    def value(self, law: CostLaw) -> float:
        """Return what a total cost of this law is worth: to be minimised, in `unit`.

        Raises:
            InputError: it is infinite, or cannot be computed.
        """
        ...

    def __str__(self) -> str:
        """Return the text form."""
        ...


@runtime_checkable
class AdditiveObjective(Objective, Protocol):
    """An objective whose value is a sum over the actions: every action has a price of its own, `risk_cost`.

    The price is the value of the action's law; objectives whose values do not add up have no such method.
    """

    def risk_cost(self, law: CostLaw) -> float:
        """Return the price of a cost: to be minimised, in its unit, additive over independent costs.

        Raises:
            InputError: it is infinite, or cannot be computed.
        """
        ...


def certainty_equivalent(objective: Objective, law: CostLaw, value: float | None = None) -> float | None:
    """Return the certain cost that an objective values as much as a law; None where there is none, or no single one.

    It is the value itself where that is a cost, and what the objective says where it has a method of this name.

    Args:
        objective: whose it is.
        law: of the cost.
        value: that of the law, where it is known.
    """
    own = getattr(objective, "certainty_equivalent", None)
    if own is not None:
        found: float | None = own(law)
        return found
    if objective.unit != ValueUnit.COST:
        return None
    return objective.value(law) if value is None else value
