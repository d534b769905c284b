"""Optimal hierarchical (HTN) planning under risk: action costs are distributions, plans maximise expected utility.

import statehtn

problem = statehtn.read_hddl("domain.hddl", "p1.hddl")
result = statehtn.plan(problem, attitude="averse", alpha=0.9)
print(result)
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from statehtn.errors import InputError, Place, StateHtnError, UnsupportedError, UsageError
from statehtn.model import CostDistribution, CostLaw, Decomposition, Plan, Problem, Step
from statehtn.model.status import Status

if TYPE_CHECKING:
    __version__: str
    from statehtn.atlas.survey import Atlas, survey
    from statehtn.attitudes import AttitudeComparison
    from statehtn.build import Outcome, ProblemBuilder, chance, equal, exists, forall, when, with_cost
    from statehtn.build.cost_file import read_costs
    from statehtn.build.cost_table import CostTable
    from statehtn.build.joint_samples import read_joint_samples
    from statehtn.compatible import SOLVERS
    from statehtn.core.heuristics import HEURISTICS
    from statehtn.core.progress import Progress, TopProgress
    from statehtn.core.searches import SEARCHES
    from statehtn.explanation import NoPlan, WhyNot, why
    from statehtn.found_plan import PricedStep
    from statehtn.hddl import HddlWarning, read_hddl, read_hddl_text, write_hddl
    from statehtn.hddl.plan_format import read_plan, write_plan
    from statehtn.inspection import Finding, check
    from statehtn.interop import (
        cost_distributions,
        from_unified_planning,
        register,
        relax,
        relax_to_pddl,
        to_unified_planning,
    )
    from statehtn.planner import (
        Planner,
        attitude_map,
        compare_attitudes,
        frontier,
        improving,
        plan,
        policy,
        top_plans,
    )
    from statehtn.policies.policy import Policy
    from statehtn.policies.result import PolicyResult
    from statehtn.policies.sequence import sequence_cost
    from statehtn.result import Result
    from statehtn.risk import (
        OBJECTIVES,
        Attitude,
        CallableUtility,
        ConditionalValueAtRisk,
        Deadline,
        EntropicValueAtRisk,
        Exponential,
        Exponentials,
        Keep,
        MeanCvar,
        MeanDeviation,
        MeanVariance,
        Neutral,
        Objective,
        OneSwitch,
        Overrun,
        Piecewise,
        Quantile,
        Success,
        SuccessUtility,
        Utility,
        objective,
        trajectory_utility,
        utility_for,
    )
    from statehtn.risk.elicitation import Elicited, alpha_of
    from statehtn.sweeps.attitude_map import AttitudeMap
    from statehtn.sweeps.frontier import Frontier
    from statehtn.tabulate import tabulate_costs
    from statehtn.top_result import RankedPlan, TopPlans
    from statehtn.validation import Validation
    from statehtn.verify import validate

__all__ = [
    "HEURISTICS",
    "OBJECTIVES",
    "SEARCHES",
    "SOLVERS",
    "Atlas",
    "Attitude",
    "AttitudeComparison",
    "AttitudeMap",
    "CallableUtility",
    "ConditionalValueAtRisk",
    "CostDistribution",
    "CostLaw",
    "CostTable",
    "Deadline",
    "Decomposition",
    "Elicited",
    "EntropicValueAtRisk",
    "Exponential",
    "Exponentials",
    "Finding",
    "Frontier",
    "HddlWarning",
    "InputError",
    "Keep",
    "MeanCvar",
    "MeanDeviation",
    "MeanVariance",
    "Neutral",
    "NoPlan",
    "Objective",
    "OneSwitch",
    "Outcome",
    "Overrun",
    "Piecewise",
    "Place",
    "Plan",
    "Planner",
    "Policy",
    "PolicyResult",
    "PricedStep",
    "Problem",
    "ProblemBuilder",
    "Progress",
    "Quantile",
    "RankedPlan",
    "Result",
    "StateHtnError",
    "Status",
    "Step",
    "Success",
    "SuccessUtility",
    "TopPlans",
    "TopProgress",
    "UnsupportedError",
    "UsageError",
    "Utility",
    "Validation",
    "WhyNot",
    "__version__",
    "alpha_of",
    "attitude_map",
    "chance",
    "check",
    "compare_attitudes",
    "cost_distributions",
    "equal",
    "exists",
    "forall",
    "from_unified_planning",
    "frontier",
    "improving",
    "objective",
    "plan",
    "policy",
    "read_costs",
    "read_hddl",
    "read_hddl_text",
    "read_joint_samples",
    "read_plan",
    "register",
    "relax",
    "relax_to_pddl",
    "sequence_cost",
    "survey",
    "tabulate_costs",
    "to_unified_planning",
    "top_plans",
    "trajectory_utility",
    "utility_for",
    "validate",
    "when",
    "why",
    "with_cost",
    "write_hddl",
    "write_plan",
]

_MODULES_FOR_LATER = {
    "atlas.survey": ("Atlas", "survey"),
    "attitudes": ("AttitudeComparison",),
    "build": ("Outcome", "ProblemBuilder", "chance", "equal", "exists", "forall", "when", "with_cost"),
    "build.cost_file": ("read_costs",),
    "build.cost_table": ("CostTable",),
    "build.joint_samples": ("read_joint_samples",),
    "compatible": ("SOLVERS",),
    "core.heuristics": ("HEURISTICS",),
    "core.progress": ("Progress", "TopProgress"),
    "core.searches": ("SEARCHES",),
    "explanation": ("NoPlan", "WhyNot", "why"),
    "found_plan": ("PricedStep",),
    "hddl": ("HddlWarning", "read_hddl", "read_hddl_text", "write_hddl"),
    "hddl.plan_format": ("read_plan", "write_plan"),
    "inspection": ("Finding", "check"),
    "interop": (
        "cost_distributions",
        "from_unified_planning",
        "register",
        "relax",
        "relax_to_pddl",
        "to_unified_planning",
    ),
    "planner": ("Planner", "attitude_map", "compare_attitudes", "frontier", "improving", "plan", "policy", "top_plans"),
    "policies.policy": ("Policy",),
    "policies.result": ("PolicyResult",),
    "policies.sequence": ("sequence_cost",),
    "result": ("Result",),
    "risk": (
        "OBJECTIVES",
        "Attitude",
        "CallableUtility",
        "ConditionalValueAtRisk",
        "Deadline",
        "EntropicValueAtRisk",
        "Exponential",
        "Exponentials",
        "Keep",
        "MeanCvar",
        "MeanDeviation",
        "MeanVariance",
        "Neutral",
        "Objective",
        "OneSwitch",
        "Overrun",
        "Piecewise",
        "Quantile",
        "Success",
        "SuccessUtility",
        "Utility",
        "objective",
        "trajectory_utility",
        "utility_for",
    ),
    "risk.elicitation": ("Elicited", "alpha_of"),
    "sweeps.attitude_map": ("AttitudeMap",),
    "sweeps.frontier": ("Frontier",),
    "tabulate": ("tabulate_costs",),
    "top_result": ("RankedPlan", "TopPlans"),
    "validation": ("Validation",),
    "verify": ("validate",),
}
"""Where names are whose modules are imported when one of them is asked for, so that `import statehtn` is quick."""
_LATER = {name: f"statehtn.{module}" for module, names in _MODULES_FOR_LATER.items() for name in names}


if not TYPE_CHECKING:  # a type checker would take every name, also a misspelt one

    def __getattr__(name: str) -> Any:
        """Import what is asked for."""
        if name in _LATER:
            from importlib import import_module

            value = globals()[name] = getattr(import_module(_LATER[name]), name)
            return value
        if name != "__version__":
            from statehtn.expected import did_you_mean

            raise AttributeError(f"module 'statehtn' has no attribute '{name}'{did_you_mean(name, __all__)}")
        from importlib.metadata import PackageNotFoundError, version

        try:
            return version("statehtn")
        except PackageNotFoundError:
            return "0 (not installed)"


def __dir__() -> list[str]:
    """Return the public names, those that are imported later included."""
    return sorted(__all__)
