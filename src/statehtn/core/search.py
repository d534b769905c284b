"""Search in the compiled core: heuristics, algorithms, and their outcomes in the domain's own unit of cost."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from types import MappingProxyType

import statehtn._relax as _relax
from statehtn.core.grounding import Grounding
from statehtn.core.pricing import price
from statehtn.core.trace import read_trace
from statehtn.errors import UnsupportedError
from statehtn.limits import Limits
from statehtn.model.plan import Plan
from statehtn.model.status import Status
from statehtn.risk import Utility


@dataclass(frozen=True, slots=True)
class HeuristicInfo:
    """What is known of a heuristic.

    Args:
        kind: its name in the core.
        admissible: it never estimates more than is still to pay.
        consistent: along a step it falls by at most the step's cost.
        safe: what it calls a dead end is one.
        description: what it does, and where it comes from.
    """

    kind: _relax.HeuristicKind
    admissible: bool
    consistent: bool
    safe: bool
    description: str


HEURISTICS: Mapping[str, HeuristicInfo] = MappingProxyType(
    {
        "blind": HeuristicInfo(_relax.HeuristicKind.Blind, True, True, True, "always 0: uniform-cost search"),
        "tdg": HeuristicInfo(
            _relax.HeuristicKind.Tdg,
            True,
            True,
            True,
            "least cost of any decomposition, states ignored (the paper's Algorithms 1 and 2)",
        ),
        "hmax": HeuristicInfo(
            _relax.HeuristicKind.HMax,
            True,
            True,
            True,
            "max heuristic on the relaxed model (the paper's Algorithm 5; Bonet and Geffner 2001)",
        ),
        "lmcut": HeuristicInfo(
            _relax.HeuristicKind.LmCut,
            True,
            False,
            True,
            "landmark cuts on the relaxed model (the paper's Algorithm 5; Helmert and Domshlak 2009)",
        ),
        "potential": HeuristicInfo(
            _relax.HeuristicKind.Potential,
            True,
            False,
            True,
            "decomposition-graph bound, plus landmark cuts on what methods cost beyond it",
        ),
        "add": HeuristicInfo(
            _relax.HeuristicKind.Add,
            False,
            False,
            True,
            "additive heuristic on the relaxed model, for greedy search (Bonet and Geffner 2001)",
        ),
        "ff": HeuristicInfo(
            _relax.HeuristicKind.Ff,
            False,
            False,
            True,
            "relaxed plan on the relaxed model, for greedy search (Hoffmann and Nebel 2001)",
        ),
    }
)

ALGORITHMS: Mapping[str, _relax.SearchAlgorithm] = MappingProxyType(
    {
        "astar": _relax.SearchAlgorithm.AStar,
        "weighted": _relax.SearchAlgorithm.Weighted,
        "greedy": _relax.SearchAlgorithm.Greedy,
    }
)
SEARCHES = tuple(ALGORITHMS)

_STATUSES = {
    _relax.SearchStatus.Optimal: Status.OPTIMAL,
    _relax.SearchStatus.Solved: Status.SOLVED,
    _relax.SearchStatus.Unsolvable: Status.UNSOLVABLE,
    _relax.SearchStatus.TimeLimit: Status.TIME_LIMIT,
    _relax.SearchStatus.MemoryLimit: Status.MEMORY_LIMIT,
    _relax.SearchStatus.Interrupted: Status.INTERRUPTED,
}


@dataclass(frozen=True, slots=True)
class SearchSwitches:
    """Refinements of the search that change its effort but never its optimum."""

    tdg_bound: bool = True
    """Bound every node by the decomposition graph before the heuristic is asked (not with `blind`)."""
    inherit_h: bool = True
    """A node's h is at least its parent's less the cost of the step between them."""


@dataclass(frozen=True, slots=True)
class Progress:
    """How far a search has come; risk costs in the domain's own unit, None where not known."""

    seconds: float
    expanded: int
    generated: int
    evaluated: int
    lower_bound: float | None
    best: float | None


@dataclass(frozen=True, slots=True)
class SearchOutcome:
    """How a search ended. `lower_bound` bounds the risk cost of every plan; None if there is none."""

    status: Status
    plan: Plan | None
    lower_bound: float | None
    expanded: int
    generated: int
    evaluated: int
    dead_ends: int


def find_plans(
    grounding: Grounding,
    utility: Utility,
    *,
    heuristic: str = "lmcut",
    search: str = "astar",
    weight: float = 1.0,
    limits: Limits = Limits(),
    progress: Callable[[Progress], None] | None = None,
    switches: SearchSwitches = SearchSwitches(),
) -> SearchOutcome:
    """Search for the plan of least risk cost (the paper's Algorithm 4), without the GIL.

    Args:
        grounding: the ground problem and its cost laws.
        utility: the agent's; it prices the actions.
        heuristic: a name in `HEURISTICS`.
        search: a name in `SEARCHES`; with an admissible heuristic `astar` promises the optimum, `weighted` a plan of at
            most `weight` times its risk cost.
        weight: of h in weighted A*, at least 1.
        limits: when to stop; Ctrl-C stops, too.
        progress: called about every 50 ms on the calling thread.
        switches: refinements to leave out.

    Raises:
        UnsupportedError: the costs of a plan exceed the range of fixed point, some 10^6 times the largest cost of an
            action.
    """
    prices = price(grounding.laws, utility)
    options = _relax.SearchOptions()
    options.heuristic = HEURISTICS[heuristic].kind
    options.algorithm = ALGORITHMS[search]
    options.weight = weight
    options.use_tdg_bound = switches.tdg_bound
    options.inherit_h = switches.inherit_h
    started = time.monotonic()

    def to_cost(units: int | None) -> float | None:
        return None if units is None else prices.cost(units)

    def report(statistics: _relax.SearchStatistics) -> None:
        assert progress is not None
        progress(
            Progress(
                time.monotonic() - started,
                statistics.expanded,
                statistics.generated,
                statistics.evaluated,
                to_cost(statistics.lower_bound),
                to_cost(statistics.best),
            )
        )

    try:
        result = _relax.find_plans(
            grounding.handle,
            prices.units,
            options,
            None if limits.deadline is None else limits.deadline - started,
            None if limits.memory_mb is None else int(limits.memory_mb * 1e6),
            None if progress is None else report,
        )
    except OverflowError:
        raise UnsupportedError(
            "the costs of a plan add up to more than the search can hold: millions of times the largest cost"
        ) from None
    statistics = result.statistics
    return SearchOutcome(
        _STATUSES[result.status],
        None if result.cost is None else read_trace(grounding, result),
        to_cost(statistics.lower_bound),
        statistics.expanded,
        statistics.generated,
        statistics.evaluated,
        statistics.dead_ends,
    )


class HeuristicEvaluator:
    """A heuristic on its own, for states and networks of the caller's choice."""

    def __init__(self, grounding: Grounding, utility: Utility, heuristic: str) -> None:
        self._prices = price(grounding.laws, utility)
        self._evaluator = _relax.Evaluator(grounding.handle, self._prices.units, HEURISTICS[heuristic].kind)

    def __call__(self, state: Iterable[int], tasks: Iterable[int]) -> float | None:
        """Estimate the cost still to come, rounded down; None for a dead end.

        Args:
            state: the facts that hold, numbered as in `Grounding.to_model()`.
            tasks: the tasks of the network, with repetitions, numbered likewise.
        """
        units = self._evaluator.evaluate(list(state), list(tasks))
        return None if units is None else self._prices.cost(units)
