"""Problems from files; text to standard output, and files that are written whole or not at all."""

from __future__ import annotations

import argparse
import contextlib
import os
import stat
import sys
import tempfile
from pathlib import Path

from statehtn.errors import UsageError
from statehtn.hddl import read_hddl
from statehtn.model import Problem


def read_problem(options: argparse.Namespace) -> Problem:
    """Read the problem that the options name, with the costs that they name.

    Raises:
        StateHtnError: a file is wrong.
    """
    problem = read_hddl(options.domain, options.problem, strict=options.strict)
    if options.costs is None:
        return problem
    from statehtn.build.cost_file import read_costs  # few runs need it

    return read_costs(options.costs).apply(problem)


class OutputError(Exception):
    """A result could not be written (exit code 74)."""


def emit(text: str) -> None:
    """Print text and a newline on standard output; a reader that has gone away (`| head`) is no error.

    Raises:
        OutputError: standard output cannot be written, because the disk is full, say.
    """
    try:
        print(text, flush=True)
    except BrokenPipeError:
        _silence_stdout()
    except UnicodeEncodeError:
        sys.stdout.buffer.write(text.encode(sys.stdout.encoding or "ascii", "replace") + b"\n")
        sys.stdout.buffer.flush()
    except OSError as error:
        _silence_stdout()
        raise OutputError(f"cannot write to standard output: {error.strerror}") from error


def _silence_stdout() -> None:
    """Send what is still buffered nowhere, so that the interpreter does not try again when it ends."""
    with contextlib.suppress(OSError, ValueError):
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


def check_writable(name: str) -> None:
    """Find out early whether a file can be written, before time is spent on its content.

    Raises:
        UsageError: it cannot.
    """
    path = Path(name)
    if path.is_dir():
        raise UsageError(f"cannot write '{name}': it is a directory")
    if not path.parent.is_dir():
        raise UsageError(f"cannot write '{name}': there is no directory '{path.parent}'")
    if not os.access(path if path.exists() else path.parent, os.W_OK):
        raise UsageError(f"cannot write '{name}': permission denied")


def write_whole(name: str, text: str) -> None:
    """Write a file so that it holds all of the text, or what it held before.

    Raises:
        OutputError: the file cannot be written.
    """
    path = Path(os.path.realpath(name))  # of a symbolic link, the file it points to is replaced
    try:
        if path.exists() and not stat.S_ISREG(path.stat().st_mode):
            path.write_text(text, encoding="utf-8")  # a device or a pipe cannot be replaced
        else:
            _replace(path, text)
    except OSError as error:
        raise OutputError(f"cannot write '{name}': {error.strerror}") from error


def _replace(path: Path, text: str) -> None:
    """Write a temporary file beside the path, then rename it."""
    descriptor, name = tempfile.mkstemp(dir=path.parent, prefix=f".{path.name}.")
    temporary = Path(name)
    try:
        with open(descriptor, "w", encoding="utf-8") as file:
            file.write(text)
        temporary.chmod(_mode_for(path))
        temporary.replace(path)
    except BaseException:
        with contextlib.suppress(OSError):
            temporary.unlink()
        raise


def _mode_for(path: Path) -> int:
    """Return the permissions of the file that is there, or those of a new file."""
    if path.exists():
        return stat.S_IMODE(path.stat().st_mode)
    mask = os.umask(0)
    os.umask(mask)
    return 0o666 & ~mask
