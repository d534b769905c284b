"""Entry point of the command line: every ending becomes an exit code, and every mistake one line on stderr."""

from __future__ import annotations

import argparse
import os
import signal
import sys
import threading
import traceback
import warnings
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress
from types import FrameType

from statehtn.cli.arguments import parse_arguments
from statehtn.cli.exit_codes import ExitCode
from statehtn.cli.files import OutputError
from statehtn.cli.plan_command import run_plan
from statehtn.cli.validate_command import run_validate
from statehtn.errors import ClusterError, StateHtnError, UnsupportedError, UsageError


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command line and return its exit code; `arguments` are those after the program's name."""
    with _terminate_as_interrupt(), _warnings_as_lines():
        try:
            options = parse_arguments(sys.argv[1:] if arguments is None else arguments)
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
        case "top":
            from statehtn.cli.top_command import run_top  # what it needs would slow down the others

            return run_top(options)
        case "validate":
            return run_validate(options)
        case "compare-attitudes":
            from statehtn.cli.attitudes_command import run_compare_attitudes

            return run_compare_attitudes(options)
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
    with suppress(OSError):  # nobody is left to tell
        if os.environ.get("STATEHTN_DEBUG"):
            traceback.print_exc()
        print(line, file=sys.stderr, flush=True)
    return code


@contextmanager
def _terminate_as_interrupt() -> Iterator[None]:
    """Treat SIGTERM as Ctrl-C, so that a batch system's stop ends in a result, too."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return

    def interrupt(_signal: int, _frame: FrameType | None) -> None:
        raise KeyboardInterrupt

    previous = signal.signal(signal.SIGTERM, interrupt)
    try:
        yield
    finally:
        signal.signal(signal.SIGTERM, previous)


@contextmanager
def _warnings_as_lines() -> Iterator[None]:
    """Show warnings about the input as lines on stderr."""

    def show(message: Warning | str, *_: object, **__: object) -> None:
        with suppress(OSError):  # nobody is left to tell
            print(f"warning: {message}", file=sys.stderr)

    with warnings.catch_warnings():
        warnings.simplefilter("always", UserWarning)
        warnings.showwarning = show
        yield
