"""What a run has cost in work, time and memory."""

from __future__ import annotations

import sys
from dataclasses import dataclass

from statehtn.counted import counted


@dataclass(frozen=True, slots=True)
class Statistics:
    """The effort of a run; None for phases that it did not reach. Times are in seconds, memory in MB."""

    expanded: int | None = None
    generated: int | None = None
    evaluated: int | None = None
    dead_ends: int | None = None
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
    def sizes(self) -> str:
        """What was grounded in words, such as `2 facts, 1 action, 1 task, 2 methods`; empty where nothing was."""
        numbers = {"fact": self.facts, "action": self.actions, "task": self.tasks, "method": self.methods}
        return ", ".join(counted(number, noun) for noun, number in numbers.items() if number is not None)


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
