"""What is asked of the planner: for whom, by which solver, heuristic and search."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Literal, cast

from statehtn.core.heuristics import GREEDY, HEURISTICS, PORTFOLIO, why_refused
from statehtn.core.plan_based import BRANCHES, PLAN_BASED_HEURISTICS
from statehtn.core.stages import SEARCHES
from statehtn.errors import UsageError
from statehtn.expected import number, one_of
from statehtn.risk import Attitude, AttitudeName, Utility, utility_for

SOLVERS: Mapping[str, str] = MappingProxyType(
    {
        "state": "A* progression search over states and task networks (paper Algorithm 4)",
        "plan": "A* search over task networks alone (paper Algorithms 1 to 3)",
    }
)
"""The solvers by name, with a line about each."""
HEURISTIC_CHOICES = (PORTFOLIO, *HEURISTICS)
"""What may be asked for as a heuristic."""
PORTFOLIO_SEARCHES = ("astar", "weighted", "anytime")
DEFAULT_WEIGHT = 2.0


# The same names for type checkers.
SolverName = Literal["state", "plan"]
SearchName = Literal["astar", "weighted", "greedy", "anytime"]
HeuristicName = Literal["auto", "blind", "tdg", "hmax", "lmcut", "potential", "potential-hmax", "add", "ff"]
BranchName = Literal["fewest", "all"]


@dataclass(frozen=True, slots=True)
class Query:
    """What to optimise, and how; make one by `Query.of`, which checks it."""

    utility: Utility
    solver: str
    heuristic: str
    search: str
    weight: float
    branch: str

    @staticmethod
    def of(
        attitude: Attitude | str = Attitude.NEUTRAL,
        alpha: float | None = None,
        solver: str = "state",
        heuristic: str | None = None,
        search: str = "astar",
        weight: float | None = None,
        branch: str | None = None,
    ) -> Query:
        """Check the arguments, described at `statehtn.plan`.

        Raises:
            UsageError: a name is unknown, a number out of range, or they do not go together.
        """
        utility = utility_for(cast("AttitudeName", attitude), alpha)
        one_of(solver, SOLVERS, "solver")
        one_of(search, SEARCHES, "search")
        if heuristic is not None:
            one_of(heuristic, HEURISTIC_CHOICES, "heuristic")
        if branch is not None:
            one_of(branch, BRANCHES, "branch")
        if reason := mismatch(solver, heuristic, search):
            raise UsageError(reason)
        if branch is not None and solver != "plan":
            raise UsageError(f"a branch belongs to the solver 'plan', not to '{solver}'")
        if weight is not None and search != "weighted":
            raise UsageError(f"a weight belongs to the weighted search, not to '{search}'")
        if weight is not None and not (math.isfinite(number(weight, "the weight")) and weight >= 1):
            raise UsageError(f"the weight must be a finite number and at least 1, found {weight:g}")
        if weight is None:
            weight = DEFAULT_WEIGHT if search == "weighted" else 1.0
        heuristic = heuristic or default_heuristic(solver, search)
        return Query(utility, solver, heuristic, search, weight, branch or "fewest")


def default_heuristic(solver: str, search: str) -> str:
    """Return the heuristic that is taken where none is given."""
    if solver == "plan":
        return PLAN_BASED_HEURISTICS[0]
    return GREEDY if search == "greedy" else PORTFOLIO


def mismatch(solver: str, heuristic: str | None, search: str) -> str | None:
    """Return why a solver does not take a heuristic, None for its own, and a search together; None if it does."""
    if solver == "plan" and search != "astar":
        return f"the solver 'plan' has no search but 'astar', found '{search}'"
    if solver == "plan" and heuristic not in (None, *PLAN_BASED_HEURISTICS):
        usable = " and ".join(PLAN_BASED_HEURISTICS)
        return f"the solver 'plan' has no state, which '{heuristic}' needs; its heuristics are {usable}"
    if heuristic is not None and search != "greedy" and (reason := why_refused(heuristic, f"the search '{search}'")):
        return f"{reason}, or '{heuristic}' with greedy search"
    if heuristic == PORTFOLIO and search not in PORTFOLIO_SEARCHES:
        return f"'{PORTFOLIO}' goes with the searches {' and '.join(PORTFOLIO_SEARCHES)}, not with '{search}'"
    return None
