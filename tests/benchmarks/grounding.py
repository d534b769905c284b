"""Read and ground every problem of a folder of benchmarks, and compare times and sizes with another grounder's.

Usage: python -m tests.benchmarks.grounding [--root DIR] [--baseline FILE.csv] [--output FILE.csv] [--markdown FILE.md]
           [--only TEXT] [--jobs N] [--time-limit S] [--memory-limit MB] [--resume]

The folder is that of --root or of the environment variable STATEHTN_IPC. Every problem is read and grounded in a
process of its own under the limits. The baseline has the columns order (partial, total), domain, problem, parse_time,
ground_time (seconds), facts, actions, tasks, methods, as pandaPIgrounder gives them: its sizes count the actions and
methods that it compiles, and so do ours here. Prints how many problems ground, the geometric means of the ratios of
seconds (where the baseline needs more than 0.1 s) and of sizes, and names every problem that does not ground, is slower
and needs more than 0.1 s, or is over 10 % larger. `actions` of the output counts all ground actions, `domain_actions`
those of the domain.
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
from dataclasses import dataclass
from functools import partial
from pathlib import Path

from statehtn.effort import peak_memory_mb
from statehtn.errors import StateHtnError
from statehtn.experiments.instances import find_instances
from statehtn.experiments.run import Instance
from statehtn.hddl import HddlWarning, read_hddl
from statehtn.limits import LimitReached, Limits
from tests.benchmarks.tables import add_measuring, geometric_mean, machine, measure_all, section

SLOW = 0.1  # seconds of the baseline above which times are compared
LARGER = 1.1
GRACE = 15.0  # seconds after the time limit when a process is ended from outside
SIZES = ("facts", "actions", "tasks", "methods")


@dataclass(frozen=True)
class Row:
    """One line of the output; seconds, MB (10^6 bytes), and counts of the ground problem where it was reached."""

    domain: str
    problem: str
    status: str
    parse_seconds: float | None = None
    ground_seconds: float | None = None
    peak_memory_mb: float | None = None
    facts: int | None = None
    actions: int | None = None
    domain_actions: int | None = None
    tasks: int | None = None
    methods: int | None = None
    message: str = ""

    @property
    def seconds(self) -> float:
        return (self.parse_seconds or 0.0) + (self.ground_seconds or 0.0)

    @property
    def size(self) -> int | None:
        sizes = [getattr(self, name) for name in SIZES]
        return None if None in sizes else sum(sizes)

    @property
    def name(self) -> str:
        return f"{self.domain} {self.problem}"


@dataclass(frozen=True)
class Baseline:
    seconds: float
    size: int | None


def run_child(domain: str, problem: str, time_limit: float, memory_limit: float) -> dict[str, object]:
    """Read and ground in this process, and return the fields of a row."""
    from statehtn.core.grounding import ground

    found: dict[str, object] = {}
    limits = Limits.starting_now(time_limit, memory_limit)
    start = time.perf_counter()
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", HddlWarning)
            lifted = read_hddl(domain, problem, limits=limits)
        found["parse_seconds"] = time.perf_counter() - start
        start = time.perf_counter()
        grounding = ground(lifted, limits)
        found["ground_seconds"] = time.perf_counter() - start
        found |= {"status": "grounded", "facts": grounding.fact_count, "actions": grounding.handle.action_count}
        found |= {"domain_actions": grounding.action_count, "tasks": grounding.task_count}
        found["methods"] = grounding.method_count
    except LimitReached as reached:
        found["status"] = reached.status.value
    except StateHtnError as error:
        found |= {"status": "error", "message": str(error)}
    return found | {"peak_memory_mb": peak_memory_mb()}


def measure(instance: Instance, time_limit: float, memory_limit: float) -> Row:
    """Read and ground in a process of its own."""
    command = [sys.executable, "-m", "tests.benchmarks.grounding", "--child", instance.domain_file]
    command += [instance.problem_file, "--time-limit", str(time_limit), "--memory-limit", str(memory_limit)]
    try:
        run = subprocess.run(command, capture_output=True, text=True, timeout=time_limit + GRACE, check=True)
        found = json.loads(run.stdout)
    except subprocess.TimeoutExpired:
        found = {"status": "killed", "message": f"still running {GRACE:g} s after the time limit"}
    except subprocess.CalledProcessError as error:
        found = {"status": "crashed", "message": (error.stderr.strip() or str(error)).splitlines()[-1]}
    return Row(instance.domain, instance.problem, **found)


def read_baseline(path: Path) -> dict[tuple[str, str], Baseline]:
    """Return the baseline's figures by our names of domain and problem."""
    found = {}
    with open(path, newline="", encoding="utf-8") as file:
        for line in csv.DictReader(file):
            sizes = [line[name] for name in SIZES]
            size = sum(map(int, sizes)) if all(sizes) else None
            key = (f"{line['order']}-order/{line['domain']}", line["problem"])
            found[key] = Baseline(float(line["parse_time"] or 0) + float(line["ground_time"] or 0), size)
    return found


