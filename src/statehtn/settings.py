"""What is asked of the planner: by which objective, solver, heuristic and search; or for which of the best plans."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Literal

from statehtn.compatible import (
    HEURISTIC_CHOICES,
    SOLVERS,
    heuristics_for,
    misleads,
    mismatch,
    prices_add_up,
    refinements,
)
from statehtn.core.heuristics import ADMISSIBLE, HEURISTICS
from statehtn.core.plan_based import BRANCHES
from statehtn.core.searches import SEARCHES, TAKES
from statehtn.core.switches import LabelSwitches, SearchSwitches
from statehtn.core.top_plans import DISTINCT
from statehtn.errors import UsageError
from statehtn.expected import items, number, one_of, shown, whole_number
from statehtn.risk import (
    AdditiveObjective,
    Attitude,
    AttitudeName,
    Exponentials,
    Keep,
    MeanDeviation,
    Neutral,
    Objective,
    ObjectiveLike,
    OneSwitch,
    Success,
    objective,
    problem_class,
    utility_for,
)

DEFAULT_WEIGHT = 2.0
DEFAULT_PRECISION = 1e-6
PRECISION_OF_SUMS = 1e-9
"""Where a way to a node is a few sums: they are exact, so that plans that are nearly as good can be told apart."""
MOST_PLANS = 1_000_000_000
AGENTS_AS_OBJECTIVES = "as objectives, agents of an attitude are written 'neutral', 'averse A' and 'seeking A'"
KeepLike = Keep | str
"""A budget and the probability with which it is to be kept, or its text form, such as `25 0.95`."""


# The same names for type checkers.
SolverName = Literal["state", "plan"]
SearchName = Literal["astar", "weighted", "greedy", "anytime"]
TopHeuristicName = Literal["blind", "tdg", "hmax", "lmcut", "potential", "potential-hmax"]
HeuristicName = Literal[TopHeuristicName, "auto", "add", "ff"]
BranchName = Literal["fewest", "all"]
DistinctName = Literal["sequence", "multiset"]


class _Compared:
    """Plans are compared by an objective, of those that keep budgets."""

    __slots__ = ()
    objective: Objective
    keep: tuple[Keep, ...]

    @property
    def needs_labels(self) -> bool:
        """Whether a node's cost so far is more than one number: no price for each action says it all."""
        return not prices_add_up(self.objective, self.keep)

    @property
    def prices(self) -> AdditiveObjective:
        """The objective where prices add up."""
        return _additive(self.objective)


@dataclass(frozen=True, slots=True)
class Settings(_Compared):
    """What to optimise, and how; make one by `Settings.of`, which checks it."""

    objective: Objective
    solver: str
    heuristic: str
    search: str
    weight: float
    branch: str
    without: tuple[str, ...] = ()
    keep: tuple[Keep, ...] = ()
    precision: float = DEFAULT_PRECISION

    @staticmethod
    def of(
        objective: ObjectiveLike = Neutral(),
        solver: str = "state",
        heuristic: str | None = None,
        search: str = "astar",
        weight: float | None = None,
        branch: str | None = None,
        without: Sequence[str] = (),
        keep: KeepLike | Iterable[KeepLike] = (),
        precision: float | None = None,
    ) -> Settings:
        """Check the arguments, described at `statehtn.plan`; `without`: names from `SWITCHES` to leave out.

        Raises:
            UsageError: a name is unknown, a number out of range, or they do not go together.
        """
        wanted, kept = objective_of(objective), keeps(keep)
        one_of(solver, SOLVERS, "solver")
        one_of(search, SEARCHES, "search")
        if heuristic is not None:
            one_of(heuristic, HEURISTIC_CHOICES, "heuristic")
        if branch is not None:
            one_of(branch, BRANCHES, "branch")
        left_out = tuple(sorted(set(refinements(without))))
        if reason := mismatch(solver, heuristic, search, without, wanted, kept):
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
        heuristic = heuristic or heuristics_for(solver, search, wanted, kept)[0]
        how = solver, heuristic, search, weight, branch or "fewest", left_out
        return Settings(wanted, *how, kept, precision_of(precision, wanted, kept))

    @property
    def switches(self) -> SearchSwitches:
        """The refinements of a search by prices, without those to leave out."""
        return SearchSwitches(**dict.fromkeys(self.without, False))

    @property
    def label_switches(self) -> LabelSwitches:
        """The refinements of a search by labels, without those to leave out."""
        return LabelSwitches(**dict.fromkeys(self.without, False))

    @property
    def problem_class(self) -> str | None:
        """The paper's RA-parameters of what is solved, such as `PS10110`; None where it has no such class."""
        return _class_name(self.solver, self.objective)


