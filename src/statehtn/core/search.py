"""Search in the compiled core, as one stage or several, with outcomes in the domain's own unit of cost."""

from __future__ import annotations

import time
from collections import deque
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from types import MappingProxyType
from typing import TypeVar

import statehtn._relax as _relax
from statehtn.core.grounding import Grounding
from statehtn.core.heuristics import HEURISTICS, PORTFOLIO, WEIGHTED
from statehtn.core.pricing import Prices, price
from statehtn.core.trace import read_trace
from statehtn.errors import UnsupportedError
from statehtn.limits import Limits
from statehtn.model.plan import Plan
from statehtn.model.status import Status
from statehtn.risk import Utility


@dataclass(frozen=True, slots=True)
class Stage:
    """One run of a best-first search; heuristic and weight are the user's where they are None.

    A greedy one is left out where a plan is known. It gives up after `most_evaluations`, or once it has looked at so
    many actions and methods (`most_looks`; evaluations take the longer, the more there are). `explores`: whether every
    other node is one at random.
    """

    algorithm: _relax.SearchAlgorithm
    heuristic: str | None = None
    weight: float | None = None
    most_evaluations: int | None = None
    most_looks: int | None = None
    explores: bool = True


def _greedy(heuristic: str | None = None) -> tuple[Stage, ...]:
    """Return the stages of a greedy search: by the heuristic, by the decomposition graph alone, and so on for longer.

    Where ground problems are huge, the decomposition graph leads to plans in the time of a few evaluations.
    """
    greedy = _relax.SearchAlgorithm.Greedy
    return (
        Stage(greedy, heuristic, most_evaluations=20_000, most_looks=12_000_000, explores=False),
        Stage(greedy, "tdg", most_evaluations=60_000),
        Stage(greedy, heuristic, most_evaluations=150_000, most_looks=120_000_000),
        Stage(greedy, "tdg", most_evaluations=300_000),
        Stage(greedy, heuristic),
    )


SEARCHES: Mapping[str, tuple[Stage, ...]] = MappingProxyType(
    {
        "astar": (Stage(_relax.SearchAlgorithm.AStar),),
        "weighted": (Stage(_relax.SearchAlgorithm.Weighted),),
        "greedy": _greedy(),
        # A plan soon, then better ones: each stage looks only for plans that are better than the best one so far.
        "anytime": (
            *_greedy("ff"),
            Stage(_relax.SearchAlgorithm.Weighted, weight=4.0),
            Stage(_relax.SearchAlgorithm.Weighted, weight=2.0),
            Stage(_relax.SearchAlgorithm.AStar),
        ),
    }
)
"""The searches by name, each as the stages that it goes through; `plan` says what they promise."""

TOO_DEAR = "the costs of a plan add up to more than the search can hold: millions of times the largest cost"

