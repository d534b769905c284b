"""The RA-parameters that say which class of risk-aware HTN planning problems a run solves (paper section 6)."""

from __future__ import annotations

from dataclasses import dataclass

from statehtn.errors import UsageError
from statehtn.risk.objective import Objective
from statehtn.risk.utility import FunctionType, PlanUtility

PLANNING_TYPES = {"state": "S", "plan": "P"}
"""The RA-parameter `i` of every solver."""


@dataclass(frozen=True, slots=True)
class RiskProblemClass:
    """The six RA-parameters; as text `P i j k l m n`, such as `PS10110`.

    Args:
        i: the planning type: `S` for state-based, `P` for plan-based.
        j: the number of an action's effects: `1`, or `n` for any number.
        k: the kind of attitude: 0 static, 1 dynamic.
        l: the family of the utility function.
        m: 1 if the function allows segmentation, else 0 (the paper's definition; its prose has them interchanged).
        n: the definition of the plan's expected utility.
    """

    i: str
    j: str
    k: int
    l: FunctionType  # noqa: E741 (the paper's letter)
    m: int
    n: PlanUtility

    def __str__(self) -> str:
        n = "*" if self.n == PlanUtility.TRAJECTORIES else f"{self.n:d}"
        return f"P{self.i}{self.j}{self.k}{self.l:d}{self.m}{n}"


def problem_class(solver: str, objective: Objective, effects: str = "1") -> RiskProblemClass | None:
    """Return the class of problems that a solver solves for an objective.

    The objective says what it is by `function_type`, `allows_segmentation` and `plan_utility`, and by `is_dynamic` if
    its attitude changes with what is left. One without `plan_utility` is a measure of risk that is no expected utility
    (a quantile, say), and outside of the paper's classes: None.

    Args:
        solver: `state` or `plan`.
        objective: what is minimised.
        effects: `1` where every action has one effect, `n` where some have several.

    Raises:
        UsageError: there is no such solver.
    """
    if solver not in PLANNING_TYPES:
        raise UsageError(f"unknown solver '{solver}'; there are {', '.join(PLANNING_TYPES)}")
    plan_utility = getattr(objective, "plan_utility", None)
    if plan_utility is None:
        return None
    return RiskProblemClass(
        i=PLANNING_TYPES[solver],
        j=effects,
        k=int(getattr(objective, "is_dynamic", False)),
        l=getattr(objective, "function_type", FunctionType.OTHER),
        m=int(getattr(objective, "allows_segmentation", False)),
        n=plan_utility,
    )
