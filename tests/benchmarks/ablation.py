"""Search without one refinement at a time, to see what each is worth.

Usage: python -m tests.benchmarks.ablation --root DIR --baseline FILE.csv [--output FOLDER] [--markdown FILE.md]
           [--only TEXT] [--variant TEXT] [--jobs N] [--resume]

First the complete configuration solves the problems of the baseline, as `tests.benchmarks.search` does, with 5 s for
each search. Those that it solves in 5 ms to 5 s are what is compared: shorter ones tell nothing, longer ones take too
long. Then it is run on each of them again, and so is every variant: one field of `SearchSwitches` turned off, or one
admissible heuristic alone instead of `auto`. A variant has a second and 20 times as long as the complete configuration
took.

Prints a table: problems solved; the geometric mean of how many times as long the variant takes (where it does not solve
a problem, the time that it had, so the mean is too low), and of how many times as many nodes it expands where it solves
the problem. The folder --output gets the rows of every variant as CSV. A variant that finds another optimal cost is
named, and the exit code is 1.
"""

from __future__ import annotations

import argparse
from collections.abc import Iterator
from dataclasses import dataclass, fields
from pathlib import Path

from statehtn.core.heuristics import HEURISTICS, PORTFOLIO
from statehtn.core.switches import SearchSwitches
from tests.benchmarks.search import Line, arguments, name_of, read_baseline, run_all
from tests.benchmarks.search_case import Row
from tests.benchmarks.search_summary import SHORTEST
from tests.benchmarks.tables import geometric_mean, machine, section, table

LEAST_SECONDS = 0.005
MOST_SECONDS = 5.0
TIMES_AS_LONG = 20


@dataclass(frozen=True)
class Variant:
    """A configuration of the search, by the arguments of `tests.benchmarks.search`."""

    name: str
    heuristic: str = PORTFOLIO
    without: tuple[str, ...] = ()


COMPLETE = Variant("complete")


def variants() -> Iterator[Variant]:
    """Yield the complete configuration, and every one that lacks one thing."""
    yield COMPLETE
    for field in fields(SearchSwitches):
        yield Variant(f"without {field.name}", without=(field.name,))
    for name, info in HEURISTICS.items():
        if info.admissible:
            yield Variant(f"{name} alone", heuristic=name)


def run_variant(
    variant: Variant, name: str, lines: list[Line], options: argparse.Namespace, resume: bool = False
) -> list[Row]:
    """Measure a variant; its rows are kept under the name. Returns what is kept there already, too, to `resume`."""
    print(f"{name:<28} ", end="", flush=True)
    output = options.output and options.output / f"{name.replace(' ', '-')}.csv"
    settings = {"output": output, "heuristic": variant.heuristic, "without": variant.without, "resume": resume}
    return run_all(lines, argparse.Namespace(**vars(options) | settings | {"most_seconds": float("inf")}))


def run_variants(wanted: list[Variant], lines: list[Line], options: argparse.Namespace) -> dict[str, list[Row]]:
    """Measure every variant on one problem after the other: machines are not equally fast all the time."""
    found: dict[str, dict[str, Row]] = {one.name: {} for one in wanted}
    for index, line in enumerate(lines):
        for one in wanted:
            rows = run_variant(one, one.name, [line], options, resume=options.resume or index > 0)
            found[one.name] |= {row.name: row for row in rows}
    return {name: list(rows.values()) for name, rows in found.items()}


def choose(lines: list[Line], rows: list[Row]) -> list[Line]:
    """Return the lines of the problems to compare, each with its limit for the variants."""
    seconds = {row.name: row.search_seconds for row in rows if row.solved and row.search_seconds is not None}
    chosen = []
    for line in lines:
        taken = seconds.get(name_of(line))
        if taken is not None and LEAST_SECONDS <= taken <= MOST_SECONDS:
            chosen.append(line | {"engine_limit": str(1 + TIMES_AS_LONG * taken)})
    return chosen


def ablation_table(found: dict[str, list[Row]], limits: dict[str, float]) -> Iterator[str]:
    """Yield the table. `found`: rows by variant; `limits`: seconds that a variant had, by problem."""
    complete = {row.name: row for row in found[COMPLETE.name] if row.solved}

    def line(variant: str, rows: list[Row]) -> tuple[str, ...]:
        pairs = [(row, complete[row.name]) for row in rows if row.name in complete]
        solved = [(row, other) for row, other in pairs if row.solved]
        times = [seconds(row, limits) / seconds(other, limits) for row, other in pairs]
        nodes = [max(row.expanded or 0, 1) / max(other.expanded or 0, 1) for row, other in solved]
        slower = sum(ratio > 2 for ratio in times)
        means = (f"{geometric_mean(ratios):.2f}" if ratios else "" for ratios in (times, nodes))
        return (variant, f"{len(solved)}/{len(pairs)}", *means, str(slower), str(sum(ratio < 0.5 for ratio in times)))

    header = ("configuration", "solved", "times as long", "times as many expanded", "over twice as long", "under half")
    yield from table(header, (line(variant, rows) for variant, rows in found.items()))


def seconds(row: Row, limits: dict[str, float]) -> float:
    """Return how long the search took; the limit where it did not end."""
    taken = row.search_seconds if row.solved else limits[row.name]
    return max(taken or 0.0, SHORTEST)


def other_costs(found: dict[str, list[Row]]) -> list[str]:
    """Name the variants and problems whose optimal cost is not the complete configuration's."""
    costs = {row.name: row.cost for row in found[COMPLETE.name] if row.solved}
    return [
        f"{variant}: {row.name}: {row.cost}, not {costs[row.name]}"
        for variant, rows in found.items()
        for row in rows
        if row.solved and row.name in costs and row.cost != costs[row.name]
    ]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments(parser)
    parser.add_argument("--output", type=Path, metavar="FOLDER", help="write the rows of every variant there as CSV")
    parser.add_argument(
        "--variant", default="", help="only variants whose name contains this text, and the complete one"
    )
    options = parser.parse_args()
    if options.root is None:
        parser.error("name the folder of the benchmarks by --root or STATEHTN_IPC")
    if options.output:
        options.output.mkdir(parents=True, exist_ok=True)
    lines = [line | {"engine_limit": str(MOST_SECONDS)} for line in read_baseline(options)]
    chosen = choose(lines, run_variant(COMPLETE, "choice", lines, options, options.resume))
    if not chosen:
        parser.error(f"no problem takes the complete configuration between {LEAST_SECONDS:g} and {MOST_SECONDS:g} s")
    wanted = [one for one in variants() if one == COMPLETE or options.variant in one.name]
    found = run_variants(wanted, chosen, options)
    limits = {name_of(line): float(line["engine_limit"]) for line in chosen}
    wrong = other_costs(found)
    text = "\n".join(ablation_table(found, limits))
    print(f"\n{text}\n" + "\n".join(section("Another optimal cost", wrong, markdown=False)))
    if options.markdown:
        only = f" (only {options.only})" if options.only else ""
        chosen_text = (
            f"{len(chosen)} problems that take the complete configuration {LEAST_SECONDS:g} to {MOST_SECONDS:g} s"
        )
        other = "\n".join(section("Another optimal cost", wrong, markdown=True))
        head = f"# Ablation: figures\n\n{machine()}. {chosen_text}{only}."
        options.markdown.write_text(f"{head}\n\n{text}\n{other}\n", encoding="utf-8")
    raise SystemExit(1 if wrong else 0)


if __name__ == "__main__":
    main()
