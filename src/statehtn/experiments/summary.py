"""The table at the end of a comparison: what has come of the runs, by domain and settings."""

from __future__ import annotations

import statistics
from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from statehtn.experiments.records import Row
from statehtn.model.status import Status

SETTINGS = ("objective", "keep", "solver", "heuristic")
_WORDS = {"keep": "keep "}
"""Before what is in a column, where that is only numbers."""
SOLVED = (Status.OPTIMAL, Status.SOLVED)
NO_PLAN = (Status.UNSOLVABLE, Status.GAVE_UP)
LIMITS = (Status.TIME_LIMIT, Status.MEMORY_LIMIT, "killed")


@dataclass(frozen=True, slots=True)
class Summary:
    """What has come of some runs; times in seconds, medians None where there is nothing to take them of.

    Args:
        domain: the runs' domain.
        settings: objective, budgets to keep, solver and heuristic.
        runs: how many; each is either in `solved`, `no_plan`, `limits` or `errors`.
        grounded: runs that got as far as the search.
        optimal: runs whose plan is proven optimal; they are in `solved`, too.
        preparation: the median of reading and grounding, over the grounded.
        search: the median of the search, over the solved.
        total: the sum of all phases, over all.
    """

    domain: str
    settings: str
    runs: int
    grounded: int
    solved: int
    optimal: int
    no_plan: int
    limits: int
    errors: int
    preparation: float | None
    search: float | None
    total: float


def summarise(rows: Sequence[Row]) -> list[Summary]:
    """Return a summary for each domain and settings, in the order of their names; what differs nowhere is left out."""
    groups: dict[tuple[str, str], list[Row]] = {}
    for row in rows:
        settings = " ".join(_WORDS.get(column, "") + row[column] for column in SETTINGS if row[column])
        groups.setdefault((row["domain"], settings), []).append(row)
    return [summary_of(group, *name) for name, group in sorted(groups.items())]


def summary_of(rows: Sequence[Row], domain: str, settings: str) -> Summary:
    """Return the summary of all these rows together, under this name."""
    statuses = Counter(row["status"] for row in rows)
    solved = sum(statuses[status] for status in SOLVED)
    no_plan = sum(statuses[status] for status in NO_PLAN)
    limits = sum(statuses[status] for status in LIMITS)
    grounded = [row for row in rows if row["facts"]]
    return Summary(
        domain=domain,
        settings=settings,
        runs=len(rows),
        grounded=len(grounded),
        solved=solved,
        optimal=statuses[Status.OPTIMAL],
        no_plan=no_plan,
        limits=limits,
        errors=len(rows) - solved - no_plan - limits,
        preparation=_median(_seconds(row, "parse", "ground") for row in grounded),
        search=_median(_seconds(row, "search") for row in rows if row["status"] in SOLVED),
        total=sum(_seconds(row, "parse", "ground", "search") for row in rows),
    )


def _seconds(row: Row, *phases: str) -> float:
    return sum(float(row[f"{phase}_seconds"] or 0) for phase in phases)


def _median(values: Iterable[float]) -> float | None:
    known = list(values)
    return statistics.median(known) if known else None
