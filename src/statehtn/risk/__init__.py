"""Utilities, the price of uncertain costs to an agent, and the expected utility of plans."""

from __future__ import annotations

from statehtn.risk.agents import UTILITIES, agent_name, agent_order, agents_of, utility_for
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
from statehtn.risk.utility import Attitude, AttitudeName, FunctionType, PlanUtility, Utility

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
    "agent_order",
    "agents_of",
    "expected_utility",
    "expected_utility_by_trajectories",
    "expected_utility_text",
    "plan_expected_cost",
    "plan_risk_cost",
    "problem_class",
    "utility_for",
]
