"""Time the 53 problems of the paper's tables that this repository has: 5 of the vehicle, 48 of the satellites.

Usage: python -m tests.benchmarks.paper [--repeat N] [--heuristic NAME]

Prints a table and writes nothing: the search alone, reading and grounding, the whole process from its start to its end
(medians), and its peak memory.
"""

from __future__ import annotations

import argparse
import statistics
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

from statehtn.experiments.records import Record
from statehtn.experiments.run import Grid, Run
from statehtn.experiments.runner import execute
from statehtn.experiments.suites import SATELLITE_AGENTS, runs_of

DOMAINS = Path(__file__).resolve().parents[2] / "domains"


def cases(heuristic: str) -> Iterator[Run]:
    """Yield the problems of the tables, with their agents."""
    for run in runs_of("paper", Grid(solvers=("state",), heuristics=(heuristic,)), DOMAINS):
        is_vehicle = run.instance.domain == "av"
        if run.instance.problem == "p1" if is_vehicle else run.settings.objective in SATELLITE_AGENTS:
            yield run


def measure(run: Run, repeat: int) -> dict[str, float]:
    """Execute a run several times; medians in seconds, the largest memory in MB."""
    efforts = []
    for _ in range(repeat):
        record = execute(run)
        if record.status != "optimal":
            raise SystemExit(f"{' '.join(run.key)}: {record.status} {record.message}")
        efforts.append(effort_of(record))
    medians = {name: statistics.median(effort[name] for effort in efforts) for name in efforts[0]}
    return medians | {"memory": max(effort["memory"] for effort in efforts)}


def effort_of(record: Record) -> dict[str, float]:
    """Return what a run has taken."""
    assert record.result is not None
    known = record.result["statistics"]
    prepare = known["parse_seconds"] + known["ground_seconds"]
    effort = {"search": known["search_seconds"], "prepare": prepare, "process": record.seconds}
    return effort | {"memory": known["peak_memory_mb"], "expanded": known["expanded"]}


def import_seconds(repeat: int) -> float:
    code = "import time; start = time.perf_counter(); import statehtn; print(time.perf_counter() - start)"
    runs = [
        subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True) for _ in range(repeat)
    ]
    return statistics.median(float(run.stdout) for run in runs)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--repeat", type=int, default=5)
    parser.add_argument("--heuristic", default="auto")
    options = parser.parse_args()
    print(f"import statehtn: {import_seconds(options.repeat):.3f} s\n")
    print(f"{'problem':<46} {'search s':>9} {'read, ground s':>15} {'process s':>10} {'memory MB':>10} {'expanded':>9}")
    worst: dict[str, float] = {}
    for run in cases(options.heuristic):
        row = measure(run, options.repeat)
        print_row(" ".join(filter(None, run.key[:4])), row)
        worst = {name: max(worst.get(name, 0.0), value) for name, value in row.items()}
    print_row("the worst of each column", worst)


def print_row(name: str, row: dict[str, float]) -> None:
    print(
        f"{name:<46} {row['search']:9.4f} {row['prepare']:15.4f} {row['process']:10.3f} {row['memory']:10.1f} "
        f"{row['expanded']:9.0f}",
        flush=True,
    )


if __name__ == "__main__":
    main()
