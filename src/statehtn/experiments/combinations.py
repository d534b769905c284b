"""Which heuristics and searches go with which solver: a grid leaves out what does not exist."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType

from statehtn.core.heuristics import HEURISTICS
from statehtn.core.search import SEARCHES


@dataclass(frozen=True, slots=True)
class Choices:
    """The heuristics and the searches that a solver takes, in all combinations."""

    heuristics: Sequence[str]
    searches: Sequence[str]

    def __str__(self) -> str:
        heuristics, searches = (
            f"{kind} {' or '.join(map(repr, names))}"
            for kind, names in (("the heuristic", self.heuristics), ("the search", self.searches))
        )
        return f"{heuristics} and {searches}"


CHOICES: Mapping[str, Choices] = MappingProxyType(
    {
        "state": Choices(tuple(HEURISTICS), tuple(SEARCHES)),
        "plan": Choices(("tdg", "blind"), ("astar",)),
    }
)
"""What each solver takes; the planner refuses everything else (`Query.of`)."""


def exists(solver: str, heuristic: str | None, search: str) -> bool:
    """Tell whether a solver takes a heuristic, None for its own, with a search; a solver not listed takes any."""
    choices = CHOICES.get(solver)
    return choices is None or (search in choices.searches and (heuristic is None or heuristic in choices.heuristics))
