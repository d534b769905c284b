"""`statehtn plan`: plan, and print the result in the form that was asked for."""

from __future__ import annotations

import argparse
import json

from statehtn.cli.exit_codes import EXIT_CODES, ExitCode
from statehtn.cli.files import OutputError, check_writable, emit, write_whole
from statehtn.cli.progress import ProgressLine
from statehtn.effort import Statistics
from statehtn.hddl.plan_format import write_plan
from statehtn.model.status import Status
from statehtn.planner import no_plan, plan_files
from statehtn.query import Query
from statehtn.result import Result


def run_plan(options: argparse.Namespace) -> ExitCode:
    """Run the command and return its exit code.

    Raises:
        StateHtnError: the options or the input are wrong.
        OutputError: the plan was found and printed, but could not be written to a file.
    """
    query = Query.of(
        attitude=options.attitude,
        alpha=options.alpha,
        solver=options.solver,
        heuristic=options.heuristic,
        search=options.search,
        weight=options.weight,
        branch=options.branch,
    )
    if options.output is not None:
        check_writable(options.output)
    problem = None
    try:
        with ProgressLine(silent=options.quiet) as progress:
            result, problem = plan_files(
                options.domain,
                options.problem,
                query,
                strict=options.strict,
                costs=options.costs,
                time_limit=options.time_limit,
                memory_limit=options.memory_limit,
                progress=progress.callback,
            )
    except KeyboardInterrupt:  # between two phases
        result = no_plan(query, Status.INTERRUPTED, Statistics())
    failure = None
    if options.output is not None and problem is not None and result.plan is not None:
        try:
            write_whole(options.output, write_plan(result.plan, problem))
        except OutputError as error:
            failure = error  # the plan must not be lost: print it first
    _print(result, options)
    if failure is not None:
        raise failure
    return EXIT_CODES[result.status]


def _print(result: Result, options: argparse.Namespace) -> None:
    if options.json:
        emit(json.dumps(result.to_dict(), allow_nan=False))
    elif options.quiet:
        if result.steps:
            emit("\n".join(str(priced.step) for priced in result.steps))
    else:
        from statehtn.cli.tables import readable_result

        emit(readable_result(result))
