"""`statehtn atlas`: write a page about one problem's best plans for every attitude to risk."""

from __future__ import annotations

import argparse
import json
import time

from statehtn.atlas import survey
from statehtn.cli.exit_codes import EXIT_CODES, ExitCode
from statehtn.cli.files import OutputFile, read_problem
from statehtn.cli.progress import ProgressLine
from statehtn.cli.signals import let_finish
from statehtn.cli.streams import emit, say
from statehtn.counted import counted
from statehtn.errors import UsageError, one_line
from statehtn.limits import Limits


def run_atlas(options: argparse.Namespace) -> ExitCode:
    """Run the command and return its exit code.

    Raises:
        StateHtnError: the options or the input are wrong, or a package is missing.
        LimitReached: a limit was reached before the input was read.
        OutputError: the page cannot be written.
    """
    if options.output is None and not options.json:
        raise UsageError("write the page with --output FILE.html, or print its data with --json")
    output = None
    if options.output is not None:
        from statehtn.display.atlas.page import (
            check_packages,  # before hours are spent on a page that cannot be written
        )

        check_packages()
        output = OutputFile(options.output, (options.domain, options.problem, options.costs))
        if output.is_stdout and options.json:
            raise UsageError("both --json and the page would go to standard output; leave out one of them")
    started = time.monotonic()
    problem = read_problem(options, Limits.starting_now(options.time_limit, options.memory_limit))
    left = None if options.time_limit is None else max(options.time_limit - (time.monotonic() - started), 1e-3)
    with ProgressLine() as progress:
        atlas = survey(
            problem,
            options.alpha_from,
            options.alpha_to,
            time_limit=left,
            memory_limit=options.memory_limit,
            progress=progress.callback,
        )
    let_finish()
    if options.json:
        emit(json.dumps(atlas.to_dict(), allow_nan=False))
    if output is not None:
        page = atlas.to_html()
        output.write(page)
        if not output.is_stdout:
            sizes = f"{counted(len(atlas.plans), 'plan')}, {len(page.encode()) / 1000:.0f} kB"
            (say if options.json else emit)(f"{one_line(options.output)}: {sizes}; the map is {atlas.status}")
    return ExitCode.SUCCESS if atlas.map.pieces else EXIT_CODES[atlas.status]
