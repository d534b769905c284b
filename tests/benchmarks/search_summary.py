"""What the rows of `tests.benchmarks.search` come to, beside another planner's figures."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator

from tests.benchmarks.search_case import Row
from tests.benchmarks.tables import figure, geometric_mean, section, table

HARD = 0.5  # seconds of the baseline from which times are compared
FLOORS = (HARD, 0.1, 0.01)
SLOWER = 0.1  # seconds by which a search may be slower and not be named
SHORTEST = 1e-4  # seconds; what is shorter is not told apart
MANY = 100_000  # nodes from which bytes per node mean something


def times_as_fast(row: Row) -> float:
    """Return how many times as fast as the baseline the search is; both must have solved the problem."""
    assert row.baseline_seconds is not None
    assert row.search_seconds is not None
    return max(row.baseline_seconds, SHORTEST) / max(row.search_seconds, SHORTEST)


def solved_by_both(rows: Iterable[Row], floor: float = 0.0) -> list[Row]:
    """Return the rows that both have solved, and the baseline in no less than `floor` seconds."""
    return [row for row in rows if row.solved and row.baseline_seconds is not None and row.baseline_seconds >= floor]


def bytes_per_node(row: Row) -> float | None:
    """Return what a generated node takes on average; None where there are too few."""
    if row.generated is None or row.generated < MANY or row.search_memory_mb is None:
        return None
    return row.search_memory_mb * 1e6 / row.generated


def baseline_bytes_per_node(row: Row, base_mb: float) -> float | None:
    """Return the same of the baseline, whose process takes `base_mb` without any node."""
    if row.baseline_generated is None or row.baseline_generated < MANY or row.baseline_memory_mb is None:
        return None
    return (row.baseline_memory_mb - base_mb) * 1e6 / row.baseline_generated


def ratios_of_bytes(rows: list[Row]) -> list[float]:
    """Return our bytes per node as parts of the baseline's, where both have many nodes.

    Its least memory of any problem stands for what its process takes without any node.
    """
    base_mb = min((row.baseline_memory_mb for row in rows if row.baseline_memory_mb is not None), default=0.0)
    pairs = ((bytes_per_node(row), baseline_bytes_per_node(row, base_mb)) for row in rows)
    return [ours / theirs for ours, theirs in pairs if ours and theirs]


def summary(rows: list[Row], markdown: bool) -> Iterator[str]:
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
    wrong = (f"{row.name}: {row.cost}, baseline {row.baseline_cost}" for row in both if row.cost != row.baseline_cost)
    yield from section("Another optimal cost", wrong, markdown)
    slower = (row for row in both if (row.search_seconds or 0) > (row.baseline_seconds or 0) + SLOWER)
    lines = (f"{row.name}: {row.search_seconds:.2f} s, baseline {row.baseline_seconds:.2f} s" for row in slower)
    yield from section(f"Slower by more than {SLOWER:g} s", lines, markdown)
    missing = (row for row in rows if not row.solved)
    lines = (f"{row.name}: {row.status}{row.message and ' '}{row.message}, baseline {_seconds(row)}" for row in missing)
    yield from section("Not proven", lines, markdown)


def _seconds(row: Row) -> str:
    return "neither" if row.baseline_seconds is None else f"{row.baseline_seconds:.2f} s"


def domain_table(rows: list[Row]) -> Iterator[str]:
    """Yield a table of times with a line for each domain: ours, the baseline's and their ratio."""
    hard, easy = f"times as fast from {HARD:g} s", f"from {FLOORS[-1]:g} s"
    header = ("domain", "proven", "baseline", hard, easy, "hardest both solve", "s", "baseline s", "ratio")
    yield from table(header, [*_by_domain(rows, _times), _times("**all**", rows)])


def _times(name: str, rows: list[Row]) -> tuple[str, ...]:
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


def effort_table(rows: list[Row], bandwidth: float) -> Iterator[str]:
    """Yield a table of effort with a line for each domain: of the problem with the most evaluations.

    `bandwidth`: bytes per second that one core reads from memory.
    """
    header = ("domain", "problem", "expanded", "generated", "evaluated", "cuts/evaluation", "bytes/node")
    times = ("ns/evaluation", "ns to read the model", "ratio")

    def line(name: str, own: list[Row]) -> tuple[str, ...]:
        row = max(own, key=lambda row: row.evaluated or 0)
        if not row.evaluated or row.search_seconds is None:
            return (name, row.problem, *[""] * (len(header) + len(times) - 2))
        counts = (str(count) for count in (row.expanded, row.generated, row.evaluated))
        cuts = figure((row.cuts or 0) / row.evaluated, ".1f")
        evaluation = row.search_seconds * 1e9 / row.evaluated
        floor = (row.model_bytes or 0) * 1e9 / bandwidth
        ratio = f"{evaluation / floor:.1f}" if floor else ""
        memory = figure(bytes_per_node(row), ".0f")
        return (name, row.problem, *counts, cuts, memory, f"{evaluation:.0f}", f"{floor:.0f}", ratio)

    yield from table((*header, *times), _by_domain(rows, line))


def _by_domain(rows: list[Row], line: Callable[[str, list[Row]], tuple[str, ...]]) -> Iterator[tuple[str, ...]]:
    for domain in dict.fromkeys(row.domain for row in rows):
        yield line(domain, [row for row in rows if row.domain == domain])
