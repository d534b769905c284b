"""Search for optimal plans of a folder of benchmarks, and compare with another planner's times, costs and effort.

Usage: python -m tests.benchmarks.search --root DIR --baseline FILE.csv [--output FILE.csv] [--markdown FILE.md]
           [--only TEXT] [--jobs N] [--most-seconds S] [--heuristic NAME] [--without SWITCH ...] [--resume]

The problems are those of the baseline, each in a process of its own and under the limit that the baseline had for its
search (`engine_limit`, at most --most-seconds), which here holds for reading and grounding, too. The baseline has the
columns order, domain, problem, status, cost, search_time, search_time_low_h_ties, engine_limit, engine_mem_mb and
expanded; of its two times the better one counts. A switch is a field of `SearchSwitches` that is turned off.
"""

from __future__ import annotations

import argparse
import csv
import json
import math
import os
import subprocess
import sys
import time
import warnings
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from dataclasses import asdict, dataclass, fields
from pathlib import Path

from statehtn.effort import peak_memory_mb
from statehtn.limits import LimitReached, Limits
from tests.benchmarks.grounding import geometric_mean, machine, section

HARD = 0.5  # seconds of the baseline from which times are compared
SLOWER = 0.1  # seconds by which a search may be slower and not be named
GRACE = 15.0
MEMORY_MB = 8000.0


@dataclass(frozen=True)
class Row:
    """One line of the output: seconds, MB (10^6 bytes), costs in the domain's unit; the baseline's likewise."""

    domain: str
    problem: str
    status: str
    cost: float | None = None
    lower_bound: float | None = None
    search_seconds: float | None = None
    expanded: int | None = None
    evaluated: int | None = None
    peak_memory_mb: float | None = None
    base_memory_mb: float | None = None
    baseline_cost: float | None = None
    baseline_seconds: float | None = None
    baseline_expanded: int | None = None
    baseline_memory_mb: float | None = None
    message: str = ""

    @property
    def name(self) -> str:
        return f"{self.domain} {self.problem}"

    @property
    def solved(self) -> bool:
        return self.status in ("optimal", "unsolvable")

    @property
    def ratio(self) -> float:
        """How many times as fast as the baseline; both must have solved it."""
        return (self.baseline_seconds or math.nan) / max(self.search_seconds or math.nan, 1e-4)


def run_child(options: argparse.Namespace) -> dict[str, object]:
    """Search in this process, and return the fields of a row."""
    from statehtn.core.grounding import ground
    from statehtn.core.search import SearchSwitches, find_plans
    from statehtn.hddl import HddlWarning, read_hddl
    from statehtn.risk import utility_for

    limits = Limits.starting_now(options.most_seconds, MEMORY_MB)
    found: dict[str, object] = {}
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", HddlWarning)
            lifted = read_hddl(*options.child, limits=limits)
        grounding = ground(lifted, limits)
        found["base_memory_mb"] = peak_memory_mb()
        start = time.perf_counter()
        switches = SearchSwitches(**dict.fromkeys(options.without, False))
        outcome = find_plans(
            grounding, utility_for("neutral", None), heuristic=options.heuristic, limits=limits, switches=switches
        )
        found["search_seconds"] = time.perf_counter() - start
        found |= {"status": outcome.status.value, "lower_bound": outcome.lower_bound}
        found |= {"expanded": outcome.expanded, "evaluated": outcome.evaluated}
        if outcome.plan is not None:
            found["cost"] = outcome.lower_bound
    except LimitReached as reached:
        found["status"] = reached.status.value
    return found | {"peak_memory_mb": peak_memory_mb()}


def measure(line: dict[str, str], options: argparse.Namespace) -> Row:
    """Search in a process of its own."""
    folder = options.root / f"{line['order']}-order" / line["domain"]
    seconds = min(float(line["engine_limit"]), options.most_seconds)
    command = [sys.executable, "-m", "tests.benchmarks.search", "--heuristic", options.heuristic]
    command += ["--child", str(domain_of(folder, line["problem"])), str(folder / f"{line['problem']}.hddl")]
    command += ["--most-seconds", str(seconds), "--without", *options.without]
    try:
        run = subprocess.run(command, capture_output=True, text=True, timeout=seconds + GRACE, check=True)
        found = json.loads(run.stdout)
    except subprocess.TimeoutExpired:
        found = {"status": "killed"}
    except subprocess.CalledProcessError as error:
        found = {"status": "crashed", "message": (error.stderr.strip() or str(error)).splitlines()[-1]}
    times = [float(line[name]) for name in ("search_time", "search_time_low_h_ties") if line[name]]
    best = min(times, default=math.inf)
    if best < float(line["engine_limit"]):
        found |= {"baseline_seconds": best, "baseline_expanded": int(line["expanded"] or 0)}
        found |= {"baseline_cost": float(line["cost"]) if line["cost"] else None}
        found |= {"baseline_memory_mb": float(line["engine_mem_mb"])}
    return Row(f"{line['order']}-order/{line['domain']}", line["problem"], **found)


def domain_of(folder: Path, problem: str) -> Path:
    own = folder / f"{problem}-domain.hddl"
    return own if own.exists() else folder / "domain.hddl"


def read_rows(path: Path) -> list[Row]:
    """Return the rows of an earlier output."""
    rows = []
    with open(path, newline="", encoding="utf-8") as file:
        for line in csv.DictReader(file):
            values: dict[str, object] = {}
            for field in fields(Row):
                text, kind = line[field.name], str(field.type)
                number = float(text) if "float" in kind and text else int(text) if "int" in kind and text else None
                values[field.name] = text if "str" in kind else number
            rows.append(Row(**values))  # type: ignore[arg-type]
    return rows


