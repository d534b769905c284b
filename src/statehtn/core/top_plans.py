"""Search for the k best plans in the compiled core."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from types import MappingProxyType

import statehtn._relax as _relax
from statehtn.core.pricing import PricedProblem
from statehtn.core.progress import TopProgress
from statehtn.core.search_run import SearchOutcome
from statehtn.core.switches import TopSwitches, set_switches
from statehtn.core.top_run import TopRun
from statehtn.limits import Limits

DISTINCT: Mapping[str, _relax.Distinct] = MappingProxyType(
    {"sequence": _relax.Distinct.Sequence, "multiset": _relax.Distinct.Multiset}
)
"""When two plans are different: as sequences of actions, or by which actions they have and how many of each."""


def find_top_plans(
    problem: PricedProblem,
    k: int,
    *,
    distinct: str = "sequence",
    heuristic: str = "lmcut",
    limits: Limits = Limits(),
    progress: Callable[[TopProgress], None] | None = None,
    switches: TopSwitches = TopSwitches(),
) -> SearchOutcome:
    """Search for the k plans of least risk cost that differ in their actions.

    Args:
        problem: the ground problem and the prices of its actions.
        k: how many plans are wanted, at least 1.
        distinct: a name in `DISTINCT`.
        heuristic: the name of an admissible heuristic in `HEURISTICS`.
        limits: when to stop; Ctrl-C stops, too.
        progress: called about every 50 ms on the calling thread.
        switches: refinements to leave out.
    """
    options = _relax.LabelSearchOptions()
    options.count = k
    options.distinct = DISTINCT[distinct]
    options.heuristic = heuristic
    set_switches(options, switches)
    run = TopRun(problem, options, limits, progress)
    return run.outcome_of_all()
