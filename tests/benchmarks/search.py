"""Compare optimal searches of `statehtn compare` with another planner's times, costs and effort.

Usage: python -m tests.benchmarks.search RUNS.csv --baseline FILE.csv [--configuration TEXT] [--markdown FILE.md]

The baseline has the columns order, domain, problem, status, cost, search_time, search_time_low_h_ties, expanded,
generated, engine_mem_mb and engine_limit; of its two times the better one counts. `tests.benchmarks.suite` makes a
suite of its problems. --configuration names solver and heuristic, where the runs have others than `state auto`.

Prints ours, the baseline's and their ratio by domain and in geometric means, and the effort: bytes per generated node
and nanoseconds per evaluation (of the whole search).
"""

from __future__ import annotations

import argparse
import csv
from collections.abc import Iterable, Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

from tests.benchmarks.records import COMPLETE, Row, read_runs
from tests.benchmarks.search_summary import Compared, domain_table, effort_table, summary
from tests.benchmarks.tables import machine

Line = dict[str, str]


def name_of(line: Line) -> str:
    """Return what a run on the problem of this line of the baseline is called."""
    return f"{line['order']}-order/{line['domain']} {line['problem']}"


def baseline_of(line: Line) -> dict[str, Any]:
    """Return what a line of the baseline tells, by the names of `Compared`."""
    found: dict[str, Any] = {}
    if line["engine_mem_mb"] and line["generated"]:
        found |= {"baseline_memory_mb": float(line["engine_mem_mb"]), "baseline_generated": int(line["generated"])}
    if line["status"] == "solved":
        times = (line["search_time"], line["search_time_low_h_ties"])
        found |= {"baseline_seconds": min(float(time) for time in times if time)}
        found |= {"baseline_expanded": int(line["expanded"]), "baseline_cost": float(line["cost"])}
    return found


def read_baseline(path: Path) -> list[Line]:
    """Return the lines of the baseline."""
    with open(path, newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def compared(rows: Iterable[Row], lines: Iterable[Line]) -> list[Compared]:
    """Return the runs beside the baseline's, in its order; problems that one of them lacks are left out.

    A search that took longer than the baseline's was allowed to has not solved the problem.
    """
    known = {row.name: row for row in rows}
    found = []
    for line in lines:
        if row := known.get(name_of(line)):
            is_late = (row.search_seconds or 0.0) > float(line["engine_limit"])
            counted = replace(row, status="time-limit") if is_late else row
            found.append(Compared(**vars(counted), **baseline_of(line)))
    return found


def report(rows: list[Compared], configuration: str, markdown: bool) -> Iterator[str]:
    """Yield the lines of the report."""
    yield f"{machine()}. Configuration {configuration}."
    yield ""
    yield from summary(rows, markdown)
    for title, lines in (("Times", domain_table(rows)), ("Effort", effort_table(rows))):
        yield from ("", f"{'### ' if markdown else ''}{title}", "", *lines)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("runs", type=Path, metavar="RUNS.csv")
    parser.add_argument("--baseline", type=Path, required=True)
    parser.add_argument("--configuration", default=COMPLETE)
    parser.add_argument("--markdown", type=Path, help="write the report there as Markdown")
    options = parser.parse_args()
    runs = [row for row in read_runs(options.runs) if row.configuration == options.configuration]
    rows = compared(runs, read_baseline(options.baseline))
    if not rows:
        parser.error(f"'{options.runs}' has no run by '{options.configuration}' on a problem of the baseline")
    print("\n".join(report(rows, options.configuration, markdown=False)))
    if options.markdown:
        text = "\n".join(report(rows, options.configuration, markdown=True))
        options.markdown.write_text(f"# Optimal search: figures\n\n{text}\n", encoding="utf-8")


if __name__ == "__main__":
    main()
