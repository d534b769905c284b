"""What a search tells while it goes on."""

from __future__ import annotations

from dataclasses import dataclass


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
