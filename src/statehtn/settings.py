"""What is asked of the planner: for whom, by which solver, heuristic and search; or for which of the best plans."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, fields
from types import MappingProxyType
from typing import Literal

from statehtn.core.heuristics import ADMISSIBLE, HEURISTICS, PORTFOLIO
from statehtn.core.plan_based import BRANCHES
from statehtn.core.searches import SEARCHES, TAKES
from statehtn.core.switches import SearchSwitches
from statehtn.core.top_plans import DISTINCT
from statehtn.errors import UsageError
from statehtn.expected import number, one_of, shown, whole_number
from statehtn.risk import Neutral, Utility, problem_class

SOLVERS: Mapping[str, str] = MappingProxyType(
    {
        "state": "A* progression search over states and task networks (paper Algorithm 4)",
        "plan": "A* search over task networks alone (paper Algorithms 1 to 3)",
    }
)
"""The solvers by name, with a line about each."""
HEURISTIC_CHOICES = (PORTFOLIO, *HEURISTICS)
"""What may be asked for as a heuristic."""
SWITCHES = tuple(field.name for field in fields(SearchSwitches))
"""The refinements that the solver `state` can do without."""
NOTHING = "nothing"
"""What is left out of the complete search."""
DEFAULT_WEIGHT = 2.0
MOST_PLANS = 1_000_000_000


# The same names for type checkers.
SolverName = Literal["state", "plan"]
SearchName = Literal["astar", "weighted", "greedy", "anytime"]
TopHeuristicName = Literal["blind", "tdg", "hmax", "lmcut", "potential", "potential-hmax"]
HeuristicName = Literal[TopHeuristicName, "auto", "add", "ff"]
BranchName = Literal["fewest", "all"]
DistinctName = Literal["sequence", "multiset"]


@dataclass(frozen=True, slots=True)
class Settings:
    """What to optimise, and how; make one by `Settings.of`, which checks it."""

    objective: Utility
    solver: str
    heuristic: str
    search: str
    weight: float
    branch: str
    without: tuple[str, ...] = ()

    @staticmethod
    def of(
        objective: Utility = Neutral(),
        solver: str = "state",
        heuristic: str | None = None,
        search: str = "astar",
        weight: float | None = None,
        branch: str | None = None,
        without: Sequence[str] = (),
    ) -> Settings:
        """Check the arguments, described at `statehtn.plan`; `without`: names from `SWITCHES` to leave out.

        Raises:
            UsageError: a name is unknown, a number out of range, or they do not go together.
        """
        one_of(solver, SOLVERS, "solver")
        one_of(search, SEARCHES, "search")
        if heuristic is not None:
            one_of(heuristic, HEURISTIC_CHOICES, "heuristic")
        if branch is not None:
            one_of(branch, BRANCHES, "branch")
        left_out = tuple(sorted(set(_refinements(without))))
        if reason := mismatch(solver, heuristic, search, without):
            raise UsageError(reason)
        if branch is not None and solver != "plan":
            raise UsageError(f"a branch belongs to the solver 'plan', not to '{solver}'")
        if weight is not None and search != "weighted":
            raise UsageError(f"a weight belongs to the weighted search, not to '{search}'")
        if weight is None:
            weight = DEFAULT_WEIGHT if search == "weighted" else 1.0
        weight = number(weight, "the weight")
        if not (math.isfinite(weight) and weight >= 1):
            raise UsageError(f"the weight must be a finite number and at least 1, found {weight:g}")
        heuristic = heuristic or TAKES[solver, search][0]
        return Settings(objective, solver, heuristic, search, weight, branch or "fewest", left_out)

    @property
    def switches(self) -> SearchSwitches:
        """The refinements of the search, without those to leave out."""
        return SearchSwitches(**dict.fromkeys(self.without, False))

    @property
    def problem_class(self) -> str:
        """The paper's RA-parameters of what is solved, such as `PS10110`."""
        return str(problem_class(self.solver, self.objective))


@dataclass(frozen=True, slots=True)
class TopSettings:
    """Which of the best plans are wanted, and how to find them; make one by `TopSettings.of`, which checks it."""

    objective: Utility
    k: int
    distinct: str
    heuristic: str

    @staticmethod
    def of(
        k: int, objective: Utility = Neutral(), distinct: str = "sequence", heuristic: str | None = None
    ) -> TopSettings:
        """Check the arguments, described at `statehtn.top_plans`.

        Raises:
            UsageError: a name is unknown, or a number out of range.
        """
        if not 1 <= whole_number(k, "the number of plans") <= MOST_PLANS:
            raise UsageError(f"the number of plans must be from 1 to {MOST_PLANS}, found {shown(k)}")
        one_of(distinct, DISTINCT, "value of 'distinct'")
        takes = TAKES["state", "top"]
        heuristic = takes[0] if heuristic is None else heuristic
        if isinstance(heuristic, str) and heuristic in HEURISTICS and heuristic not in takes:
            raise UsageError(_misleads(heuristic, "the search for the best plans"))
        one_of(heuristic, ADMISSIBLE, "heuristic for the best plans")
        return TopSettings(objective, k, distinct, heuristic)

    @property
    def problem_class(self) -> str:
        """The paper's RA-parameters of what is solved, such as `PS10110`."""
        return str(problem_class("state", self.objective))


def switches_in(text: str) -> tuple[str, ...]:
    """Return the names in a text such as `endings+stubborn_sets`; none for `nothing`.

    Raises:
        UsageError: there is no such refinement.
    """
    return () if text == NOTHING else _refinements(text.split("+"))


def _refinements(names: Iterable[str]) -> tuple[str, ...]:
    return tuple(one_of(name, SWITCHES, "refinement") for name in names)


def mismatch(solver: str, heuristic: str | None, search: str, without: Sequence[str] = ()) -> str | None:
    """Return why a solver does not take a heuristic, None for its own, a search and omissions together; None if so."""
    takes = TAKES.get((solver, search))
    if takes is None:
        return f"the solver '{solver}' has no search but 'astar', found '{search}'"
    if without and solver != "state":
        return f"the solver '{solver}' has none of the refinements of 'state', found '{'+'.join(without)}'"
    if heuristic is None or heuristic in takes:
        return None
    if solver == "plan":
        usable = " and ".join(takes)
        return f"the solver 'plan' has no state, which '{heuristic}' needs; its heuristics are {usable}"
    if heuristic == PORTFOLIO:
        searches = (name for name in SEARCHES if PORTFOLIO in TAKES[solver, name])
        return f"'{PORTFOLIO}' goes with the searches {' and '.join(searches)}, not with '{search}'"
    reason = _misleads(heuristic, f"the search '{search}'")
    return f"{reason}, or '{heuristic}' with greedy search"


def _misleads(heuristic: str, search: str) -> str:
    """Say why a search that proves something does not take a heuristic."""
    return (
        f"'{heuristic}' may estimate more than is true, so that {search} could not keep what it promises; take one of "
        f"{', '.join(ADMISSIBLE)}"
    )
