"""What each refinement of the search is worth, by a comparison of the complete search with what lacks one.

Usage: python -m tests.benchmarks.ablation RUNS.csv [--markdown FILE.md]

The runs are those of a suite that `tests.benchmarks.suite --ablation` has made. Prints a table of configurations, over
the problems that the complete one, `state auto`, solves: problems solved; the geometric mean of how many times as long
the search takes (20 times where it does not solve a problem: it had at least that, so the mean is too low), and of how
many times as many nodes it expands where it solves the problem. A configuration that finds another optimal cost is
named, and the exit code is 1.
"""

from __future__ import annotations

import argparse
from collections.abc import Iterator
from pathlib import Path

from tests.benchmarks.records import COMPLETE, Row, read_runs
from tests.benchmarks.search_summary import SHORTEST
from tests.benchmarks.suite import TIMES_AS_LONG
from tests.benchmarks.tables import geometric_mean, machine, section, table


def by_configuration(rows: list[Row]) -> dict[str, list[Row]]:
    """Return the runs of every configuration on the problems that the complete one solves; the complete one first."""
    chosen = {row.name for row in rows if row.configuration == COMPLETE and row.solved}
    found: dict[str, list[Row]] = {COMPLETE: []}
    for row in rows:
        if row.name in chosen:
            found.setdefault(row.configuration, []).append(row)
    return found


def ablation_table(found: dict[str, list[Row]]) -> Iterator[str]:
    """Yield the table."""
    complete = {row.name: row for row in found[COMPLETE]}

    def line(configuration: str, rows: list[Row]) -> tuple[str, ...]:
        pairs = [(row, complete[row.name]) for row in rows]
        solved = [(row, other) for row, other in pairs if row.solved]
        times = [seconds(row) / seconds(other) if row.solved else TIMES_AS_LONG for row, other in pairs]
        nodes = [max(row.expanded or 0, 1) / max(other.expanded or 0, 1) for row, other in solved]
        slower = sum(ratio > 2 for ratio in times)
        means = (f"{geometric_mean(ratios):.2f}" if ratios else "" for ratios in (times, nodes))
        return (configuration, f"{len(solved)}/{len(rows)}", *means, str(slower), str(sum(one < 0.5 for one in times)))

    header = ("configuration", "solved", "times as long", "times as many expanded", "over twice as long", "under half")
    yield from table(header, (line(configuration, rows) for configuration, rows in found.items()))


def seconds(row: Row) -> float:
    """Return how long the search took."""
    return max(row.search_seconds or 0.0, SHORTEST)


def other_costs(found: dict[str, list[Row]]) -> list[str]:
    """Name the configurations and problems whose optimal cost is not the complete configuration's."""
    costs = {row.name: row.risk_cost for row in found[COMPLETE]}
    return [
        f"{configuration}: {row.name}: {row.risk_cost}, not {costs[row.name]}"
        for configuration, rows in found.items()
        for row in rows
        if row.solved and row.risk_cost != costs[row.name]
    ]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("runs", type=Path, metavar="RUNS.csv")
    parser.add_argument("--markdown", type=Path, help="write the table there as Markdown")
    options = parser.parse_args()
    found = by_configuration(read_runs(options.runs))
    if not found[COMPLETE]:
        parser.error(f"'{options.runs}' has no problem that '{COMPLETE}' solves")
    wrong = other_costs(found)
    text = "\n".join(ablation_table(found))
    print(f"{text}\n" + "\n".join(section("Another optimal cost", wrong, markdown=False)))
    if options.markdown:
        head = f"# Ablation: figures\n\n{machine()}. {len(found[COMPLETE])} problems."
        other = "\n".join(section("Another optimal cost", wrong, markdown=True))
        options.markdown.write_text(f"{head}\n\n{text}\n{other}\n", encoding="utf-8")
    raise SystemExit(1 if wrong else 0)


if __name__ == "__main__":
    main()
