"""`statehtn compare`: run a suite, each run in a process of its own, and keep a record of each as it ends."""

from __future__ import annotations

import argparse
import logging
import sys
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import AbstractContextManager, closing, contextmanager, nullcontext
from fnmatch import fnmatchcase
from pathlib import Path
from typing import Any

from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeElapsedColumn, TimeRemainingColumn

from statehtn.cli.exit_codes import ExitCode
from statehtn.cli.files import STDOUT
from statehtn.cli.streams import OutputError, emit, say
from statehtn.compatible import switches_in
from statehtn.display.summaries import readable_summaries
from statehtn.errors import InputError, UsageError, one_line
from statehtn.experiments.cluster import execute_on_cluster
from statehtn.experiments.record_files import RecordFiles, csv_line
from statehtn.experiments.records import COLUMNS, Record, Row
from statehtn.experiments.run import Grid, Run, objectives_of
from statehtn.experiments.runner import execute_all
from statehtn.experiments.suites import runs_of
from statehtn.experiments.summary import summarise, summary_of
from statehtn.settings import keeps

RETRIED = {"errors": "error", "killed": "killed"}
"""What `--retry` takes, and the status of the runs that it means."""
FAILURES = ("input-error", "unsupported", "error", "killed")
"""The statuses of runs whose messages say what to do about them."""
Show = Callable[[Record], None]


def run_compare(options: argparse.Namespace) -> ExitCode:
    """Run the command and return its exit code: success once every run is recorded, whatever has come of it.

    Raises:
        StateHtnError: the options are wrong, or there is nothing to run.
        OutputError: a record cannot be written.
    """
    runs = _runs(options)
    if options.output == STDOUT:
        options.output = None
    if options.retry and options.output is None:
        raise UsageError("--retry takes up the runs of an earlier comparison: name its table by --output FILE.csv")
    try:
        rows = _to_stdout(runs, options) if options.output is None else _to_files(runs, options)
    except OSError as error:
        raise OutputError(f"cannot go on: {error.strerror}") from error
    except KeyboardInterrupt:
        again = "" if options.output is None else f"; the same command goes on where it stopped ('{options.output}')"
        say(f"interrupted{again}")
        return ExitCode.INTERRUPTED
    if not options.quiet:
        _summarise(rows, options)
    return ExitCode.SUCCESS


def _runs(options: argparse.Namespace) -> list[Run]:
    """Return the runs that the options ask for."""
    asked = Grid(
        objectives=objectives_of(_unique(options.attitude), _unique(options.alpha), _unique(options.objective)),
        solvers=_unique(options.solver),
        heuristics=_unique(options.heuristic),
        searches=_unique(options.search),
        without=_unique(map(switches_in, options.without or ())),
        keep=keeps(options.keep),
        precision=options.precision,
        repeat=options.repeat,
        time_limit=options.time_limit,
        memory_limit=options.memory_limit,
    )
    runs = runs_of(options.suite, asked, None if options.root is None else Path(options.root))
    for kind in ("domain", "problem"):
        globs = getattr(options, kind)
        if globs is not None:
            runs = [run for run in runs if any(fnmatchcase(getattr(run.instance, kind), glob) for glob in globs)]
        if not runs:
            raise InputError(f"the suite has no {kind} called {' or '.join(map(repr, globs))}")
    return runs


def _unique(values: Iterable[Any] | None) -> tuple[Any, ...]:
    return tuple(dict.fromkeys(values or ()))


def _to_files(runs: list[Run], options: argparse.Namespace) -> list[Row]:
    """Execute the runs that are not recorded yet, and return the rows of all."""
    with RecordFiles(options.output) as files:
        files.forget(runs, [RETRIED[name] for name in options.retry or ()])
        missing = files.missing(runs)
        visible = sys.stderr.isatty() and not options.quiet
        progress = _bar(len(runs), len(runs) - len(missing)) if visible else nullcontext(_show_nothing)
        _execute(missing, options, files.append, progress)
        return files.rows(runs)


def _to_stdout(runs: list[Run], options: argparse.Namespace) -> list[Row]:
    """Execute the runs, print their rows as they end, and return them."""
    rows: list[Row] = []

    def keep(record: Record) -> None:
        rows.append(record.row())
        emit(csv_line(rows[-1].values()))

    emit(csv_line(COLUMNS))
    visible = sys.stderr.isatty() and not sys.stdout.isatty() and not options.quiet  # rows and bar do not mix
    _execute(runs, options, keep, _bar(len(runs), 0) if visible else nullcontext(_show_nothing))
    return rows


def _execute(runs: list[Run], options: argparse.Namespace, keep: Show, progress: AbstractContextManager[Show]) -> None:
    if not runs:
        return
    execution = execute_all(runs, options.jobs) if options.dask is None else execute_on_cluster(runs, options.dask)
    failures: dict[str, list[Record]] = {}
    try:
        with _no_logs(), progress as show, closing(execution) as records:
            for record in records:
                if record.status in FAILURES:
                    failures.setdefault(record.status, []).append(record)
                keep(record)
                show(record)
    finally:
        for status, records_of_it in failures.items():
            say(one_line(_failure(status, records_of_it)))


def _failure(status: str, records: Sequence[Record]) -> str:
    """Say how many runs ended with this status, and why the first of them did."""
    first = records[0]
    instance = first.run.instance
    words = first.message.splitlines() or [f"exit code {first.exit_code}"]
    count = "1 run" if len(records) == 1 else f"{len(records)} runs"
    example = f"{instance.domain} {instance.problem}: {words[-1].removeprefix('error: ')}"
    return f"{count} with status {status}, {'first' if len(records) > 1 else 'of'} {example}"


@contextmanager
def _no_logs() -> Iterator[None]:
    """Keep what Dask logs off the terminal; what matters of it becomes an error or a record."""
    logging.disable(logging.CRITICAL)
    try:
        yield
    finally:
        logging.disable(logging.NOTSET)


def _show_nothing(_record: Record) -> None:
    """Show nothing, because nobody is there to see it."""


@contextmanager
def _bar(total: int, done: int) -> Iterator[Show]:
    """Show a progress bar on stderr that disappears in the end."""
    columns = (BarColumn(), MofNCompleteColumn(), TimeElapsedColumn(), TextColumn("left:"), TimeRemainingColumn())
    text = TextColumn("{task.description}", markup=False)
    statuses: Counter[str] = Counter()
    with Progress(*columns, text, console=Console(stderr=True), transient=True) as progress:
        task = progress.add_task("", total=total, completed=done)

        def show(record: Record) -> None:
            statuses[record.status] += 1
            counts = ", ".join(f"{count} {status}" for status, count in statuses.most_common())
            progress.update(task, advance=1, description=counts)

        yield show


def _summarise(rows: list[Row], options: argparse.Namespace) -> None:
    """Print the table by domain; where standard output has the rows, on standard error."""
    total = summary_of(rows, "in all", "")
    text = readable_summaries(summarise(rows), total)
    if total.errors and options.output is not None:
        text += f"\n\nwhat the errors were: '{Path(options.output).with_suffix('.jsonl')}' (message)"
    if options.output is None:
        say(text, raw=True)
    else:
        emit(text, raw=True)
