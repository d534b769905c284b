"""The RA-parameters that say which class of risk-aware HTN planning problems a run solves (paper section 6)."""

from __future__ import annotations

from dataclasses import dataclass

from statehtn.errors import UsageError
from statehtn.risk.utility import FunctionType, PlanUtility, Utility

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
        return f"P{self.i}{self.j}{self.k}{self.l:d}{self.m}{self.n:d}"


def problem_class(solver: str, utility: Utility) -> RiskProblemClass:
    """Return the class of problems that a solver solves with a utility: one effect per action, a static attitude.

    Raises:
        UsageError: there is no such solver.
    """
    if solver not in PLANNING_TYPES:
        raise UsageError(f"unknown solver '{solver}'; there are {', '.join(PLANNING_TYPES)}")
    return RiskProblemClass(
        i=PLANNING_TYPES[solver],
        j="1",
        k=0,
        l=utility.function_type,
        m=int(utility.allows_segmentation),
        n=utility.plan_utility,
    )
