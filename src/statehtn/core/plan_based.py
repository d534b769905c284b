"""Plan-based search in the compiled core (the paper's Algorithm 3)."""

from __future__ import annotations

from collections.abc import Callable

import statehtn._relax as _relax
from statehtn.core.grounding import Grounding
from statehtn.core.heuristics import HEURISTICS
from statehtn.core.pricing import price
from statehtn.core.progress import Progress
from statehtn.core.staged_run import SearchOutcome, StagedRun
from statehtn.limits import Limits, watched
from statehtn.risk import Utility

PLAN_BASED_HEURISTICS = ("tdg", "blind")
"""Heuristics that need no state, the paper's first."""
BRANCHES = {
    "fewest": "the compound task with the fewest methods",
    "all": "every compound task, as the paper writes it",
}


def search_plans(
    grounding: Grounding,
    utility: Utility,
    *,
    heuristic: str = "tdg",
    branch: str = "fewest",
    checks_preconditions: bool = True,
    limits: Limits = Limits(),
    progress: Callable[[Progress], None] | None = None,
) -> SearchOutcome:
    """Search task networks, without a state, for the plan of least risk cost (the paper's Algorithm 3).

    Of the outcome's effort, `evaluated` counts primitive networks whose execution was tried, `dead_ends` those that
    cannot be executed.

    Args:
        grounding: the ground problem and its cost laws.
        utility: the agent's; it prices the actions.
        heuristic: a name in `PLAN_BASED_HEURISTICS`.
        branch: a name in `BRANCHES`: which compound tasks of a network are decomposed.
        checks_preconditions: leave out networks in which a precondition cannot be met any more.
        limits: when to stop; Ctrl-C stops, too.
        progress: called about every 50 ms on the calling thread.
    """
    options = _relax.SearchOptions()
    options.algorithm = _relax.SearchAlgorithm.PlanBased
    options.heuristic = HEURISTICS[heuristic].kind
    options.branches_over_all = branch == "all"
    options.checks_preconditions = checks_preconditions
    with watched(limits):
        prices = price(grounding, utility)
    run = StagedRun(grounding, prices, limits, progress)
    run.stage(options)
    while run.sharpen():
        run.stage(options)
    return run.outcome()
