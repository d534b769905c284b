"""Search for optimal plans of a folder of benchmarks, and compare with another planner's times, costs and effort.

Usage: python -m tests.benchmarks.search --root DIR --baseline FILE.csv [--output FILE.csv] [--markdown FILE.md]
           [--only TEXT] [--jobs N] [--most-seconds S] [--heuristic NAME] [--without SWITCH ...] [--resume]

The problems are those of the baseline, each in a process of its own. The limit that the baseline had for its search
(`engine_limit`, at most --most-seconds) holds for the search here likewise, the preparation of heuristics included;
reading and grounding have 60 s apart, as they had for the baseline, and are in no figure. The process has 8 GB. The
baseline has the columns order, domain, problem, status, cost, search_time, search_time_low_h_ties, expanded, generated,
engine_mem_mb and engine_limit; of its two times the better one counts. A switch is a field of `SearchSwitches` that is
turned off.

Prints ours, the baseline's and their ratio by domain and in geometric means, and the effort: landmark cuts per
evaluation, bytes per generated node (the peak of memory less what the process held before the search), and nanoseconds
per evaluation (of the whole search) beside the time that reading the relaxed model once from memory takes. With
`--heuristic lmcut` every evaluation is one of that model; `auto` counts those that read another model or none, too.
"""

from __future__ import annotations

import argparse
import csv
import math
import os
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from dataclasses import asdict, fields
from pathlib import Path
from typing import Any

from tests.benchmarks.floor import read_bandwidth
from tests.benchmarks.search_case import Case, Row, measure
from tests.benchmarks.search_summary import domain_table, effort_table, summary, times_as_fast
from tests.benchmarks.tables import figure, machine, read_rows

Line = dict[str, str]


def name_of(line: Line) -> str:
    """Return what a row of this line of the baseline is called."""
    return f"{line['order']}-order/{line['domain']} {line['problem']}"


def measure_line(line: Line, options: argparse.Namespace) -> Row:
    """Search for the problem of a line of the baseline."""
    folder = options.root / f"{line['order']}-order" / line["domain"]
    problem = folder / f"{line['problem']}.hddl"
    own_domain = folder / f"{line['problem']}-domain.hddl"
    domain = own_domain if own_domain.exists() else folder / "domain.hddl"
    seconds = min(float(line["engine_limit"]), options.most_seconds)
    case = Case(str(domain), str(problem), seconds, options.heuristic, tuple(options.without))
    return Row(f"{line['order']}-order/{line['domain']}", line["problem"], **measure(case), **baseline_of(line))


def baseline_of(line: Line) -> dict[str, Any]:
    """Return the fields of a row that a line of the baseline tells."""
    found: dict[str, Any] = {}
    if line["engine_mem_mb"] and line["generated"]:
        found |= {"baseline_memory_mb": float(line["engine_mem_mb"]), "baseline_generated": int(line["generated"])}
    if line["status"] == "solved":
        times = (line["search_time"], line["search_time_low_h_ties"])
        found |= {"baseline_seconds": min(float(time) for time in times if time)}
        found |= {"baseline_expanded": int(line["expanded"]), "baseline_cost": float(line["cost"])}
    return found


def read_baseline(options: argparse.Namespace) -> list[Line]:
    """Return the lines of the baseline that are asked for."""
    with open(options.baseline, newline="", encoding="utf-8") as file:
        return [line for line in csv.DictReader(file) if options.only in name_of(line)]


def run_all(lines: list[Line], options: argparse.Namespace) -> list[Row]:
    """Measure every problem, write and show each as it ends; what the output has already is kept, if asked for."""
    earlier = read_rows(Row, options.output) if options.resume and options.output and options.output.exists() else []
    known = {row.name for row in earlier}
    todo = [line for line in lines if name_of(line) not in known]
    rows = list(earlier)
    with (
        open(options.output or os.devnull, "w", newline="", encoding="utf-8") as file,
        ThreadPoolExecutor(options.jobs) as pool,
    ):
        writer = csv.DictWriter(file, [field.name for field in fields(Row)])
        writer.writeheader()
        writer.writerows(asdict(row) for row in earlier)
        for row in pool.map(lambda line: measure_line(line, options), todo):
            rows.append(row)
            writer.writerow(asdict(row))
            file.flush()
            seconds = f"{figure(row.search_seconds, '.3f'):>8} s, baseline {figure(row.baseline_seconds, '.3f'):>8} s"
            ratio = f"{times_as_fast(row):6.1f}" if row.solved and row.baseline_seconds is not None else f"{'':6}"
            print(f"{row.name:<64} {row.status:<12} {seconds} {ratio} {row.expanded} expanded", flush=True)
    return rows


def report(rows: list[Row], options: argparse.Namespace, bandwidth: float, markdown: bool) -> Iterator[str]:
    """Yield the lines of the report."""
    limit = "" if math.isinf(options.most_seconds) else f", at most {options.most_seconds:g} s for each search"
    off = f", without {', '.join(options.without)}" if options.without else ""
    only = f", only {options.only}" if options.only else ""
    yield f"{machine()}; {bandwidth / 1e9:.1f} GB/s read from memory. Heuristic {options.heuristic}{off}{limit}{only}."
    yield ""
    yield from summary(rows, markdown)
    for title, lines in (("Times", domain_table(rows)), ("Effort", effort_table(rows, bandwidth))):
        yield from ("", f"{'### ' if markdown else ''}{title}", "", *lines)


def arguments(parser: argparse.ArgumentParser) -> None:
    """Add the options that `ablation` has, too."""
    parser.add_argument("--root", type=Path, default=os.environ.get("STATEHTN_IPC") or None)
    parser.add_argument("--baseline", type=Path, required=True)
    parser.add_argument("--markdown", type=Path, help="write the report there as Markdown")
    parser.add_argument("--only", default="", help="only problems whose domain and name contain this text")
    parser.add_argument("--resume", action="store_true", help="keep what the output has already")
    parser.add_argument("--jobs", type=int, default=1)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments(parser)
    parser.add_argument("--output", type=Path, help="write a line of CSV for each problem as soon as it is done")
    parser.add_argument("--most-seconds", type=float, default=math.inf)
    parser.add_argument("--heuristic", default="auto")
    parser.add_argument("--without", nargs="*", default=[], help="names of SearchSwitches to turn off")
    options = parser.parse_args()
    if options.root is None:
        parser.error("name the folder of the benchmarks by --root or STATEHTN_IPC")
    lines = read_baseline(options)
    if not lines:
        parser.error(f"no problem of the baseline contains {options.only!r}")
    bandwidth = read_bandwidth()
    rows = run_all(lines, options)
    print("\n" + "\n".join(report(rows, options, bandwidth, markdown=False)))
    if options.markdown:
        text = "\n".join(report(rows, options, bandwidth, markdown=True))
        options.markdown.write_text(f"# Optimal search: figures\n\n{text}\n", encoding="utf-8")


if __name__ == "__main__":
    main()
