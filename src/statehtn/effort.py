"""What a run has cost in work, time and memory."""

from __future__ import annotations

import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import astuple, dataclass, replace
from typing import Any

from statehtn.counted import counted


@dataclass(frozen=True, slots=True)
class SearchEffort:
    """The work of a search, or of several together.

    Args:
        expanded: nodes whose successors were generated.
        generated: nodes that were made.
        evaluated: nodes that the heuristic was asked about.
        dead_ends: nodes that were found to lead to no plan.
        cuts: landmark cuts of all evaluations together.
    """

    expanded: int = 0
    generated: int = 0
    evaluated: int = 0
    dead_ends: int = 0
    cuts: int = 0

    def __add__(self, other: SearchEffort) -> SearchEffort:
        """Return the work of both together."""
        return SearchEffort(*(one + more for one, more in zip(astuple(self), astuple(other), strict=True)))


@dataclass(frozen=True, slots=True)
class Statistics:
    """The effort of a run; None for phases that it did not reach. Times are in seconds, memory in MB."""

    search: SearchEffort | None = None
    facts: int | None = None
    actions: int | None = None
    tasks: int | None = None
    methods: int | None = None
    parse_seconds: float | None = None
    ground_seconds: float | None = None
    search_seconds: float | None = None
    validate_seconds: float | None = None
    peak_memory_mb: float | None = None

    @property
    def expanded(self) -> int | None:
        """Nodes whose successors were generated."""
        return None if self.search is None else self.search.expanded

    @property
    def generated(self) -> int | None:
        """Nodes that were made."""
        return None if self.search is None else self.search.generated

    @property
    def evaluated(self) -> int | None:
        """Nodes that the heuristic was asked about."""
        return None if self.search is None else self.search.evaluated

    @property
    def dead_ends(self) -> int | None:
        """Nodes that were found to lead to no plan."""
        return None if self.search is None else self.search.dead_ends

    def and_search(self, other: Statistics) -> Statistics:
        """Return this effort with that of a further search of the same problem."""
        efforts = [one for one in (self.search, other.search) if one is not None]
        return replace(
            self,
            search=sum(efforts, SearchEffort()) if efforts else None,
            search_seconds=(self.search_seconds or 0.0) + (other.search_seconds or 0.0),
            validate_seconds=(self.validate_seconds or 0.0) + (other.validate_seconds or 0.0),
            peak_memory_mb=other.peak_memory_mb,
        )

    @property
    def sizes(self) -> str:
        """What was grounded in words, such as `2 facts, 1 action, 1 task, 2 methods`; empty where nothing was."""
        numbers = {"fact": self.facts, "action": self.actions, "task": self.tasks, "method": self.methods}
        return ", ".join(counted(number, noun) for noun, number in numbers.items() if number is not None)

    def to_dict(self) -> dict[str, Any]:
        """Return the entry `statistics` of the JSON objects."""
        names = ("expanded", "generated", "evaluated", "dead_ends", *self.__slots__[1:])
        return {name: getattr(self, name) for name in names}


class Meter:
    """Collects the statistics of a run while it goes on."""

    def __init__(self) -> None:
        self.statistics = Statistics()

    def note(self, **known: Any) -> None:
        """Take down what has become known, by the names of the statistics."""
        self.statistics = replace(self.statistics, **known)

    @contextmanager
    def timed(self, phase: str) -> Iterator[None]:
        """Add the time that a part of a phase takes to that of the phase, however it ends."""
        start = time.perf_counter()
        try:
            yield
        finally:
            name = f"{phase}_seconds"
            self.note(**{name: (getattr(self.statistics, name) or 0.0) + time.perf_counter() - start})

    def read(self) -> Statistics:
        """Return the statistics up to now."""
        self.note(peak_memory_mb=peak_memory_mb())
        return self.statistics


def peak_memory_mb() -> float | None:
    """Return the highest resident memory of the process so far in MB (10^6 bytes), or None where it is not known."""
    try:
        # Unlike getrusage, this does not count the process that started this one.
        with open("/proc/self/status", encoding="ascii", errors="replace") as file:
            for line in file:
                if line.startswith("VmHWM:"):
                    return int(line.split()[1]) * 1024 / 1e6
    except OSError:
        pass
    try:
        import resource
    except ImportError:
        return None
    unit = 1 if sys.platform == "darwin" else 1024
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * unit / 1e6
