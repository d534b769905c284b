"""Measure how well time limits, memory limits, Ctrl-C and SIGTERM hold, over folders of problems.

Usage: python -m tests.benchmarks.limits [--root DIR ...] [--case DOMAIN PROBLEM ...] [--seconds S] [--memory-limit MB]
           [--arguments "--search greedy"] [--signals] [--only TEXT] [--every N] [--offset K]
           [--output FILE.csv] [--markdown FILE.md] [--resume] [--jobs N]

Every problem is planned for in a process of its own with a limit of --seconds; with --signals it is planned for again
twice without that limit, and gets SIGINT and SIGTERM after as many seconds. A line of CSV has: the longest stretch of
the process's own time (CPU) between two looks at the limits, and between which looks that was; the CPU time that the
run took after its limit or its signal (empty where it had ended before); its peak of memory. See `limits_case` for how.
Prints how many are over the marks (0.3 s; 10 % more memory than allowed), and the worst ten of each. --every N takes
every N-th problem only, beginning with the first, or after --offset K others. The figures do not depend much on what
else the machine does, but for the 10 ms of sampling.
"""

from __future__ import annotations

import argparse
import shlex
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import partial
from pathlib import Path

from statehtn.experiments.instances import find_instances
from statehtn.experiments.run import Instance
from tests.benchmarks.limits_case import Case, measure
from tests.benchmarks.tables import add_measuring, figure, machine, measure_all, section, table

MOST_SECONDS = 0.3
MOST_MEMORY = 1.1  # times the limit
WORST = 10


@dataclass(frozen=True)
class Row:
    """One run; seconds of CPU time, MB (10^6 bytes). `overrun`: after the limit, or after the signal."""

    domain: str
    problem: str
    signal: str = ""
    exit_code: int | None = None
    cpu_seconds: float | None = None
    longest_stretch: float | None = None
    after: str = ""
    before: str = ""
    overrun: float | None = None
    peak_memory_mb: float | None = None
    memory_limit_mb: float | None = None
    message: str = ""

    @property
    def name(self) -> str:
        return f"{self.domain} {self.problem}{f' SIG{self.signal}' if self.signal else ''}"

    @property
    def memory_ratio(self) -> float | None:
        """The peak of memory, in parts of what was allowed."""
        if self.peak_memory_mb is None or not self.memory_limit_mb:
            return None
        return self.peak_memory_mb / self.memory_limit_mb


def summary(rows: list[Row], markdown: bool) -> Iterator[str]:
    """Yield the lines of the report."""
    bullet = "- " if markdown else ""
    yield f"{bullet}runs: {len(rows)}; with a plan or a proof: {sum(row.exit_code in (0, 10) for row in rows)}"
    kinds = (
        ("longest stretch between two looks, s", MOST_SECONDS, [row.longest_stretch for row in rows]),
        ("time after the limit, s", MOST_SECONDS, [None if row.signal else row.overrun for row in rows]),
        ("time after a signal, s", MOST_SECONDS, [row.overrun if row.signal else None for row in rows]),
        ("peak of memory, in parts of the limit", MOST_MEMORY, [row.memory_ratio for row in rows]),
    )
    worst: list[str] = []
    for title, mark, values in kinds:
        known = [(value, row) for value, row in zip(values, rows, strict=True) if value is not None]
        known.sort(key=lambda pair: -pair[0])
        if known:
            over = sum(value > mark for value, _ in known)
            yield f"{bullet}{title}: at most {known[0][0]:.3f}; over {mark:g}: {over} of {len(known)}"
            lines = [_worst(value, row, has_places="stretch" in title) for value, row in known[:WORST]]
            worst += ["", f"{'### ' if markdown else ''}Worst: {title}", ""]
            worst += table(("run", "figure", "exit", "CPU s", "MB", "between"), lines)
    yield from worst
    odd = (f"{row.name}: {row.exit_code} {row.message}" for row in rows if row.exit_code not in USUAL)
    yield from section("Ended otherwise", odd, markdown)


def _worst(value: float, row: Row, has_places: bool) -> tuple[str, ...]:
    """Return a line of the table of the worst."""
    used = figure(row.exit_code, "d"), figure(row.cpu_seconds, ".2f"), figure(row.peak_memory_mb, ".0f")
    return (row.name, f"{value:.3f}", *used, f"{row.after} .. {row.before}" if has_places else "")


USUAL = (0, 10, 12, 20, 21, 30, 31, 130)
"""Exit codes of runs that ended as they should."""


def row_of(instance: Instance, case: Case) -> Row:
    """Measure a case."""
    return Row(instance.domain, instance.problem, case.signal, memory_limit_mb=case.memory_mb, **measure(case))


def line(row: Row) -> str:
    """Return what is printed about a row."""
    stretch, overrun = figure(row.longest_stretch, ".3f"), figure(row.overrun, ".3f")
    memory = figure(row.peak_memory_mb, ".0f")
    return f"{row.name:<70} exit {row.exit_code} {stretch:>8} s {overrun:>8} s after {memory:>6} MB"


def cases(options: argparse.Namespace) -> dict[str, Callable[[], Row]]:
    """Return what is to be run, by the names of the rows."""
    instances = [one for root in options.root for one in find_instances(root)]
    instances += [Instance(Path(d).parent.name, Path(p).stem, d, p) for d, p in options.case]
    instances = [one for one in instances if options.only in f"{one.domain} {one.problem}"]
    instances = instances[options.offset :: options.every]
    more = tuple(shlex.split(options.arguments))
    found: dict[str, Callable[[], Row]] = {}
    for one in instances:
        command = ("plan", one.domain_file, one.problem_file, "--quiet", *more)
        for sign in ("", "INT", "TERM") if options.signals else ("",):
            case = Case(command, options.seconds, options.memory_limit, sign)
            found[Row(one.domain, one.problem, sign).name] = partial(row_of, one, case)
    return found


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--root", type=Path, nargs="*", default=[], help="folders of benchmarks")
    parser.add_argument("--case", nargs=2, action="append", default=[], metavar=("DOMAIN", "PROBLEM"))
    parser.add_argument("--seconds", type=float, default=10.0)
    parser.add_argument("--memory-limit", type=float, default=4000.0)
    parser.add_argument("--arguments", default="", help="of `statehtn plan`, besides files and limits")
    parser.add_argument("--signals", action="store_true", help="send SIGINT and SIGTERM, in runs of their own, too")
    parser.add_argument("--only", default="", help="only problems whose domain and name contain this text")
    parser.add_argument("--every", type=int, default=1, help="take every so many-th problem only")
    parser.add_argument("--offset", type=int, default=0, help="leave out so many problems at the beginning")
    parser.add_argument("--markdown", type=Path, help="write the report there as Markdown")
    add_measuring(parser)
    options = parser.parse_args()
    todo = cases(options)
    if not todo:
        parser.error("no problem to run: name folders by --root or problems by --case")
    rows = measure_all(Row, todo, options, line)
    print("\n" + "\n".join(summary(rows, markdown=False)))
    if options.markdown:
        limits = f"Limits: {options.seconds:g} s and {options.memory_limit:g} MB. {machine()}."
        lines = ["# How well limits hold: figures", "", limits, "", *summary(rows, markdown=True)]
        options.markdown.write_text("\n".join(lines) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
