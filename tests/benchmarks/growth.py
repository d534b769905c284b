"""How time and memory of the optimal search grow with the size of the problem.

Usage: python -m tests.benchmarks.growth RUNS.csv [--markdown FILE.md] [--plot FILE ...]

The runs are a table of `statehtn compare`; its domains are the families (`growth.toml` is a suite of two), and of a run
that was repeated, that of median time counts. Size is the number of ground actions and methods. A power of the size is
fitted to the seconds, the generated nodes, and the memory beyond that of the smallest process: least squares on
logarithms, over the problems that are solved and take at least 0.1 ms, or 1 MB; the system does not tell less. Prints a
table of the problems and one of the exponents; each --plot is an image, its kind told by its ending (.svg, .png).
"""

from __future__ import annotations

import argparse
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from tests.benchmarks.records import Row, least_memory_mb, read_runs
from tests.benchmarks.tables import figure, machine, table

LEAST_POINTS = 3  # that an exponent is fitted to


@dataclass(frozen=True)
class Measure:
    """What grows: how a row tells it, and the least of it that counts."""

    name: str
    least: float
    of: Callable[[Row], float | None]


MEASURES = (
    Measure("seconds of search", 1e-4, lambda row: row.search_seconds),
    Measure("generated nodes", 1, lambda row: row.generated),
    Measure("MB of search", 1.0, lambda row: row.peak_memory_mb),
)


@dataclass(frozen=True)
class Fit:
    """`factor * size ** exponent`, and the part of the variance of the logarithms that it explains."""

    exponent: float
    factor: float
    explained: float
    points: int


def size_of(row: Row) -> int | None:
    """Return the number of ground actions and methods; None where grounding did not end."""
    return None if row.actions is None or row.methods is None else row.actions + row.methods


def points(rows: list[Row], what: Measure) -> list[tuple[int, float]]:
    """Return size and value of the solved problems that count, by size."""
    pairs = ((size_of(row), what.of(row)) for row in rows if row.solved)
    return sorted((size, value) for size, value in pairs if size and value is not None and value >= what.least)


def fit(found: list[tuple[int, float]]) -> Fit | None:
    """Fit a power of the size by least squares on logarithms; None for too few points or a single size."""
    if len(found) < LEAST_POINTS or len({size for size, _ in found}) < 2:
        return None
    x, y = np.log(np.array(found, dtype=float)).T
    exponent, offset = np.polyfit(x, y, 1)
    spread = ((y - y.mean()) ** 2).sum()
    explained = 1 - ((y - exponent * x - offset) ** 2).sum() / spread if spread else 1.0
    return Fit(float(exponent), float(np.exp(offset)), float(explained), len(found))


def families(rows: list[Row]) -> dict[str, list[Row]]:
    """Return the rows by domain, with the memory beyond that of the smallest process."""
    base_mb = least_memory_mb([row.peak_memory_mb for row in rows])
    found: dict[str, list[Row]] = {}
    for row in rows:
        memory = None if row.peak_memory_mb is None else row.peak_memory_mb - base_mb
        found.setdefault(row.domain, []).append(replace(row, peak_memory_mb=memory))
    return found


def exponent_table(found: dict[str, list[Row]]) -> Iterator[str]:
    """Yield a table of the fitted exponents."""
    header = ("family", "of", "exponent", "problems", "variance explained")

    def lines() -> Iterator[tuple[str, ...]]:
        for name, rows in found.items():
            for what in MEASURES:
                known = points(rows, what)
                fitted = fit(known)
                figures = (f"{fitted.exponent:.2f}", str(fitted.points), f"{fitted.explained:.0%}") if fitted else None
                yield (name, what.name, *(figures or ("too few problems", str(len(known)), "")))

    yield from table(header, lines())


def problem_table(found: dict[str, list[Row]]) -> Iterator[str]:
    """Yield a table of the problems."""
    header = ("family", "problem", "actions and methods", "", "s", "MB", "expanded", "generated")
    rows = [row for family in found.values() for row in sorted(family, key=lambda row: size_of(row) or 0)]
    yield from table(header, map(_problem, rows))


def _problem(row: Row) -> tuple[str, ...]:
    effort = figure(row.search_seconds, ".4f"), figure(row.peak_memory_mb, ".1f")
    nodes = figure(row.expanded, "d"), figure(row.generated, "d")
    return (row.domain, row.problem, figure(size_of(row), "d"), row.status, *effort, *nodes)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("runs", type=Path, metavar="RUNS.csv")
    parser.add_argument("--markdown", type=Path, help="write the tables there as Markdown")
    parser.add_argument("--plot", type=Path, nargs="*", default=[], help="draw the figure there")
    options = parser.parse_args()
    found = families(read_runs(options.runs))
    exponents, problems = "\n".join(exponent_table(found)), "\n".join(problem_table(found))
    print(f"{exponents}\n\n{problems}")
    if options.markdown:
        text = f"# Growth: figures\n\n{machine()}.\n\n{exponents}\n\n{problems}\n"
        options.markdown.write_text(text, encoding="utf-8")
    if options.plot:
        from tests.benchmarks.growth_plot import draw

        draw(found, options.plot)


if __name__ == "__main__":
    main()
