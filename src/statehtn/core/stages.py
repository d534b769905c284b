"""The searches by name, and the stages that each goes through."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType

import statehtn._relax as _relax


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
