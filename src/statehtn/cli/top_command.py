"""`statehtn top`: find the best plans, and print them in the form that was asked for."""

from __future__ import annotations

import argparse
import json
import os
from functools import partial
from pathlib import Path

from statehtn.cli.exit_codes import EXIT_CODES, ExitCode
from statehtn.cli.files import STDOUT, OutputFile, read_problem
from statehtn.cli.progress import ProgressLine
from statehtn.cli.shared_options import objective_in
from statehtn.cli.signals import let_finish
from statehtn.cli.streams import OutputError, emit, emit_lines
from statehtn.effort import Meter
from statehtn.errors import UsageError
from statehtn.hddl.plan_format import write_plan
from statehtn.limits import Limits
from statehtn.model.problem import Problem
from statehtn.model.status import Status
from statehtn.pipeline import solve_top
from statehtn.session import Session
from statehtn.settings import TopSettings
from statehtn.top_result import TopPlans


def run_top(options: argparse.Namespace) -> ExitCode:
    """Run the command and return its exit code.

    Raises:
        StateHtnError: the options or the input are wrong.
        OutputError: plans were found and printed, but could not be written to files.
    """
    settings = TopSettings.of(
        options.k,
        objective_in(options),
        distinct=options.distinct,
        heuristic=options.heuristic,
        keep=options.keep,
        precision=options.precision,
    )
    if options.output is not None:
        _check_folder(options.output)
    limits = Limits.starting_now(options.time_limit, options.memory_limit)
    session = Session(partial(read_problem, options))
    try:
        with ProgressLine(silent=options.quiet) as progress:
            result = solve_top(session, settings, limits, progress.show_top if progress.visible else None)
    except KeyboardInterrupt:  # between two phases
        result = TopPlans(Status.INTERRUPTED, settings, Meter().read(), Status.INTERRUPTED)
    let_finish()
    failure = None
    if options.output is not None and session.problem is not None and result.plans:
        try:
            _write(result, session.problem, Path(options.output))
        except OutputError as error:
            failure = error  # the plans must not be lost: print them first
    _print(result, options)
    if failure is not None:
        raise failure
    return EXIT_CODES[result.status]


def _check_folder(name: str) -> None:
    """Find out early whether the plans can be written into the folder.

    Raises:
        UsageError: they cannot, or would lie among those of another run.
        OutputError: the system does not take this name.
    """
    if name == STDOUT:
        raise UsageError("--output of 'top' is a folder with a file for each plan; --quiet prints each plan on a line")
    folder = Path(name)
    if not os.path.isdir(name):  # noqa: PTH112 - Path.is_dir fails where a name is too long
        OutputFile(name.rstrip(os.sep))
        if folder.exists():
            raise UsageError(f"cannot write plans into '{name}': it is not a directory")
        return
    if old := min(folder.glob("plan-*.txt"), default=None):
        raise UsageError(f"'{name}' holds plans already ('{old.name}'); name another folder, or remove them")
    OutputFile(str(folder / "plan-1.txt"))


def _write(result: TopPlans, problem: Problem, folder: Path) -> None:
    """Write every plan to a file of its own.

    Raises:
        OutputError: one cannot be written.
    """
    try:
        folder.mkdir(exist_ok=True)
    except OSError as error:
        raise OutputError(f"cannot write '{folder}': {error.strerror}") from error
    digits = len(str(len(result)))
    for ranked in result:
        file = OutputFile(str(folder / f"plan-{ranked.rank:0{digits}}.txt"))
        file.write(write_plan(ranked.plan, problem))


def _print(result: TopPlans, options: argparse.Namespace) -> None:
    if options.json:
        emit(json.dumps(result.to_dict(), allow_nan=False))
    elif options.quiet:
        emit_lines(" ".join(str(priced.step) for priced in ranked.steps) for ranked in result)
    else:
        from statehtn.display.top_plans import readable_top_plans

        emit(readable_top_plans(result), raw=True)
