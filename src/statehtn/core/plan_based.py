"""Plan-based search in the compiled core (the paper's Algorithm 3)."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import statehtn._relax as _relax
from statehtn.core.pricing import PricedProblem
from statehtn.core.progress import Progress
from statehtn.core.search_run import SearchOutcome
from statehtn.core.staged_run import StagedRun
from statehtn.limits import Limits

BRANCHES = {
    "fewest": "the compound task with the fewest methods",
    "all": "every compound task, as the paper writes it",
}


def search_networks(
    problem: PricedProblem,
    *,
    heuristic: str = "tdg",
    branch: str = "fewest",
    checks_preconditions: bool = True,
    limits: Limits = Limits(),
    progress: Callable[[Progress], None] | None = None,
) -> Iterator[SearchOutcome]:
    """Search task networks, without a state, for the plan of least risk cost (the paper's Algorithm 3).

    Of the outcome's effort, `evaluated` counts primitive networks whose execution was tried, `dead_ends` those that
    cannot be executed.

    Args:
        problem: the ground problem and the prices of its actions.
        heuristic: `tdg` or `blind`, which need no state.
        branch: a name in `BRANCHES`: which compound tasks of a network are decomposed.
        checks_preconditions: leave out networks in which a precondition cannot be met any more.
        limits: when to stop; Ctrl-C stops, too.
        progress: called about every 50 ms on the calling thread.
    """
    options = plan_based_options(heuristic, branch, checks_preconditions)
    return StagedRun(problem, limits, progress).outcomes([options])


def plan_based_options(heuristic: str, branch: str, checks_preconditions: bool) -> _relax.PlanBasedOptions:
    """Return what the core is asked for, whatever plans are compared by; see `search_networks`."""
    options = _relax.PlanBasedOptions()
    options.heuristic = heuristic
    options.branches_over_all = branch == "all"
    options.checks_preconditions = checks_preconditions
    return options
