"""The k best plans that differ in their actions, in the compiled core."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType
from typing import overload

import statehtn._relax as _relax
from statehtn.core.grounding import STOPPED, Grounding
from statehtn.core.heuristics import HEURISTICS
from statehtn.core.pricing import price
from statehtn.core.switches import SearchSwitches
from statehtn.core.trace import TraceReader
from statehtn.limits import Limits
from statehtn.model.plan import Plan
from statehtn.model.status import Status
from statehtn.risk import Utility

DISTINCT: Mapping[str, _relax.Distinct] = MappingProxyType(
    {"sequence": _relax.Distinct.Sequence, "multiset": _relax.Distinct.Multiset}
)
"""When two plans are different: as sequences of actions, or by which actions they have and how many of each."""


@dataclass(frozen=True, slots=True)
class TopProgress:
    """How far a search for several plans has come.

    `lower_bound` is a risk cost in the domain's own unit: all cheaper plans are among the `found`, of which the first
    `proven` are the best there are. `seconds` count from the beginning of the run; `expanded`, `generated` and
    `evaluated` are numbers of search nodes.
    """

    seconds: float
    expanded: int
    generated: int
    evaluated: int
    lower_bound: float | None
    found: int
    proven: int


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
    started = time.monotonic()
    prices = price(grounding, utility)
    options = _relax.TopPlansOptions()
    options.count = k
    options.distinct = DISTINCT[distinct]
    options.limits_ways = limits_ways
    search = _relax.SearchOptions()
    search.heuristic = HEURISTICS[heuristic].kind
    switches.apply(search)
    options.search = search

    def cost(units: int | None) -> float | None:
        return None if units is None else prices.cost(units)

    def report(statistics: _relax.TopPlansStatistics) -> None:
        assert progress is not None
        progress(
            TopProgress(
                time.monotonic() - started,
                statistics.expanded,
                statistics.generated,
                statistics.evaluated,
                cost(statistics.lower_bound),
                statistics.found,
                statistics.proven,
            )
        )

    result = _relax.top_plans(
        grounding.handle,
        prices.units,
        _labels(grounding),
        options,
        None if limits.deadline is None else limits.deadline - time.monotonic(),
        None if limits.memory_mb is None else int(limits.memory_mb * 1e6),
        None if progress is None else report,
    )
    statistics = result.statistics
    return TopOutcome(
        None if result.stop is None else STOPPED[result.stop],
        TracedPlans(TraceReader(grounding), result.plans),
        statistics.proven,
        result.is_all,
        cost(statistics.lower_bound),
        statistics.expanded,
        statistics.generated,
        statistics.evaluated,
        statistics.dead_ends,
    )


def _labels(grounding: Grounding) -> list[int | None]:
    """Return a number for every ground action, the same for the cases of one action; None for an artificial one."""
    numbers: dict[tuple[int, tuple[int, ...]], int] = {}
    handle = grounding.handle
    return [
        None
        if grounding.encoding.actions[schema] is None
        else numbers.setdefault((schema, tuple(handle.action_arguments(action))), len(numbers))
        for action, schema in enumerate(handle.action_schema)
    ]
