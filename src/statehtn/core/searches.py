"""The searches by name: the heuristics that each takes, and the stages that it goes through."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from types import MappingProxyType

import statehtn._relax as _relax
from statehtn.core.grounding import Grounding
from statehtn.core.heuristics import ADMISSIBLE, GREEDY, HEURISTICS, PORTFOLIO
from statehtn.core.switches import SearchSwitches


@dataclass(frozen=True, slots=True)
class BestFirst:
    """One best-first search; heuristic and weight are the user's where they are None.

    A greedy one gives up after `most_evaluations`, or once it has looked at so many actions and methods (`most_looks`;
    evaluations take the longer, the more there are). `explores`: whether every other node is one at random.
    `in_sequence`: tasks without an order are done in that of the domain, one after the other, which leaves out plans.
    `when_due`: methods that begin with an action, or a condition, are not chosen until it can be executed.
    """

    algorithm: _relax.SearchAlgorithm
    heuristic: str | None = None
    weight: float | None = None
    most_evaluations: int | None = None
    most_looks: int | None = None
    explores: bool = True
    in_sequence: bool = False
    when_due: bool = False


@dataclass(frozen=True, slots=True)
class Stage:
    """Searches that take turns: one that proves something and, for a plan soon, greedy ones, one after the other.

    With the heuristic `auto` the former are three, by `AUTOMATIC`.
    """

    prover: BestFirst
    finders: tuple[BestFirst, ...] = ()


AUTOMATIC = (("tdg",), ("lmcut",), ("potential-hmax", "potential", "lmcut"))
"""The heuristics of the three searches in turn that `auto` stands for; each asks its own one after the other."""


def _greedy(heuristic: str | None = None) -> tuple[BestFirst, ...]:
    """Return the stages of a greedy search: by the heuristic, by the decomposition graph alone, and so on for longer.

    Where ground problems are huge, the decomposition graph leads to plans in the time of a few evaluations. Where tasks
    have no order, finishing one before the next is begun often does, and takes little to try.
    """
    greedy = _relax.SearchAlgorithm.Greedy
    return (
        BestFirst(greedy, heuristic, None, 5_000, 5_000_000, explores=False, in_sequence=True),
        BestFirst(greedy, "tdg", None, 20_000, in_sequence=True),
        BestFirst(greedy, heuristic, None, 5_000, 5_000_000, explores=False, when_due=True),
        BestFirst(greedy, heuristic, None, 20_000, 12_000_000, explores=False),
        BestFirst(greedy, "tdg", None, 60_000),
        BestFirst(greedy, heuristic, None, 150_000, 120_000_000),
        BestFirst(greedy, "tdg", None, 300_000),
        BestFirst(greedy, heuristic),
    )


_ASTAR = BestFirst(_relax.SearchAlgorithm.AStar)

SEARCHES: Mapping[str, tuple[Stage, ...]] = MappingProxyType(
    {
        "astar": (Stage(_ASTAR),),
        "weighted": (Stage(BestFirst(_relax.SearchAlgorithm.Weighted)),),
        "greedy": (Stage(BestFirst(_relax.SearchAlgorithm.AStar, PORTFOLIO), _greedy()),),
        # A plan soon, then better ones: each stage looks only for plans that are better than the best one so far.
        "anytime": (
            Stage(_ASTAR, _greedy(GREEDY)),
            Stage(BestFirst(_relax.SearchAlgorithm.Weighted, weight=4.0)),
            Stage(BestFirst(_relax.SearchAlgorithm.Weighted, weight=2.0)),
            Stage(_ASTAR),
        ),
    }
)
"""The searches by name, each as the stages that it goes through; `plan` says what they promise."""


def _first(name: str, names: Iterable[str]) -> tuple[str, ...]:
    return (name, *(other for other in names if other != name))


TAKES: Mapping[tuple[str, str], tuple[str, ...]] = MappingProxyType(
    {
        ("state", "astar"): (PORTFOLIO, *ADMISSIBLE),
        ("state", "weighted"): (PORTFOLIO, *ADMISSIBLE),
        ("state", "greedy"): _first(GREEDY, HEURISTICS),
        ("state", "anytime"): (PORTFOLIO, *ADMISSIBLE),
        ("state", "top"): _first("potential", ADMISSIBLE),
        ("plan", "astar"): ("tdg", "blind"),
    }
)
"""The heuristics that a search of a solver takes, first the one that is taken where none is named.

What proves something takes admissible ones, and what knows no state those that need none. `top` finds the best plans.
"""


def core_options(
    stage: Stage, grounding: Grounding, heuristic: str, weight: float, switches: SearchSwitches
) -> _relax.SearchOptions:
    """Return what the core is asked for in a stage: a search, or a portfolio of several.

    Args:
        stage: the stage.
        grounding: the problem; its size counts for `most_looks`.
        heuristic: the user's, or `PORTFOLIO`.
        weight: the user's.
        switches: refinements to leave out.
    """
    size = max(1, grounding.handle.action_count + grounding.handle.method_count)

    def options_of(search: BestFirst, names: tuple[str, ...]) -> _relax.SearchOptions:
        options = _relax.SearchOptions()
        switches.apply(options)
        options.algorithm = search.algorithm
        options.heuristic, *options.more_heuristics = (HEURISTICS[name].kind for name in names)
        options.weight = search.weight or weight
        options.explores = search.explores
        options.in_sequence = search.in_sequence
        options.when_due = search.when_due
        options.most_evaluations = search.most_evaluations
        if search.most_looks is not None:
            options.most_evaluations = min(search.most_evaluations or search.most_looks, 1 + search.most_looks // size)
        return options

    def members() -> Iterator[list[_relax.SearchOptions]]:
        name = stage.prover.heuristic or heuristic
        for names in AUTOMATIC if name == PORTFOLIO else ((name,),):
            yield [options_of(stage.prover, names)]
        if stage.finders:
            yield [
                options_of(finder, (finder.heuristic or (GREEDY if heuristic == PORTFOLIO else heuristic),))
                for finder in stage.finders
                if not ((finder.in_sequence or finder.when_due) and grounding.handle.is_totally_ordered)
            ]

    portfolio = _relax.SearchOptions()
    portfolio.algorithm = _relax.SearchAlgorithm.Portfolio
    portfolio.members = list(members())
    return portfolio.members[0][0] if len(portfolio.members) == 1 else portfolio