@dataclass(frozen=True, slots=True)
class TopSettings(_Compared):
    """Which of the best plans are wanted, and how to find them; make one by `TopSettings.of`, which checks it."""

    objective: Objective
    k: int
    distinct: str
    heuristic: str
    keep: tuple[Keep, ...] = ()
    precision: float = DEFAULT_PRECISION

    @staticmethod
    def of(
        k: int,
        objective: ObjectiveLike = Neutral(),
        distinct: str = "sequence",
        heuristic: str | None = None,
        keep: KeepLike | Iterable[KeepLike] = (),
        precision: float | None = None,
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
            raise UsageError(misleads(heuristic, "the search for the best plans"))
        one_of(heuristic, ADMISSIBLE, "heuristic for the best plans")
        wanted, kept = objective_of(objective), keeps(keep)
        return TopSettings(wanted, k, distinct, heuristic, kept, precision_of(precision, wanted, kept))

    @property
    def problem_class(self) -> str | None:
        """The paper's RA-parameters of what is solved, such as `PS10110`; None where it has no such class."""
        return _class_name("state", self.objective)


def objective_of(
    wanted: ObjectiveLike | Success | None,
    attitude: Attitude | AttitudeName | None = None,
    alpha: float | None = None,
) -> Objective:
    """Return an objective from what a user gives: itself, its text form, a callable, or an attitude with its alpha.

    Raises:
        UsageError: there is none like that; or it is given in two ways.
    """
    if wanted is None:
        return utility_for(Attitude.NEUTRAL if attitude is None else attitude, alpha)
    if attitude is not None or alpha is not None:
        given = "an attitude" if attitude is not None else "alpha"
        raise UsageError(
            f"an objective and {given} are two ways to say one thing: leave one out; {AGENTS_AS_OBJECTIVES}"
        )
    return objective(wanted)


def keeps(given: KeepLike | Iterable[KeepLike]) -> tuple[Keep, ...]:
    """Return the budgets that a plan has to keep, each once.

    Raises:
        UsageError: one is none.
    """
    listed = [given] if isinstance(given, Keep | str) else items(given, "'keep'")
    return tuple(dict.fromkeys(map(Keep.of, listed)))


def precision_of(given: float | None, wanted: Objective, keep: Sequence[Keep] = ()) -> float:
    """Return how far from the optimum a plan may be that counts as optimal, as a part of max(1, value).

    Raises:
        UsageError: it is no such number.
    """
    if given is None:
        are_sums = isinstance(wanted, OneSwitch | Exponentials | MeanDeviation) and not keep
        return PRECISION_OF_SUMS if are_sums else DEFAULT_PRECISION
    value = number(given, "the precision")
    if not 0 < value < 1:
        raise UsageError(f"the precision must be between 0 and 1, such as 1e-6, found {value:g}")
    return value


def _additive(wanted: Objective) -> AdditiveObjective:
    assert isinstance(wanted, AdditiveObjective)
    return wanted


def _class_name(solver: str, wanted: Objective) -> str | None:
    """Return the paper's RA-parameters as text; None where it has no class for the objective."""
    found = problem_class(solver, wanted)
    return None if found is None else str(found)
