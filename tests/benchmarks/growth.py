"""How time and memory of the optimal search grow with the size of the problem.

Usage: python -m tests.benchmarks.growth [--root DIR] [--most-seconds S] [--output FILE.csv] [--markdown FILE.md]
           [--plot FILE ...] [--repeat N] [--jobs N]

Size is the number of ground actions and methods. Three families: this project's satellites with 3 to 10 observations, 1
satellite and 3 modes; its vehicles P1 to P9; and, where --root or STATEHTN_IPC names the folder of the competition's
benchmarks, Transport in total order. Every search has --most-seconds (60 if not told) after reading and grounding.

Every search is run --repeat times (3 if not told); the run of median time counts. A power of the size is fitted to the
seconds, the generated nodes, and the memory that a search takes beyond the ground problem: least squares on logarithms,
over the problems that are solved and take at least 0.1 ms, or 1 MB; the system does not tell less. Prints a table of
the problems and one of the exponents; each --plot is an image, its kind told by its ending (.svg, .png).
"""

from __future__ import annotations

import argparse
import csv
import os
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from dataclasses import asdict, dataclass, fields
from pathlib import Path

import numpy as np

from tests.benchmarks.search_case import Case, Row, measure
from tests.benchmarks.tables import figure, machine, table

DOMAINS = Path(__file__).resolve().parents[2] / "domains"
OBSERVATIONS = range(3, 11)
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
    Measure("MB of search", 1.0, lambda row: row.search_memory_mb),
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


def families(root: Path | None) -> Iterator[tuple[str, Path, list[Path]]]:
    """Yield the name, the domain and the problems of every family."""
    satellite = DOMAINS / "satellite"
    names = [f"RA-{count}obs-1sat-3mod.hddl" for count in OBSERVATIONS]
    places = [
        next(folder / name for folder in (satellite, satellite / "large") if (folder / name).exists()) for name in names
    ]
    yield "Satellite", satellite / "domain.hddl", places
    vehicle = DOMAINS / "av"
    yield "Vehicle", vehicle / "domain.hddl", sorted(vehicle.glob("p*.hddl"))
    if root is not None:
        transport = root / "total-order" / "Transport"
        yield "Transport", transport / "domain.hddl", sorted(transport.glob("pfile*.hddl"))


def run_all(options: argparse.Namespace) -> dict[str, list[Row]]:
    """Measure every problem, write and show each as it ends; rows by family."""
    cases = [(name, domain, one) for name, domain, problems in families(options.root) for one in problems]
    found: dict[str, list[Row]] = {name: [] for name, _, _ in cases}

    def run(case: tuple[str, Path, Path]) -> Row:
        name, domain, problem = case
        search = Case(str(domain), str(problem), options.most_seconds)
        rows = [Row(name, problem.stem, **measure(search)) for _ in range(options.repeat)]
        return sorted(rows, key=lambda row: row.search_seconds or 0.0)[len(rows) // 2]

    with (
        open(options.output or os.devnull, "w", newline="", encoding="utf-8") as file,
        ThreadPoolExecutor(options.jobs) as pool,
    ):
        writer = csv.DictWriter(file, [field.name for field in fields(Row)])
        writer.writeheader()
        for row in pool.map(run, cases):
            found[row.domain].append(row)
            writer.writerow(asdict(row))
            file.flush()
            print(f"{row.name:<40} {row.status:<12} {figure(row.search_seconds, '.3f'):>8} s", flush=True)
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
    effort = figure(row.search_seconds, ".4f"), figure(row.search_memory_mb, ".1f")
    nodes = figure(row.expanded, "d"), figure(row.generated, "d")
    return (row.domain, row.problem, figure(size_of(row), "d"), row.status, *effort, *nodes)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--root", type=Path, default=os.environ.get("STATEHTN_IPC") or None)
    parser.add_argument("--most-seconds", type=float, default=60.0)
    parser.add_argument("--output", type=Path, help="write a line of CSV for each problem as soon as it is done")
    parser.add_argument("--markdown", type=Path, help="write the tables there as Markdown")
    parser.add_argument("--plot", type=Path, nargs="*", default=[], help="draw the figure there")
    parser.add_argument("--repeat", type=int, default=3)
    parser.add_argument("--jobs", type=int, default=1)
    options = parser.parse_args()
    found = run_all(options)
    exponents, problems = "\n".join(exponent_table(found)), "\n".join(problem_table(found))
    print(f"\n{exponents}\n\n{problems}")
    if options.markdown:
        limit = f"At most {options.most_seconds:g} s for each search, median of {options.repeat}."
        head = f"# Growth: figures\n\n{machine()}. {limit}"
        options.markdown.write_text(f"{head}\n\n{exponents}\n\n{problems}\n", encoding="utf-8")
    if options.plot:
        from tests.benchmarks.growth_plot import draw

        draw(found, options.plot)


if __name__ == "__main__":
    main()