def summary(rows: list[Row], baseline: dict[tuple[str, str], Baseline], markdown: bool) -> Iterator[str]:
    """Yield the lines of the report."""
    grounded = [row for row in rows if row.status == "grounded"]
    known = [(row, baseline[row.domain, row.problem]) for row in grounded if (row.domain, row.problem) in baseline]
    pairs = [(row, other) for row, other in known if other.size]
    bullet = "- " if markdown else ""
    yield f"{bullet}grounded within the limits: {len(grounded)} of {len(rows)} ({len(grounded) / len(rows):.1%})"
    if timed := [other.seconds / row.seconds for row, other in pairs if other.seconds > SLOW]:
        ratio = geometric_mean(timed)
        yield f"{bullet}reading and grounding is {ratio:.2f} times as fast (geometric mean of {len(timed)} problems)"
    if sizes := [ratio_of_sizes(row, other) for row, other in pairs]:
        ratio = geometric_mean(sizes)
        yield f"{bullet}ground problems are {ratio:.3f} times as large (geometric mean of {len(sizes)} problems)"
    yield f"{bullet}grounded, where the baseline is not: {len(known) - len(pairs)}"
    failed = (f"{row.name}: {row.status} {row.message}" for row in rows if row.status != "grounded")
    yield from section("Not grounded", failed, markdown)
    slower = [(row, other) for row, other in pairs if row.seconds > max(other.seconds, SLOW)]
    slower.sort(key=lambda pair: pair[1].seconds / pair[0].seconds)
    lines = (f"{row.name}: {row.seconds:.2f} s, baseline {other.seconds:.2f} s" for row, other in slower)
    yield from section("Slower", lines, markdown)
    larger = [(row, other) for row, other in pairs if ratio_of_sizes(row, other) > LARGER]
    larger.sort(key=lambda pair: -ratio_of_sizes(*pair))
    lines = (f"{a.name}: {a.size}, baseline {b.size} ({ratio_of_sizes(a, b):.2f} times)" for a, b in larger)
    yield from section(f"More than {LARGER - 1:.0%} larger", lines, markdown)


def ratio_of_sizes(row: Row, baseline: Baseline) -> float:
    """Return how many times as large our ground problem is; one that is empty counts as 1."""
    return (row.size or 1) / (baseline.size or 1)


def domain_table(rows: list[Row], baseline: dict[tuple[str, str], Baseline]) -> Iterator[str]:
    """Yield a Markdown table with a line for each domain."""
    yield "| domain | grounded | slowest s | most MB | times as fast | times as large |"
    yield "|---|---:|---:|---:|---:|---:|"
    for domain in dict.fromkeys(row.domain for row in rows):
        own = [row for row in rows if row.domain == domain]
        done = [row for row in own if row.status == "grounded"]
        known = ((row, baseline.get((row.domain, row.problem))) for row in done)
        pairs = [(row, other) for row, other in known if other is not None and other.size]
        speeds = [other.seconds / row.seconds for row, other in pairs if other.seconds > SLOW]
        sizes = [ratio_of_sizes(row, other) for row, other in pairs]
        cells = (
            domain,
            f"{len(done)}/{len(own)}",
            f"{max((row.seconds for row in done), default=math.nan):.2f}",
            f"{max((row.peak_memory_mb or 0 for row in own), default=math.nan):.0f}",
            f"{geometric_mean(speeds):.2f}" if speeds else "",
            f"{geometric_mean(sizes):.3f}" if sizes else "",
        )
        yield f"| {' | '.join(cells)} |"


def line(row: Row) -> str:
    """Return what is printed about a row."""
    return f"{row.name:<70} {row.status:<12} {row.seconds:7.2f} s {row.peak_memory_mb or 0:7.0f} MB"


def arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--root", type=Path, default=os.environ.get("STATEHTN_IPC") or None)
    parser.add_argument("--baseline", type=Path)
    parser.add_argument("--markdown", type=Path, help="write the report there as Markdown, with a table of the domains")
    parser.add_argument("--only", default="", help="only problems whose domain and name contain this text")
    add_measuring(parser)
    parser.add_argument("--time-limit", type=float, default=60.0)
    parser.add_argument("--memory-limit", type=float, default=4000.0)
    parser.add_argument("--child", nargs=2, help=argparse.SUPPRESS)
    options = parser.parse_args()
    if not options.child and options.root is None:
        parser.error("name the folder of the benchmarks by --root or STATEHTN_IPC")
    return options


def main() -> None:
    options = arguments()
    if options.child:
        domain, problem = options.child
        print(json.dumps(run_child(domain, problem, options.time_limit, options.memory_limit)))
        return
    names = {f"{one.domain} {one.problem}": one for one in find_instances(options.root)}
    allowed = options.time_limit, options.memory_limit
    cases = {name: partial(measure, one, *allowed) for name, one in names.items() if options.only in name}
    rows = measure_all(Row, cases, options, line)
    if not rows:
        raise SystemExit("no problem to ground")
    baseline = read_baseline(options.baseline) if options.baseline else {}
    print("\n" + "\n".join(summary(rows, baseline, markdown=False)))
    if options.markdown:
        limits = f"Limits: {options.time_limit:g} s and {options.memory_limit:g} MB for each problem. {machine()}."
        lines = [limits, "", *summary(rows, baseline, markdown=True), "", *domain_table(rows, baseline)]
        options.markdown.write_text("\n".join(lines) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
