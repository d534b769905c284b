"""What the reports read of a table that `statehtn compare` has written."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from tests.benchmarks.tables import read_rows

COMPLETE = "state auto"


@dataclass(frozen=True)
class Row:
    """A run: seconds, MB (10^6 bytes), costs in the domain's unit; the columns are those of `docs/compare.md`."""

    domain: str
    problem: str
    solver: str
    heuristic: str
    status: str
    risk_cost: float | None = None
    actions: int | None = None
    methods: int | None = None
    expanded: int | None = None
    generated: int | None = None
    evaluated: int | None = None
    parse_seconds: float | None = None
    ground_seconds: float | None = None
    search_seconds: float | None = None
    peak_memory_mb: float | None = None

    @property
    def name(self) -> str:
        return f"{self.domain} {self.problem}"

    @property
    def configuration(self) -> str:
        """Solver and heuristic, such as `state without endings auto`."""
        return f"{self.solver} {self.heuristic}"

    @property
    def solved(self) -> bool:
        return self.status in ("optimal", "unsolvable")

    @property
    def seconds(self) -> float:
        """Of reading, grounding and search."""
        return sum(phase or 0.0 for phase in (self.parse_seconds, self.ground_seconds, self.search_seconds))


def read_runs(path: Path) -> list[Row]:
    """Return the runs of a table; of one that was repeated, that of median time."""
    repeats: dict[tuple[str, str], list[Row]] = {}
    for row in read_rows(Row, path):
        repeats.setdefault((row.configuration, row.name), []).append(row)
    return [sorted(rows, key=lambda row: row.search_seconds or 0.0)[len(rows) // 2] for rows in repeats.values()]


def least_memory_mb(memory: list[float | None]) -> float:
    """Return the least peak of memory: about what a process takes without any search."""
    return min((one for one in memory if one is not None), default=0.0)
