"""The k best plans that differ in their actions, in the compiled core."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType
from typing import overload

import statehtn._relax as _relax
from statehtn.core.grounding import Grounding
from statehtn.core.heuristics import HEURISTICS
from statehtn.core.pricing import price
from statehtn.core.progress import TopProgress
from statehtn.core.switches import SearchSwitches
from statehtn.core.top_run import TopRun
from statehtn.core.trace import TraceReader
from statehtn.limits import Limits, watched
from statehtn.model.plan import Plan
from statehtn.model.status import Status
from statehtn.risk import Utility

DISTINCT: Mapping[str, _relax.Distinct] = MappingProxyType(
    {"sequence": _relax.Distinct.Sequence, "multiset": _relax.Distinct.Multiset}
)
"""When two plans are different: as sequences of actions, or by which actions they have and how many of each."""


class TracedPlans(Sequence[Plan]):
    """Plans that the core has found, each read when it is asked for: that takes longer than finding it."""

    def __init__(self, reader: TraceReader, results: Sequence[_relax.SearchResult]) -> None:
        self.reader = reader
        self.results = results

    def __len__(self) -> int:
        return len(self.results)

    @overload
    def __getitem__(self, index: int) -> Plan: ...
    @overload
    def __getitem__(self, index: slice) -> TracedPlans: ...
    def __getitem__(self, index: int | slice) -> Plan | TracedPlans:
        if isinstance(index, slice):
            return TracedPlans(self.reader, self.results[index])
        return self.reader.read(self.results[index])

    def __iter__(self) -> Iterator[Plan]:
        return map(self.reader.read, self.results)


@dataclass(frozen=True, slots=True)
class TopOutcome:
    """How a search for several plans ended.

    Args:
        stopped: what ended it before it was done; None for nothing.
        plans: the best that were found, the best first.
        proven: the first so many of them are the best there are.
        is_all: there are no other plans.
        lower_bound: a lower bound of the risk cost of every plan that is not among them; None if there is none.
    """

    stopped: Status | None
    plans: Sequence[Plan]
    proven: int
    is_all: bool
    lower_bound: float | None
    expanded: int
    generated: int
    evaluated: int
    dead_ends: int


def find_top_plans(
    grounding: Grounding,
    utility: Utility,
    k: int,
    *,
    distinct: str = "sequence",
    heuristic: str = "lmcut",
    limits: Limits = Limits(),
    progress: Callable[[TopProgress], None] | None = None,
    switches: SearchSwitches = SearchSwitches(),
    limits_ways: bool = True,
) -> TopOutcome:
    """Search for the k plans of least risk cost that differ in their actions.

    Args:
        grounding: the ground problem and its cost laws.
        utility: the agent's; it prices the actions.
        k: how many plans are wanted, at least 1.
        distinct: a name in `DISTINCT`.
        heuristic: the name of an admissible heuristic in `HEURISTICS`.
        limits: when to stop; Ctrl-C stops, too.
        progress: called about every 50 ms on the calling thread.
        switches: refinements to leave out (some mean nothing here: see `relax::TopPlansOptions`).
        limits_ways: keep at most k ways to every pair of a state and a network.
    """
    with watched(limits):
        prices = price(grounding, utility)
    options = _relax.TopPlansOptions()
    options.count = k
    options.distinct = DISTINCT[distinct]
    options.limits_ways = limits_ways
    search = _relax.SearchOptions()
    search.heuristic = HEURISTICS[heuristic].kind
    switches.apply(search)
    options.search = search
    run = TopRun(grounding, prices, options, limits, progress)
    run.search()
    while run.sharpen():
        run.search()
    return TopOutcome(
        run.stopped,
        TracedPlans(TraceReader(grounding), [plan.trace for plan in run.plans]),
        run.proven,
        run.bound is not None and math.isinf(run.bound),
        run.lower_bound,
        sum(one.expanded for one in run.done),
        sum(one.generated for one in run.done),
        sum(one.evaluated for one in run.done),
        sum(one.dead_ends for one in run.done),
    )
