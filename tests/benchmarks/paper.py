"""Time the 53 problems of the paper's tables that this repository has: 5 of the vehicle, 48 of the satellites.

Usage: python -m tests.benchmarks.paper [--repeat N] [--heuristic NAME]

Prints a table and writes nothing: the search alone, reading and grounding, the whole process from its start to its end
(medians), and its peak memory.
"""

from __future__ import annotations

import argparse
import json
import statistics
import subprocess
import sys
import time
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

DOMAINS = Path(__file__).resolve().parents[2] / "domains"
VEHICLE_AGENTS = [("seeking", 0.1), ("seeking", 0.9), ("averse", 0.1), ("averse", 0.9), ("neutral", None)]
SATELLITE_AGENTS = [("seeking", 0.5), ("averse", 0.5), ("neutral", None)]


@dataclass(frozen=True)
class Case:
    domain: Path
    problem: Path
    attitude: str
    alpha: float | None

    @property
    def name(self) -> str:
        agent = self.attitude if self.alpha is None else f"{self.attitude} {self.alpha:g}"
        return f"{self.domain.parent.name} {self.problem.stem} {agent}"

    @property
    def command(self) -> list[str]:
        alpha = [] if self.alpha is None else ["--alpha", str(self.alpha)]
        files = [str(self.domain), str(self.problem)]
        return [sys.executable, "-m", "statehtn", "plan", *files, "--json", "--attitude", self.attitude, *alpha]


def cases() -> Iterator[Case]:
    vehicle = DOMAINS / "av"
    for attitude, alpha in VEHICLE_AGENTS:
        yield Case(vehicle / "domain.hddl", vehicle / "p1.hddl", attitude, alpha)
    satellite = DOMAINS / "satellite"
    for problem in sorted(satellite.glob("RA-*mod.hddl")):
        for attitude, alpha in SATELLITE_AGENTS:
            yield Case(satellite / "domain.hddl", problem, attitude, alpha)


def run(case: Case, heuristic: str, repeat: int) -> dict[str, float]:
    """Run a case several times in processes of their own; medians in seconds, the largest memory in MB."""
    found: dict[str, list[float]] = {"search": [], "prepare": [], "process": [], "memory": []}
    for _ in range(repeat):
        start = time.perf_counter()
        output = subprocess.run(
            [*case.command, "--heuristic", heuristic], capture_output=True, text=True, check=True
        ).stdout
        found["process"].append(time.perf_counter() - start)
        result = json.loads(output)
        if result["status"] != "optimal":
            raise SystemExit(f"{case.name}: {result['status']}")
        effort = result["statistics"]
        found["search"].append(effort["search_seconds"])
        found["prepare"].append(effort["parse_seconds"] + effort["ground_seconds"])
        found["memory"].append(effort["peak_memory_mb"])
    medians = {name: statistics.median(values) for name, values in found.items()}
    return medians | {"memory": max(found["memory"]), "expanded": effort["expanded"]}


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
    worst = {"search": 0.0, "prepare": 0.0, "process": 0.0, "memory": 0.0, "expanded": 0.0}
    for case in cases():
        row = run(case, options.heuristic, options.repeat)
        print_row(case.name, row)
        worst = {name: max(value, row[name]) for name, value in worst.items()}
    print_row("the worst of each column", worst)


def print_row(name: str, row: dict[str, float]) -> None:
    print(
        f"{name:<46} {row['search']:9.4f} {row['prepare']:15.4f} {row['process']:10.3f} {row['memory']:10.1f} "
        f"{row['expanded']:9.0f}",
        flush=True,
    )


if __name__ == "__main__":
    main()
