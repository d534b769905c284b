"""What a search tells while it goes on."""

from __future__ import annotations

from dataclasses import dataclass

from statehtn.effort import SearchEffort


@dataclass(frozen=True, slots=True)
class SearchProgress:
    """How far any search has come.

    Args:
        seconds: since the search began.
        effort: the nodes that it has dealt with.
        lower_bound: what it has proven by now, in the objective's unit; None for nothing.
    """

    seconds: float
    effort: SearchEffort
    lower_bound: float | None

    @property
    def expanded(self) -> int:
        """Nodes whose successors were generated."""
        return self.effort.expanded

    @property
    def generated(self) -> int:
        """Nodes that were made."""
        return self.effort.generated

    @property
    def evaluated(self) -> int:
        """Nodes that the heuristic was asked about."""
        return self.effort.evaluated


@dataclass(frozen=True, slots=True)
class Progress(SearchProgress):
    """How far a search has come.

    Args:
        seconds: since the search began.
        effort: the nodes that it has dealt with.
        lower_bound: no plan has a lower value, in the objective's unit; None where none is known.
        best: the value of the best plan so far; None where there is none.
    """

    best: float | None


@dataclass(frozen=True, slots=True)
class TopProgress(SearchProgress):
    """How far a search for several plans has come.

    Args:
        seconds: since the search began.
        effort: the nodes that it has dealt with.
        lower_bound: all plans of a lower value, in the objective's unit, are among those found; None for unknown.
        found: how many plans it knows.
        proven: the first so many of them are the best there are.
    """

    found: int
    proven: int
