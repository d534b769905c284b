"""How a planning run ended."""

from __future__ import annotations

from enum import StrEnum


class Status(StrEnum):
    """How a planning run ended; the values are those of `--json`."""

    OPTIMAL = "optimal"
    """A plan was found and no better one exists."""
    SOLVED = "solved"
    """A plan was found; `lower_bound` says how much better another one could be."""
    UNSOLVABLE = "unsolvable"
    """It is proven that there is no plan."""
    EXHAUSTED = "exhausted"
    """An incomplete search ended without a plan; there may be one."""
    TIME_LIMIT = "time-limit"
    MEMORY_LIMIT = "memory-limit"
    INTERRUPTED = "interrupted"
