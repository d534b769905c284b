"""What optimal searches come to, beside another planner's figures."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass

from tests.benchmarks.records import Row, least_memory_mb
from tests.benchmarks.tables import figure, geometric_mean, section, table

HARD = 0.5  # seconds of the baseline from which times are compared
FLOORS = (HARD, 0.1, 0.01)
SLOWER = 0.1  # seconds by which a search may be slower and not be named
SHORTEST = 1e-4  # seconds; what is shorter is not told apart
MANY = 100_000  # nodes from which bytes per node mean something


@dataclass(frozen=True)
class Compared(Row):
    """A run and what another planner needed for the problem, in the same units; None where it has not solved it."""

    baseline_cost: float | None = None
    baseline_seconds: float | None = None
    baseline_expanded: int | None = None
    baseline_generated: int | None = None
    baseline_memory_mb: float | None = None


def times_as_fast(row: Compared) -> float:
    """Return how many times as fast as the baseline the search is; both must have solved the problem."""
    assert row.baseline_seconds is not None
    assert row.search_seconds is not None
    return max(row.baseline_seconds, SHORTEST) / max(row.search_seconds, SHORTEST)


def solved_by_both(rows: Iterable[Compared], floor: float = 0.0) -> list[Compared]:
    """Return the rows that both have solved, and the baseline in no less than `floor` seconds."""
    return [row for row in rows if row.solved and row.baseline_seconds is not None and row.baseline_seconds >= floor]


def bytes_per_node(generated: int | None, memory_mb: float | None, base_mb: float) -> float | None:
    """Return what a generated node takes on average, in a process of `base_mb` without any; None for too few."""
    if generated is None or generated < MANY or memory_mb is None:
        return None
    return (memory_mb - base_mb) * 1e6 / generated


def ratios_of_bytes(rows: list[Compared]) -> list[float]:
    """Return our bytes per node as parts of the baseline's, where both have many nodes.

    The least memory of any problem stands for what the process takes without any node, on both sides.
    """
    ours, theirs = ([row.peak_memory_mb for row in rows], [row.baseline_memory_mb for row in rows])
    bases = least_memory_mb(ours), least_memory_mb(theirs)
    pairs = (
        (
            bytes_per_node(row.generated, row.peak_memory_mb, bases[0]),
            bytes_per_node(row.baseline_generated, row.baseline_memory_mb, bases[1]),
        )
        for row in rows
    )
    return [own / other for own, other in pairs if own and other]


def summary(rows: list[Compared], markdown: bool) -> Iterator[str]:
    """Yield the lines of the report."""
    bullet = "- " if markdown else ""
    solved = [row for row in rows if row.solved]
    known = [row for row in rows if row.baseline_seconds is not None]
    both = solved_by_both(rows)
    yield f"{bullet}proven optimal: {len(solved)} of {len(rows)}; by the baseline {len(known)}"
    for floor in FLOORS:
        if hard := [times_as_fast(row) for row in solved_by_both(rows, floor)]:
            problems = f"where the baseline needs {floor:g} s ({len(hard)} problems, geometric mean)"
            yield f"{bullet}{geometric_mean(hard):.1f} times as fast {problems}"
    faster = sum(times_as_fast(row) > 1 for row in both)
    yield f"{bullet}faster on {faster} of the {len(both)} that both solve"
    if expanded := [max(row.expanded or 0, 1) / max(row.baseline_expanded or 0, 1) for row in both]:
        yield f"{bullet}{geometric_mean(expanded):.2f} times as many nodes expanded where both solve (geometric mean)"
    if parts := ratios_of_bytes(rows):
        nodes = f"where both generate {MANY:,} nodes ({len(parts)} problems, geometric mean)"
        yield f"{bullet}{geometric_mean(parts):.2f} times as many bytes per node {nodes}"
    wrong = (
        f"{row.name}: {row.risk_cost}, baseline {row.baseline_cost}"
        for row in both
        if row.risk_cost != row.baseline_cost
    )
    yield from section("Another optimal cost", wrong, markdown)
    slower = (row for row in both if (row.search_seconds or 0) > (row.baseline_seconds or 0) + SLOWER)
    lines = (f"{row.name}: {row.search_seconds:.2f} s, baseline {row.baseline_seconds:.2f} s" for row in slower)
    yield from section(f"Slower by more than {SLOWER:g} s", lines, markdown)
    missing = (row for row in rows if not row.solved)
    lines = (f"{row.name}: {row.status}, baseline {_seconds(row)}" for row in missing)
    yield from section("Not proven", lines, markdown)


def _seconds(row: Compared) -> str:
    return "neither" if row.baseline_seconds is None else f"{row.baseline_seconds:.2f} s"


def domain_table(rows: list[Compared]) -> Iterator[str]:
    """Yield a table of times with a line for each domain: ours, the baseline's and their ratio."""
    hard, easy = f"times as fast from {HARD:g} s", f"from {FLOORS[-1]:g} s"
    header = ("domain", "proven", "baseline", hard, easy, "hardest both solve", "s", "baseline s", "ratio")
    yield from table(header, [*_by_domain(rows, _times), _times("**all**", rows)])


def _times(name: str, rows: list[Compared]) -> tuple[str, ...]:
    counts = (
        f"{sum(row.solved for row in rows)}/{len(rows)}",
        str(sum(row.baseline_seconds is not None for row in rows)),
    )
    ratios = [[times_as_fast(row) for row in solved_by_both(rows, floor)] for floor in (HARD, FLOORS[-1])]
    means = [f"{geometric_mean(found):.1f}" if found else "" for found in ratios]
    hardest = max(solved_by_both(rows), key=lambda row: row.baseline_seconds or 0, default=None)
    if hardest is None:
        return (name, *counts, *means, "", "", "", "")
    seconds = f"{hardest.search_seconds:.3f}", f"{hardest.baseline_seconds:.3f}"
    return (name, *counts, *means, hardest.problem, *seconds, f"{times_as_fast(hardest):.1f}")


def effort_table(rows: list[Compared]) -> Iterator[str]:
    """Yield a table of effort with a line for each domain: of the problem with the most evaluations."""
    base_mb = least_memory_mb([row.peak_memory_mb for row in rows])

    def line(name: str, own: list[Compared]) -> tuple[str, ...]:
        row = max(own, key=lambda row: row.evaluated or 0)
        if not row.evaluated or row.search_seconds is None:
            return (name, row.problem, *[""] * 5)
        counts = (str(count) for count in (row.expanded, row.generated, row.evaluated))
        memory = figure(bytes_per_node(row.generated, row.peak_memory_mb, base_mb), ".0f")
        return (name, row.problem, *counts, memory, f"{row.search_seconds * 1e9 / row.evaluated:.0f}")

    header = ("domain", "problem", "expanded", "generated", "evaluated", "bytes/node", "ns/evaluation")
    yield from table(header, _by_domain(rows, line))


def _by_domain(
    rows: list[Compared], line: Callable[[str, list[Compared]], tuple[str, ...]]
) -> Iterator[tuple[str, ...]]:
    for domain in dict.fromkeys(row.domain for row in rows):
        yield line(domain, [row for row in rows if row.domain == domain])
