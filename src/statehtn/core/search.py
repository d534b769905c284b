"""State-based search in the compiled core, as one stage or several."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterable, Iterator
from typing import TypeVar

from statehtn.core.grounding import Grounding
from statehtn.core.heuristics import PORTFOLIO
from statehtn.core.pricing import PricedProblem, price
from statehtn.core.progress import Progress
from statehtn.core.search_run import SearchOutcome
from statehtn.core.searches import SEARCHES, core_options
from statehtn.core.staged_run import StagedRun
from statehtn.core.switches import SearchSwitches
from statehtn.limits import Limits
from statehtn.risk import AdditiveObjective

Item = TypeVar("Item")


def last_of(items: Iterable[Item]) -> Item:
    """Return the last of one or more items; keep none of the others."""
    (last,) = deque(items, maxlen=1)
    return last


def find_plans(
    grounding: Grounding,
    objective: AdditiveObjective,
    *,
    heuristic: str = PORTFOLIO,
    search: str = "astar",
    weight: float = 1.0,
    limits: Limits = Limits(),
    progress: Callable[[Progress], None] | None = None,
    switches: SearchSwitches = SearchSwitches(),
) -> SearchOutcome:
    """Search for the plan of least risk cost (the paper's Algorithm 4), without the GIL.

    Args:
        grounding: the ground problem and its cost laws.
        objective: what plans are compared by; it prices the actions.
        heuristic: a name in `HEURISTICS`, or `PORTFOLIO` for searches with several of them in turn.
        search: a name in `SEARCHES`; with an admissible heuristic `astar` and `anytime` promise the optimum, `weighted`
            a plan of at most `weight` times its risk cost.
        weight: of h in the weighted search, at least 1.
        limits: when to stop; Ctrl-C stops, too.
        progress: called about every 50 ms on the calling thread.
        switches: refinements to leave out.
    """
    problem = price(grounding, objective, limits)
    return last_of(improving_plans(problem, heuristic, search, weight, limits, progress, switches))


def improving_plans(
    problem: PricedProblem,
    heuristic: str = PORTFOLIO,
    search: str = "anytime",
    weight: float = 1.0,
    limits: Limits = Limits(),
    progress: Callable[[Progress], None] | None = None,
    switches: SearchSwitches = SearchSwitches(),
) -> Iterator[SearchOutcome]:
    """Search as `find_plans`, and yield an outcome after every stage that found a better plan, and at the end.

    All but the last have the status `SOLVED`. Only `anytime` has several stages that find plans.
    """
    stages = SEARCHES[search]
    options = [core_options(stage, problem.grounding, heuristic, weight, switches) for stage in stages]
    run = StagedRun(problem, limits, progress)
    return run.outcomes(options, weight, sharpens=not stages[-1].finders)
