"""Time how fast the reader takes large problems, and in how much memory.

Usage: python -m tests.benchmarks.reading [--root DIR] [--largest N] [--repeat N] [--markdown]

Reads generated problems of 4 MB and, where a folder of benchmarks is named (--root, or the environment variable
STATEHTN_IPC), the largest files in it, each in a process of its own. Prints seconds (medians), the peak memory of the
process above what it needs before it reads, and its ratio to the size of both files. The aim: 4 MB in 2 s, and at most
30 times the size of the files. Exits with 1 if a problem of 1 MB or more misses it.
"""

from __future__ import annotations

import argparse
import json
import os
import statistics
import subprocess
import sys
import tempfile
import time
import warnings
from collections.abc import Callable, Iterator
from itertools import count
from pathlib import Path

from statehtn.effort import peak_memory_mb
from statehtn.experiments.instances import find_instances
from statehtn.hddl import HddlWarning, read_hddl
from statehtn.limits import resident_mb

SIZE = 4_000_000
SECONDS_PER_MB = 0.5
MEMORY_FACTOR = 30.0
SMALLEST = 1.0  # MB; a smaller file's seconds and memory are the process's own
DOMAIN = """(define (domain large)
  (:types place)
  (:predicates (road ?a ?b - place) (clear))
  (:functions (length ?a ?b - place) - number)
  (:task visit :parameters (?p - place))
  (:method m-visit :parameters (?p - place) :task (visit ?p) :subtasks ()))
"""


def facts() -> str:
    """A problem that is mostly initial facts, as large ones are."""
    return problem(init=filled(lambda i: f"(road place{i // 300} place{i % 300})", SIZE))


def values() -> str:
    """A problem that is mostly values of functions."""
    return problem(init=filled(lambda i: f"(= (length place{i // 300} place{i % 300}) {i}.5)", SIZE))


def objects() -> str:
    """A problem that is mostly objects."""
    return problem(objects=filled(lambda i: f"thing{i} - place", SIZE))


def tasks() -> str:
    """A problem that is mostly its initial task network, in order."""
    return problem(tasks=filled(lambda i: f"(visit place{i % 300})", SIZE))


def goals() -> str:
    """A problem that is mostly its goal."""
    return problem(goal=filled(lambda i: f"(not (road place{i // 300 % 300} place{i % 300}))", SIZE))


def mixture() -> str:
    """A problem with a fifth of each."""
    fifth = SIZE // 5
    return problem(
        objects=filled(lambda i: f"thing{i} - place", fifth),
        init=filled(lambda i: f"(road place{i // 300} place{i % 300})", fifth)
        + filled(lambda i: f"(= (length place{i // 300} place{i % 300}) {i}.5)", fifth),
        tasks=filled(lambda i: f"(visit place{i % 300})", fifth),
        goal=filled(lambda i: f"(not (road place{i // 300 % 300} place{i % 300}))", fifth),
    )


GENERATED = (facts, values, objects, tasks, goals, mixture)


def filled(line: Callable[[int], str], size: int) -> str:
    """Return lines of so many characters together."""
    lines: list[str] = []
    for index in count():
        lines.append(line(index))
        size -= len(lines[-1]) + 1
        if size <= 0:
            break
    return "\n".join(lines)


def problem(objects: str = "", init: str = "(clear)", tasks: str = "", goal: str = "") -> str:
    places = " ".join(f"place{i}" for i in range(max(300, SIZE // 4000)))
    return (
        f"(define (problem large) (:domain large)\n(:objects {places} - place\n{objects})\n"
        f"(:htn :ordered-subtasks (and {tasks}))\n(:init {init})\n(:goal (and {goal})))\n"
    )


def largest(root: Path, number: int) -> Iterator[tuple[str, str, str]]:
    instances = find_instances(root)
    instances.sort(key=lambda instance: -Path(instance.problem_file).stat().st_size)
    for instance in instances[:number]:
        yield f"{instance.domain} {instance.problem}", instance.domain_file, instance.problem_file


def read_once(domain: str, problem: str) -> dict[str, float]:
    """Read a problem in this process; seconds, and MB above those that the process needed before."""
    before = resident_mb()
    start = time.perf_counter()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", HddlWarning)
        read_hddl(domain, problem)
    return {"seconds": time.perf_counter() - start, "memory": (peak_memory_mb() or before) - before}


def measure(domain: str, problem: str, repeat: int) -> dict[str, float]:
    runs = []
    for _ in range(repeat):
        command = [sys.executable, "-m", "tests.benchmarks.reading", "--child", domain, problem]
        runs.append(json.loads(subprocess.run(command, capture_output=True, text=True, check=True).stdout))
    size = (Path(domain).stat().st_size + Path(problem).stat().st_size) / 1e6
    memory = max(run["memory"] for run in runs)
    seconds = statistics.median(run["seconds"] for run in runs)
    return {"size": size, "seconds": seconds, "memory": memory, "ratio": memory / size}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--root", type=Path, default=os.environ.get("STATEHTN_IPC") or None)
    parser.add_argument("--largest", type=int, default=5, metavar="N")
    parser.add_argument("--repeat", type=int, default=3, metavar="N")
    parser.add_argument("--markdown", action="store_true")
    parser.add_argument("--child", nargs=2, help=argparse.SUPPRESS)
    options = parser.parse_args()
    if options.child:
        print(json.dumps(read_once(*options.child)))
        return
    missed = []
    header = ("problem", "MB", "seconds", "memory MB", "times the file")
    print_row(header, options.markdown)
    if options.markdown:
        print_row(("---", *["---:"] * 4), True)
    with tempfile.TemporaryDirectory() as folder:
        cases = [*generated(Path(folder)), *(largest(options.root, options.largest) if options.root else ())]
        for name, domain, problem in cases:
            row = measure(domain, problem, options.repeat)
            figures = (f"{row['size']:.2f}", f"{row['seconds']:.2f}", f"{row['memory']:.0f}", f"{row['ratio']:.1f}")
            print_row((name, *figures), options.markdown)
            is_slow = row["seconds"] > SECONDS_PER_MB * row["size"]
            if row["size"] >= SMALLEST and (is_slow or row["ratio"] > MEMORY_FACTOR):
                missed.append(name)
    if missed:
        raise SystemExit(f"slower than {1 / SECONDS_PER_MB:g} MB/s or above {MEMORY_FACTOR:g} times the file: {missed}")


def generated(folder: Path) -> Iterator[tuple[str, str, str]]:
    domain = folder / "domain.hddl"
    domain.write_text(DOMAIN, encoding="utf-8")
    for generate in GENERATED:
        file = folder / f"{generate.__name__}.hddl"
        file.write_text(generate(), encoding="utf-8")
        yield f"generated: {generate.__name__}", str(domain), str(file)


def print_row(cells: tuple[str, ...], markdown: bool) -> None:
    if markdown:
        print(f"| {' | '.join(cells)} |", flush=True)
    else:
        print(f"{cells[0]:<50}" + "".join(f" {cell:>14}" for cell in cells[1:]), flush=True)


if __name__ == "__main__":
    main()
