"""What is said on standard output and standard error, whatever has become of them: closed, full, or read no more."""

from __future__ import annotations

import contextlib
import os
import shutil
import sys
from collections.abc import Callable, Iterable, Iterator
from typing import TextIO

from statehtn.errors import printable

CLEAR_LINE = "\r\x1b[K"


class OutputError(Exception):
    """A result could not be written (exit code 74)."""


def reopen_closed_streams() -> None:
    """Let standard streams that were closed before the program began lead nowhere.

    Otherwise a file that is opened later takes the number of one, and what is said goes there.
    """
    for descriptor, name in enumerate(("stdin", "stdout", "stderr")):
        try:
            os.fstat(descriptor)
        except OSError:
            opened = os.open(os.devnull, os.O_RDWR)
            if opened == descriptor:
                os.set_inheritable(descriptor, True)
            else:
                os.dup2(opened, descriptor)
                os.close(opened)
        if getattr(sys, name) is None:
            mode = "r" if descriptor == 0 else "w"
            stream = open(descriptor, mode, encoding="utf-8", errors="backslashreplace", closefd=False)  # noqa: SIM115
            setattr(sys, name, stream)


def emit(text: str, *, raw: bool = False) -> None:
    """Print text and a newline on standard output; a reader that has gone away (`| head`) is no error.

    Args:
        text: control characters in it are shown as escapes.
        raw: print it as it is, such as text with colours.

    Raises:
        OutputError: standard output cannot be written, because the disk is full, say.
    """
    _to_stdout(lambda stream: _print(text if raw else printable(text), stream))


def emit_file(text: str) -> None:
    """Write the content of a file to standard output, as `emit` does, but nothing else than its bytes.

    Raises:
        OutputError: standard output cannot be written.
    """

    def write(stream: TextIO) -> None:
        stream.flush()
        if hasattr(stream, "buffer"):
            stream.buffer.write(text.encode())
            stream.buffer.flush()
        else:  # a stream of text alone has taken the place of standard output
            stream.write(text)

    _to_stdout(write)


def emit_lines(lines: Iterable[str]) -> None:
    """Print lines for other programs on standard output: in UTF-8, as files are, whatever the terminal's encoding.

    Raises:
        OutputError: standard output cannot be written.
    """
    emit_file("".join(f"{printable(line)}\n" for line in lines))


def _print(text: str, stream: TextIO) -> None:
    try:
        print(text, file=stream, flush=True)
    except UnicodeEncodeError:
        encoding = stream.encoding or "ascii"
        print(text.encode(encoding, "replace").decode(encoding), file=stream, flush=True)


def _to_stdout(write: Callable[[TextIO], None]) -> None:
    try:
        write(sys.stdout)
    except BrokenPipeError:
        _silence(sys.stdout)
    except OSError as error:
        _silence(sys.stdout)
        raise OutputError(f"cannot write to standard output: {error.strerror}") from error


def say(text: str, *, raw: bool = False) -> None:
    """Print lines on standard error, above the progress line where there is one; if nobody can hear it, so be it.

    Args:
        text: control characters in it are shown as escapes.
        raw: print it as it is, such as text with colours.
    """
    with _to_stderr():
        print(f"{CLEAR_LINE if _progress else ''}{text if raw else printable(text)}", file=sys.stderr)
        sys.stderr.write(_progress)
        sys.stderr.flush()


_progress = ""
"""What stands in the last line of the terminal now, to be drawn anew below what is said."""


def show_progress(text: str) -> None:
    """Write over the last line of the terminal on standard error; an empty text removes it."""
    global _progress
    width = shutil.get_terminal_size().columns
    _progress = printable(text).replace("\n", " ")[: max(1, width - 1)]
    with _to_stderr():
        sys.stderr.write(CLEAR_LINE + _progress)
        sys.stderr.flush()


@contextlib.contextmanager
def _to_stderr() -> Iterator[None]:
    """Silence standard error for good where it cannot be written."""
    try:
        yield
    except OSError:
        _silence(sys.stderr)


def _silence(stream: TextIO) -> None:
    """Send what is still buffered nowhere, so that the interpreter does not try again when it ends."""
    with contextlib.suppress(OSError, ValueError):
        nowhere = os.open(os.devnull, os.O_WRONLY)
        os.dup2(nowhere, stream.fileno())
        os.close(nowhere)
