"""How a planning run ended."""

from __future__ import annotations

import warnings
from enum import EnumType, StrEnum


class _OldNames(EnumType):
    def __getattr__(cls, name: str) -> Status:
        if name == "EXHAUSTED":
            warnings.warn("EXHAUSTED is Status.GAVE_UP now", DeprecationWarning, stacklevel=2)
            return Status.GAVE_UP
        raise AttributeError(name)


class Status(StrEnum, metaclass=_OldNames):
    """How a planning run ended; the values are those of `--json`."""

    OPTIMAL = "optimal"
    """A plan was found and no better one exists."""
    SOLVED = "solved"
    """A plan was found; `lower_bound` says how much better another one could be."""
    UNSOLVABLE = "unsolvable"
    """It is proven that there is no plan."""
    GAVE_UP = "exhausted"
    """An incomplete search ended without a plan; there may be one."""
    TIME_LIMIT = "time-limit"
    MEMORY_LIMIT = "memory-limit"
    INTERRUPTED = "interrupted"