def summary(rows: list[Row], markdown: bool) -> Iterator[str]:
    """Yield the lines of the report."""
    bullet = "- " if markdown else ""
    solved = [row for row in rows if row.solved]
    known = [row for row in rows if row.baseline_seconds is not None]
    both = [row for row in solved if row.baseline_seconds is not None]
    yield f"{bullet}proven optimal: {len(solved)} of {len(rows)}; by the baseline {len(known)}"
    for floor in (HARD, 0.1, 0.01):
        if hard := [row.ratio for row in both if (row.baseline_seconds or 0) >= floor]:
            ratio = geometric_mean(hard)
            problems = f"where the baseline needs {floor:g} s ({len(hard)} problems, geometric mean)"
            yield f"{bullet}{ratio:.1f} times as fast {problems}"
    faster = sum(row.ratio > 1 for row in both)
    yield f"{bullet}faster on {faster} of the {len(both)} that both solve"
    wrong = (f"{row.name}: {row.cost}, baseline {row.baseline_cost}" for row in both if row.cost != row.baseline_cost)
    yield from section("Another optimal cost", wrong, markdown)
    slower = (row for row in both if (row.search_seconds or 0) > (row.baseline_seconds or 0) + SLOWER)
    lines = (f"{row.name}: {row.search_seconds:.2f} s, baseline {row.baseline_seconds:.2f} s" for row in slower)
    yield from section(f"Slower by more than {SLOWER:g} s", lines, markdown)
    missing = (row for row in rows if not row.solved)
    lines = (f"{row.name}: {row.status} {row.message}, baseline {row.baseline_seconds}" for row in missing)
    yield from section("Not proven", lines, markdown)


def domain_table(rows: list[Row]) -> Iterator[str]:
    """Yield a Markdown table with a line for each domain."""
    yield "| domain | proven | baseline | times as fast | hardest both solve: s | baseline s | expanded | baseline |"
    yield "|---|---:|---:|---:|---:|---:|---:|---:|"
    for domain in dict.fromkeys(row.domain for row in rows):
        own = [row for row in rows if row.domain == domain]
        both = [row for row in own if row.solved and row.baseline_seconds is not None]
        hardest = max(both, key=lambda row: row.baseline_seconds or 0, default=None)
        ratios = [row.ratio for row in both if (row.baseline_seconds or 0) >= 0.01]
        cells = [
            domain,
            f"{sum(row.solved for row in own)}/{len(own)}",
            str(sum(row.baseline_seconds is not None for row in own)),
            f"{geometric_mean(ratios):.1f}" if ratios else "",
        ]
        if hardest is not None:
            cells += [f"{hardest.search_seconds:.3f}", f"{hardest.baseline_seconds:.3f}"]
            cells += [str(hardest.expanded), str(hardest.baseline_expanded)]
        yield f"| {' | '.join(cells + [''] * (8 - len(cells)))} |"


def arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--root", type=Path, default=os.environ.get("STATEHTN_IPC") or None)
    parser.add_argument("--baseline", type=Path)
    parser.add_argument("--output", type=Path, help="write a line of CSV for each problem as soon as it is done")
    parser.add_argument("--markdown", type=Path, help="write the report there as Markdown, with a table of the domains")
    parser.add_argument("--only", default="", help="only problems whose domain and name contain this text")
    parser.add_argument("--resume", action="store_true", help="keep what the output has already")
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--most-seconds", type=float, default=math.inf)
    parser.add_argument("--heuristic", default="auto")
    parser.add_argument("--without", nargs="*", default=[], help="names of SearchSwitches to turn off")
    parser.add_argument("--child", nargs=2, type=Path, help=argparse.SUPPRESS)
    options = parser.parse_args()
    if not options.child and (options.root is None or options.baseline is None):
        parser.error("name the folder of the benchmarks by --root or STATEHTN_IPC, and the --baseline")
    return options


def run_all(options: argparse.Namespace) -> list[Row]:
    """Measure every problem, write and show each as it ends."""
    earlier = read_rows(options.output) if options.resume and options.output and options.output.exists() else []
    known = {row.name for row in earlier}
    with open(options.baseline, newline="", encoding="utf-8") as file:
        lines = list(csv.DictReader(file))
    named = ((f"{line['order']}-order/{line['domain']} {line['problem']}", line) for line in lines)
    todo = [line for name, line in named if options.only in name and name not in known]
    rows = list(earlier)
    with (
        open(options.output or os.devnull, "w", newline="", encoding="utf-8") as file,
        ThreadPoolExecutor(options.jobs) as pool,
    ):
        writer = csv.DictWriter(file, [field.name for field in fields(Row)])
        writer.writeheader()
        writer.writerows(asdict(row) for row in earlier)
        for row in pool.map(lambda line: measure(line, options), todo):
            rows.append(row)
            writer.writerow(asdict(row))
            file.flush()
            base = "" if row.baseline_seconds is None else f"{row.baseline_seconds:8.3f}"
            seconds = "" if row.search_seconds is None else f"{row.search_seconds:8.3f}"
            print(f"{row.name:<64} {row.status:<12} {seconds:>8} s, baseline {base:>8} s {row.expanded}", flush=True)
    return rows


def main() -> None:
    options = arguments()
    if options.child:
        print(json.dumps(run_child(options)))
        return
    rows = run_all(options)
    print("\n" + "\n".join(summary(rows, markdown=False)))
    if options.markdown:
        lines = [f"{machine()}.", "", *summary(rows, markdown=True), "", *domain_table(rows)]
        options.markdown.write_text("\n".join(lines) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
