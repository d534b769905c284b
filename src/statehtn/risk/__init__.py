"""Objectives: what an uncertain cost is worth to an agent, as text and as objects; utilities of plans."""

from __future__ import annotations

from statehtn.risk.agents import UTILITIES, agent_in, agent_name, agent_order, agents_of, utility_for
from statehtn.risk.callable_utility import CallableUtility
from statehtn.risk.cvar import ConditionalValueAtRisk
from statehtn.risk.deadline import Deadline
from statehtn.risk.disutility import FiniteObjective, Term
from statehtn.risk.evar import EntropicValueAtRisk
from statehtn.risk.expected_utility import (
    adds_up,
    expected_utility,
    expected_utility_by_trajectories,
    expected_utility_text,
    plan_expected_cost,
    plan_risk_cost,
)
from statehtn.risk.exponential import Exponential
from statehtn.risk.exponentials import Exponentials
from statehtn.risk.keep import Keep
from statehtn.risk.mean_cvar import MeanCvar
from statehtn.risk.mean_deviation import MeanDeviation
from statehtn.risk.mean_variance import MeanVariance
from statehtn.risk.neutral import Neutral
from statehtn.risk.objective import AdditiveObjective, Objective, ValueUnit, certainty_equivalent
from statehtn.risk.objectives import OBJECTIVES, ObjectiveForm, ObjectiveLike, objective
from statehtn.risk.one_switch import OneSwitch
from statehtn.risk.overrun import Overrun
from statehtn.risk.piecewise import Piecewise
from statehtn.risk.problem_class import RiskProblemClass, problem_class
from statehtn.risk.quantile import Quantile
from statehtn.risk.success import Success
from statehtn.risk.success_utility import SuccessUtility
from statehtn.risk.trajectory_utility import trajectory_utility
from statehtn.risk.utility import Attitude, AttitudeName, FunctionType, PlanUtility, Utility

__all__ = [
    "OBJECTIVES",
    "UTILITIES",
    "AdditiveObjective",
    "Attitude",
    "AttitudeName",
    "CallableUtility",
    "ConditionalValueAtRisk",
    "Deadline",
    "EntropicValueAtRisk",
    "Exponential",
    "Exponentials",
    "FiniteObjective",
    "FunctionType",
    "Keep",
    "MeanCvar",
    "MeanDeviation",
    "MeanVariance",
    "Neutral",
    "Objective",
    "ObjectiveForm",
    "ObjectiveLike",
    "OneSwitch",
    "Overrun",
    "Piecewise",
    "PlanUtility",
    "Quantile",
    "RiskProblemClass",
    "Success",
    "SuccessUtility",
    "Term",
    "Utility",
    "ValueUnit",
    "adds_up",
    "agent_in",
    "agent_name",
    "agent_order",
    "agents_of",
    "certainty_equivalent",
    "expected_utility",
    "expected_utility_by_trajectories",
    "expected_utility_text",
    "objective",
    "plan_expected_cost",
    "plan_risk_cost",
    "problem_class",
    "trajectory_utility",
    "utility_for",
]