_STATUSES = {
    _relax.SearchStatus.Optimal: Status.OPTIMAL,
    _relax.SearchStatus.Solved: Status.SOLVED,
    _relax.SearchStatus.Unsolvable: Status.UNSOLVABLE,
    _relax.SearchStatus.GaveUp: Status.EXHAUSTED,
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
    adaptive: bool = True
    """Ask an admissible heuristic rarely while it tells no more than the cheap bounds."""
    skip_dead_methods: bool = True
    """Leave out methods whose first task would come next and cannot be executed."""
    stubborn_sets: bool = True
    """Leave out actions that can wait: their order with the others makes no difference."""
    forget_facts: bool = True
    """States keep only the facts that something still to be done may read."""
    endings: bool = True
    """Leave out networks in partial order whose last actions cannot be executed in any order."""
    merge_sequences: bool = True
    """Networks in total order are the same if they differ in actions in a row that need and change the same."""
    learn_branching: bool = True
    """Decompose the compound task whose decompositions have survived least so far, not that with the fewest methods."""
    follow_forced: bool = True
    """Pass through nodes that have but one way to go on, as long as f stays as it is."""


@dataclass(frozen=True, slots=True)
class Progress:
    """How far a search has come.

    Args:
        seconds: since the run began, reading and grounding included.
        expanded: nodes whose successors were generated.
        generated: nodes that were made.
        evaluated: nodes that the heuristic was asked about.
        lower_bound: no plan has a lower risk cost, in the domain's own unit; None where none is known.
        best: the risk cost of the best plan so far; None where there is none.
    """

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
    cuts: int
    """Landmark cuts of all evaluations together."""


Item = TypeVar("Item")


def last_of(items: Iterable[Item]) -> Item:
    """Return the last of one or more items; keep none of the others."""
    (last,) = deque(items, maxlen=1)
    return last


def find_plans(
    grounding: Grounding,
    utility: Utility,
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
        utility: the agent's; it prices the actions.
        heuristic: a name in `HEURISTICS`, or `PORTFOLIO` for A* with several of them in turn.
        search: a name in `SEARCHES`; with an admissible heuristic `astar` and `anytime` promise the optimum, `weighted`
            a plan of at most `weight` times its risk cost.
        weight: of h in the weighted search, at least 1.
        limits: when to stop; Ctrl-C stops, too.
        progress: called about every 50 ms on the calling thread.
        switches: refinements to leave out.

    Raises:
        UnsupportedError: the costs of a plan exceed the range of fixed point, some 10^6 times the largest cost of an
            action.
    """
    return last_of(
        improving_plans(
            grounding,
            utility,
            heuristic=heuristic,
            search=search,
            weight=weight,
            limits=limits,
            progress=progress,
            switches=switches,
        )
    )


def improving_plans(
    grounding: Grounding,
    utility: Utility,
    *,
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
    run = StagedRun(grounding, price(grounding.laws, utility, grounding.action_text), limits, progress)
    size = max(1, grounding.handle.action_count + grounding.handle.method_count)
    for stage in SEARCHES[search]:
        if stage.algorithm is _relax.SearchAlgorithm.Greedy and run.best is not None:
            continue
        options = _relax.SearchOptions()
        options.algorithm = stage.algorithm
        name = stage.heuristic or heuristic
        if name == PORTFOLIO and stage.algorithm is _relax.SearchAlgorithm.AStar:
            options.algorithm = _relax.SearchAlgorithm.Portfolio
        else:
            options.heuristic = HEURISTICS[WEIGHTED if name == PORTFOLIO else name].kind
        options.weight = stage.weight or weight
        options.most_evaluations = stage.most_evaluations
        options.explores = stage.explores
        if stage.most_looks is not None:
            options.most_evaluations = min(stage.most_evaluations or stage.most_looks, 1 + stage.most_looks // size)
        options.use_tdg_bound = switches.tdg_bound
        options.inherit_h = switches.inherit_h
        options.ask_adaptively = switches.adaptive
        options.skip_dead_methods = switches.skip_dead_methods
        options.use_stubborn_sets = switches.stubborn_sets
        options.forget_facts = switches.forget_facts
        options.check_endings = switches.endings
        options.merge_sequences = switches.merge_sequences
        options.learn_branching = switches.learn_branching
        options.follow_forced = switches.follow_forced
        best = run.best
        if run.stage(options):
            break
        if run.best is not best:
            yield replace(run.outcome(), status=Status.SOLVED)
    yield run.outcome()


class StagedRun:
    """The stages of a search: the best plan and the best bound so far, and the effort of all of them together."""

    def __init__(
        self, grounding: Grounding, prices: Prices, limits: Limits, progress: Callable[[Progress], None] | None
    ) -> None:
        self.grounding = grounding
        self.prices = prices
        self.limits = limits
        self.progress = progress
        self.started = time.monotonic()
        self.best: _relax.SearchResult | None = None
        self.status = Status.UNSOLVABLE
        self.lower_bound: int | None = None
        self.done: list[_relax.SearchStatistics] = []

    def stage(self, options: _relax.SearchOptions) -> bool:
        """Run one stage; returns whether it was the last one that can make a difference."""
        options.upper_bound = None if self.best is None else self.best.cost
        limits = self.limits
        try:
            result = _relax.find_plans(
                self.grounding.handle,
                self.prices.units,
                options,
                None if limits.deadline is None else limits.deadline - time.monotonic(),
                None if limits.memory_mb is None else int(limits.memory_mb * 1e6),
                None if self.progress is None else self.report,
            )
        except OverflowError:
            raise UnsupportedError(TOO_DEAR) from None
        self.done.append(result.statistics)
        self.lower_bound = self.bound_with(result.statistics)
        self.status = _STATUSES[result.status]
        if self.status is Status.UNSOLVABLE and self.best is not None:
            self.status = Status.OPTIMAL  # nothing is better than the best plan so far
            self.lower_bound = self.best.cost
        elif result.cost is not None:
            self.best = result
        elif self.best is not None:
            self.status = Status.SOLVED
        return result.is_stopped or self.status not in (Status.SOLVED, Status.EXHAUSTED)

    def bound_with(self, statistics: _relax.SearchStatistics) -> int | None:
        """Return the best lower bound of all stages and this one."""
        bounds = [bound for bound in (self.lower_bound, statistics.lower_bound) if bound is not None]
        return max(bounds, default=None)

    def report(self, statistics: _relax.SearchStatistics) -> None:
        """Tell the user's callback how far the search has come."""
        assert self.progress is not None
        best = statistics.best if statistics.best is not None or self.best is None else self.best.cost
        everything = [*self.done, statistics]
        self.progress(
            Progress(
                time.monotonic() - self.started,
                sum(one.expanded for one in everything),
                sum(one.generated for one in everything),
                sum(one.evaluated for one in everything),
                self.cost(self.bound_with(statistics)),
                self.cost(best),
            )
        )

    def outcome(self) -> SearchOutcome:
        """Return how the stages ended together."""
        return SearchOutcome(
            self.status,
            None if self.best is None else read_trace(self.grounding, self.best),
            self.cost(self.lower_bound),
            sum(one.expanded for one in self.done),
            sum(one.generated for one in self.done),
            sum(one.evaluated for one in self.done),
            sum(one.dead_ends for one in self.done),
            sum(one.cuts for one in self.done),
        )

    def cost(self, units: int | None) -> float | None:
        """Return an amount of units in the domain's own unit."""
        return None if units is None else self.prices.cost(units)
