"""Measure how fast policies are found on flat problems of verification, and how much memory a node takes.

Usage: python -m tests.benchmarks.policies [--only NAME ...] [--seconds S] [--memory-limit MB] [--repeats N]
           [--markdown FILE.md]

Every run is a process of its own, of which the median time counts. Bytes per node: the peak of memory that the search
adds, for each node that it has made.
"""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
import time
from collections.abc import Iterator
from dataclasses import asdict, dataclass
from pathlib import Path

import statehtn
from statehtn.effort import Meter, peak_memory_mb
from statehtn.limits import Limits
from statehtn.policies.run import find_policy
from statehtn.policies.settings import PolicySettings
from statehtn.session import Session
from tests.benchmarks.policy_cases import CASES
from tests.benchmarks.tables import machine, table

OBJECTIVE = "neutral"


@dataclass(frozen=True)
class Run:
    """One run: seconds of the search alone and of all, bytes of memory; `nodes` are those that the search made."""

    name: str
    states: int
    status: str
    value: float | None
    lower: float | None
    nodes: int
    seconds: float
    search_seconds: float
    peak_bytes: float
    added_bytes: float


def run(name: str, seconds: float, memory_limit: float) -> Run:
    """Measure a case in this process."""
    case = CASES[name]()
    start = time.perf_counter()
    session = Session(statehtn.read_hddl_text(case.domain, case.problem))
    session.ground_for_policies(Limits(), Meter())
    before = peak_memory_mb()
    limits = Limits.starting_now(seconds, memory_limit)
    result = find_policy(session, PolicySettings.of(OBJECTIVE), limits)
    whole = time.perf_counter() - start
    peak = peak_memory_mb()
    effort = result.statistics
    return Run(
        case.name,
        case.states,
        str(result.status),
        result.value,
        result.lower_bound,
        effort.generated or 0,
        whole,
        effort.search_seconds or 0.0,
        peak * 1e6,
        (peak - before) * 1e6,
    )


def measured(options: argparse.Namespace) -> Iterator[Run]:
    """Yield the median run of each case, each in a process of its own."""
    for name in options.only or CASES:
        command = [sys.executable, "-m", "tests.benchmarks.policies", "--child", name]
        command += ["--seconds", str(options.seconds), "--memory-limit", str(options.memory_limit)]
        found = []
        for _ in range(options.repeats):
            ended = subprocess.run(command, capture_output=True, text=True, check=True)
            found.append(Run(**json.loads(ended.stdout)))
        found.sort(key=lambda one: one.seconds)
        yield found[len(found) // 2]


def line(one: Run) -> list[str]:
    """A line of the table."""
    rate = one.nodes / one.search_seconds if one.search_seconds else 0
    value = "" if one.value is None else f"{one.value:.6g}"
    numbers = f"{one.states}", f"{one.nodes}", f"{one.seconds:.1f}", f"{one.search_seconds:.1f}", f"{rate:.0f}"
    memory = f"{one.added_bytes / max(1, one.nodes):.0f}", f"{one.peak_bytes / 1e6:.0f}"
    return [one.name, one.status, value, *numbers, *memory]


HEADER = ["problem", "status", "value", "states", "nodes", "s", "s of search", "nodes/s", "bytes/node", "peak MB"]


def main() -> None:
    """Run the benchmark."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--only", nargs="+", choices=CASES)
    parser.add_argument("--seconds", type=float, default=120.0)
    parser.add_argument("--memory-limit", type=float, default=2000.0)
    parser.add_argument("--repeats", type=int, default=1)
    parser.add_argument("--markdown", type=Path)
    parser.add_argument("--child", help=argparse.SUPPRESS)
    options = parser.parse_args()
    if options.child:
        print(json.dumps(asdict(run(options.child, options.seconds, options.memory_limit))))
        return
    text = "\n".join(table(HEADER, map(line, measured(options))))
    whole = f"{machine()}. Median of {options.repeats}, objective {OBJECTIVE}.\n\n{text}\n"
    print(whole)
    if options.markdown is not None:
        options.markdown.write_text(f"# Policies: figures\n\n{whole}", encoding="utf-8")


if __name__ == "__main__":
    main()
