"""Entry point of the command line: every ending becomes an exit code, and every mistake one line on stderr."""

from __future__ import annotations

import argparse
import os
import sys
import traceback
import warnings
from collections.abc import Iterator, Sequence
from contextlib import contextmanager

from statehtn.cli.arguments import make_parser, parse_arguments
from statehtn.cli.exit_codes import EXIT_CODES, ExitCode
from statehtn.cli.plan_command import run_plan
from statehtn.cli.signals import signals_as_interrupt
from statehtn.cli.streams import OutputError, reopen_closed_streams, say
from statehtn.errors import ClusterError, StateHtnError, UnsupportedError, UsageError, one_line
from statehtn.limits import LimitReached


def main(arguments: Sequence[str] | None = None, *, is_process: bool = False) -> int:
    """Run the command line and return its exit code.

    Args:
        arguments: those after the program's name; by default those that it was called with.
        is_process: the process ends with the command, so that a limit may leave modules half imported.
    """
    with signals_as_interrupt(), _warnings_as_lines():
        reopen_closed_streams()
        try:
            options = parse_arguments(sys.argv[1:] if arguments is None else arguments)
            options.is_process = is_process
            return int(_run(options))
        except SystemExit as request:  # --help and --version
            return request.code if isinstance(request.code, int) else ExitCode.SUCCESS
        except BaseException as error:
            return int(_explain(error))


def _run(options: argparse.Namespace) -> ExitCode:
    """Run the command that was asked for."""
    match options.command:
        case "plan":
            return run_plan(options)
        case "policy":
            from statehtn.cli.policy_command import run_policy  # what it needs would slow down the others

            return run_policy(options)
        case "export":
            from statehtn.cli.export_command import run_export

            return run_export(options)
        case "top":
            from statehtn.cli.top_command import run_top  # what it needs would slow down the others

            return run_top(options)
        case "validate":
            from statehtn.cli.validate_command import run_validate

            return run_validate(options)
        case "check":
            from statehtn.cli.check_command import run_check

            return run_check(options)
        case "why":
            from statehtn.cli.why_command import run_why

            return run_why(options)
        case "compare-attitudes":
            from statehtn.cli.attitudes_command import run_compare_attitudes

            return run_compare_attitudes(options)
        case "atlas":
            from statehtn.cli.atlas_command import run_atlas  # what it needs would slow down the others

            return run_atlas(options)
        case "attitude":
            from statehtn.cli.attitude_command import run_attitude

            return run_attitude(options)
        case "completion":
            from statehtn.cli.completion_command import run_completion

            return run_completion(options, make_parser())
        case "graph":
            from statehtn.cli.graph_command import run_graph  # what it needs would slow down the others

            return run_graph(options)
        case "report":
            from statehtn.cli.report_command import run_report  # what it needs would slow down the others

            return run_report(options)
        case _:
            from statehtn.cli.compare_command import run_compare  # what it needs would slow down the others

            return run_compare(options)


def _explain(error: BaseException) -> ExitCode:
    """Say in one line what went wrong, and return the exit code for it."""
    match error:
        case UsageError():
            return _complain(ExitCode.USAGE, f"error: {error}")
        case UnsupportedError():
            return _complain(ExitCode.UNSUPPORTED, f"error: {error}")
        case ClusterError():
            return _complain(ExitCode.CLUSTER_ERROR, f"error: {error}")
        case StateHtnError():
            return _complain(ExitCode.INPUT_ERROR, f"error: {error}")
        case OutputError():
            return _complain(ExitCode.OUTPUT_ERROR, f"error: {error}")
        case LimitReached():
            return _complain(EXIT_CODES[error.status], f"error: {error}")
        case KeyboardInterrupt():
            return _complain(ExitCode.INTERRUPTED, "interrupted")
        case MemoryError():
            return _complain(ExitCode.MEMORY_LIMIT, "error: the memory is used up")
        case RecursionError():
            return _complain(ExitCode.UNSUPPORTED, "error: the input is nested too deeply")
        case _:
            summary = " ".join(f"{type(error).__name__}: {error}".split())
            return _complain(
                ExitCode.INTERNAL_ERROR,
                f"internal error: {summary}; this is a mistake in statehtn, please report it with the input "
                "(STATEHTN_DEBUG=1 shows the traceback)",
            )


def _complain(code: ExitCode, line: str) -> ExitCode:
    """Write a line to stderr, after the traceback where STATEHTN_DEBUG asks for it."""
    if os.environ.get("STATEHTN_DEBUG"):
        say(traceback.format_exc())
    say(one_line(line))
    return code


@contextmanager
def _warnings_as_lines() -> Iterator[None]:
    """Show warnings about the input as lines on stderr."""

    def show(message: Warning | str, *_: object, **__: object) -> None:
        say(one_line(f"warning: {message}"))

    with warnings.catch_warnings():
        warnings.simplefilter("always", UserWarning)
        warnings.showwarning = show
        yield
