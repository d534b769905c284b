"""Utilities, the price of uncertain costs to an agent, and the expected utility of plans."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from statehtn.errors import UsageError
from statehtn.expected import number, one_of
from statehtn.risk.expected_utility import (
    expected_utility,
    expected_utility_by_trajectories,
    expected_utility_text,
    plan_expected_cost,
    plan_risk_cost,
)
from statehtn.risk.exponential import Exponential
from statehtn.risk.neutral import Neutral
from statehtn.risk.problem_class import RiskProblemClass, problem_class
from statehtn.risk.utility import Attitude, AttitudeName, FunctionType, PlanUtility, Utility, agent_name

__all__ = [
    "UTILITIES",
    "Attitude",
    "AttitudeName",
    "Exponential",
    "FunctionType",
    "Neutral",
    "PlanUtility",
    "RiskProblemClass",
    "Utility",
    "agent_name",
    "expected_utility",
    "expected_utility_by_trajectories",
    "expected_utility_text",
    "plan_expected_cost",
    "plan_risk_cost",
    "problem_class",
    "utility_for",
]


def _neutral(alpha: float | None) -> Utility:
    if alpha is not None:
        raise UsageError(
            f"the neutral attitude takes no alpha, found {alpha:g}; leave alpha out, or choose averse or seeking"
        )
    return Neutral()


def _exponential(attitude: Attitude) -> Callable[[float | None], Utility]:
    def make(alpha: float | None) -> Utility:
        if alpha is None:
            raise UsageError(f"the {attitude} attitude needs alpha, a positive number per unit of cost (such as 0.5)")
        return Exponential(attitude, alpha)

    return make


UTILITIES: Mapping[Attitude, Callable[[float | None], Utility]] = {
    Attitude.NEUTRAL: _neutral,
    Attitude.AVERSE: _exponential(Attitude.AVERSE),
    Attitude.SEEKING: _exponential(Attitude.SEEKING),
}
"""For every attitude the function that makes its utility from alpha (None: not given)."""


def utility_for(attitude: Attitude | AttitudeName, alpha: float | None = None) -> Utility:
    """Return the utility of an attitude.

    Args:
        attitude: neutral, averse or seeking.
        alpha: the curving coefficient, positive, per unit of cost; None for neutral.

    Raises:
        UsageError: there is no such attitude; alpha is missing for averse or seeking, given for neutral, or not a
            positive finite number.
    """
    make = UTILITIES[Attitude(one_of(attitude, UTILITIES, "attitude"))]
    return make(None if alpha is None else number(alpha, "alpha"))
