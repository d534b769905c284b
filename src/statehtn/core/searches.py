"""The searches by name: the heuristics that each takes, and the stages that it goes through."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType

import statehtn._relax as _relax
from statehtn.core.grounding import Grounding
from statehtn.core.heuristics import ADMISSIBLE, GREEDY, HEURISTICS, PORTFOLIO
from statehtn.core.switches import ProgressionSwitches, SearchSwitches, set_switches


@dataclass(frozen=True, slots=True)
class Prover:
    """A search that proves something: A*, or weighted A*; heuristic and weight are the user's where they are None."""

    heuristic: str | None = None
    weight: float | None = 1.0


@dataclass(frozen=True, slots=True)
class Finder:
    """A greedy search for any plan; the heuristic is the user's where it is None.

    It gives up after `most_evaluations`, or once it has looked at so many actions and methods (`most_looks`;
    evaluations take the longer, the more there are). `explores`: whether every other node is one at random.
    `in_sequence`: tasks without an order are done in that of the domain, one after the other, which leaves out plans.
    `when_due`: methods that begin with an action, or a condition, are not chosen until it can be executed.
    """

    heuristic: str | None = None
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

    prover: Prover
    finders: tuple[Finder, ...] = ()


AUTOMATIC = (("tdg",), ("lmcut",), ("potential-hmax", "potential", "lmcut"))
"""The heuristics of the three searches in turn that `auto` stands for; each asks its own one after the other."""


def _greedy(heuristic: str | None = None) -> tuple[Finder, ...]:
    """Return the stages of a greedy search: by the heuristic, by the decomposition graph alone, and so on for longer.

    Where ground problems are huge, the decomposition graph leads to plans in the time of a few evaluations. Where tasks
    have no order, finishing one before the next is begun often does, and takes little to try.
    """
    return (
        Finder(heuristic, 5_000, 5_000_000, explores=False, in_sequence=True),
        Finder("tdg", 20_000, in_sequence=True),
        Finder(heuristic, 5_000, 5_000_000, explores=False, when_due=True),
        Finder(heuristic, 20_000, 12_000_000, explores=False),
        Finder("tdg", 60_000),
        Finder(heuristic, 150_000, 120_000_000),
        Finder("tdg", 300_000),
        Finder(heuristic),
    )


SEARCHES: Mapping[str, tuple[Stage, ...]] = MappingProxyType(
    {
        "astar": (Stage(Prover()),),
        "weighted": (Stage(Prover(weight=None)),),
        "greedy": (Stage(Prover(PORTFOLIO), _greedy()),),
        # A plan soon, then better ones: each stage looks only for plans that are better than the best one so far.
        "anytime": (
            Stage(Prover(), _greedy(GREEDY)),
            Stage(Prover(weight=4.0)),
            Stage(Prover(weight=2.0)),
            Stage(Prover()),
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
) -> _relax.FindPlansOptions | _relax.PortfolioOptions:
    """Return what the core is asked for in a stage: a search, or a portfolio of several.

    Args:
        stage: the stage.
        grounding: the problem; its size counts for `most_looks`.
        heuristic: the user's, or `PORTFOLIO`.
        weight: the user's.
        switches: refinements to leave out.
    """
    size = max(1, grounding.handle.action_count + grounding.handle.method_count)
    is_ordered = grounding.handle.is_totally_ordered

    def proving(names: Sequence[str]) -> _relax.FindPlansOptions:
        options = _relax.FindPlansOptions()
        options.heuristics = names
        options.weight = weight if stage.prover.weight is None else stage.prover.weight
        set_switches(options, switches)
        return options

    def finding(finder: Finder) -> _relax.GreedyOptions:
        options = _relax.GreedyOptions()
        options.heuristic = finder.heuristic or (GREEDY if heuristic == PORTFOLIO else heuristic)
        options.explores = finder.explores
        options.in_sequence = finder.in_sequence
        options.when_due = finder.when_due
        options.most_evaluations = finder.most_evaluations
        if finder.most_looks is not None:
            options.most_evaluations = min(finder.most_evaluations or finder.most_looks, 1 + finder.most_looks // size)
        set_switches(options, switches, ProgressionSwitches)
        return options

    name = stage.prover.heuristic or heuristic
    provers = [proving(names) for names in (AUTOMATIC if name == PORTFOLIO else ((name,),))]
    finders = [finding(one) for one in stage.finders if not ((one.in_sequence or one.when_due) and is_ordered)]
    if len(provers) == 1 and not finders:
        return provers[0]
    portfolio = _relax.PortfolioOptions()
    portfolio.members = [*([prover] for prover in provers), *([finders] if finders else [])]
    return portfolio
