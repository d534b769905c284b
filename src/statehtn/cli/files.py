"""Problems from files, and files for results: whole or not at all, and never that of an earlier run."""

from __future__ import annotations

import argparse
import contextlib
import errno
import os
import select
import stat
import tempfile
import time
from collections.abc import Iterable, Iterator
from pathlib import Path

from statehtn.cli.streams import OutputError, emit_file
from statehtn.errors import UsageError
from statehtn.hddl import read_hddl
from statehtn.limits import SECONDS_BETWEEN_LOOKS, LimitReached, Limits, watched
from statehtn.model import Problem
from statehtn.streams import own_descriptor

STDOUT = "-"
TEMPORARY = ".statehtn-"


def read_problem(options: argparse.Namespace, limits: Limits = Limits()) -> Problem:
    """Read the problem that the options name, with the costs that they name.

    Raises:
        StateHtnError: a file is wrong, or one that the costs are read from is the output.
        LimitReached: a limit was reached.
    """
    with watched(limits, ends_imports=options.is_process):
        problem = read_hddl(options.domain, options.problem, strict=options.strict, limits=limits)
        if options.costs is None:
            return problem
        from statehtn.build.cost_file import read_costs  # few runs need it

        table = read_costs(options.costs, limits)
        if (output := getattr(options, "output", None)) is not None:
            _refuse_inputs(output, table.files)
        return table.apply(problem)


class OutputFile:
    """Where a result goes: a regular file, which is replaced; a pipe or a device; `-` for standard output.

    A regular file holds a whole result at any moment, or nothing. A pipe or a device takes one result, once.

    Args:
        name: as it stands on the command line.
        inputs: the files that the run reads; None for those that are not asked for.

    Raises:
        UsageError: it is one of the inputs, or cannot be written, and that is plain before time is spent on what it is
            to hold.
        OutputError: the system does not take this name, because it is too long, say.
    """

    def __init__(self, name: str, inputs: Iterable[str | None] = ()) -> None:
        if not name:
            raise UsageError("the name of the file to write is empty")
        if name.endswith(os.sep):
            raise UsageError(f"cannot write '{name}': it is the name of a directory")
        self.name = name
        self.path = Path(os.path.realpath(name))  # of a symbolic link, the file it points to is replaced
        self.descriptor = 1 if name == STDOUT else own_descriptor(name)
        self.is_regular = False
        if self.descriptor is not None:
            return
        with self._failing():
            mode = _mode(self.path)
        self.is_regular = mode is None or stat.S_ISREG(mode)
        if mode is not None and stat.S_ISDIR(mode):
            raise UsageError(f"cannot write '{name}': it is a directory")
        if not self.path.parent.is_dir():
            raise UsageError(f"cannot write '{name}': there is no directory '{Path(name).parent}'")
        if not os.access(self.path.parent if mode is None else self.path, os.W_OK):
            raise UsageError(f"cannot write '{name}': permission denied")
        if self.is_regular:
            _refuse_inputs(name, inputs)

    @property
    def is_stdout(self) -> bool:
        """Whether it is standard output."""
        return self.descriptor == 1

    def write(self, text: str, limits: Limits = Limits()) -> None:
        """Write a result; a regular file holds what it held before until it holds all of the text.

        Raises:
            OutputError: it cannot be written; a pipe also where nobody has read it when a limit is reached.
        """
        if self.is_stdout:
            emit_file(text)
            return
        with self._failing(), contextlib.suppress(BrokenPipeError):  # who reads no more has what it wants
            if self.descriptor is not None:
                _write_when_read(os.dup(self.descriptor), text, limits)
            elif self.is_regular and os.access(self.path.parent, os.W_OK):
                _replace(self.path, text)
            else:
                _write_when_read(_opened_when_read(self.path, limits), text, limits)

    def remove(self) -> None:
        """Remove the file of an earlier run; pipes and devices stay.

        Raises:
            OutputError: it cannot be removed.
        """
        with self._failing():
            if self.is_regular and _mode(self.path) is not None:
                self.path.unlink()

    @contextlib.contextmanager
    def _failing(self) -> Iterator[None]:
        try:
            yield
        except OSError as error:
            raise OutputError(f"cannot write '{self.name}': {error.strerror}") from error
        except (LimitReached, KeyboardInterrupt) as ending:
            if self.is_regular:  # which nobody waits for
                raise
            raise OutputError(f"cannot write '{self.name}': nobody reads it") from ending


def _refuse_inputs(output: str, inputs: Iterable[str | None]) -> None:
    """Raise a `UsageError` if the output is one of the inputs."""
    for name in inputs:
        if name is not None and _are_one(output, name):
            raise UsageError(f"'{output}' would replace the input '{name}'; choose another name")


def _are_one(first: str, second: str) -> bool:
    """Tell whether two names are those of one file, be it that there is none yet."""
    with contextlib.suppress(OSError, ValueError):  # one is not there, or can be the name of no file
        return os.path.realpath(first) == os.path.realpath(second) or Path(first).samefile(second)
    return False


def _mode(path: Path) -> int | None:
    """Return what kind of file is there, and with which permissions; None where there is none."""
    try:
        return path.stat().st_mode
    except (FileNotFoundError, NotADirectoryError):
        return None


def _write(descriptor: int, text: str) -> None:
    """Write a text to an open file, and close it."""
    with open(descriptor, "wb") as file:
        file.write(text.encode())


def _opened_when_read(path: Path, limits: Limits) -> int:
    """Open a file that is there; a pipe once somebody reads it."""
    while True:
        try:
            return os.open(path, os.O_WRONLY | os.O_TRUNC | os.O_NONBLOCK)
        except OSError as error:
            if error.errno != errno.ENXIO:
                raise
        limits.check()
        time.sleep(SECONDS_BETWEEN_LOOKS)


def _write_when_read(descriptor: int, text: str, limits: Limits) -> None:
    """Write a text to an open file, piece by piece as somebody takes it, and close it."""
    left = memoryview(text.encode())
    poll = select.poll()
    poll.register(descriptor, select.POLLOUT)
    try:
        while left:
            if poll.poll(1000 * SECONDS_BETWEEN_LOOKS):
                left = left[os.write(descriptor, left[: select.PIPE_BUF]) :]  # so many never wait
            else:
                limits.check()
    finally:
        os.close(descriptor)


def _replace(path: Path, text: str) -> None:
    """Put a new file in the place of one that is there, or of none; it has all of the text before it has the name."""
    mode = _mode(path)
    permissions = _default_permissions() if mode is None else stat.S_IMODE(mode)
    try:
        _replace_by_nameless_file(path, text, permissions, mode is None)
    except (AttributeError, OSError):  # not Linux, or a file system that does not know such files
        descriptor, name = tempfile.mkstemp(dir=path.parent, prefix=TEMPORARY)
        temporary = Path(name)
        with _removed_on_failure(temporary):
            _write(descriptor, text)
            temporary.chmod(permissions)
            temporary.replace(path)


def _replace_by_nameless_file(path: Path, text: str, permissions: int, is_new: bool) -> None:
    """Write a file that has no name until it is whole, so that nothing stays of it when the process is killed."""
    folder = os.open(path.parent, os.O_RDONLY)
    try:
        with open(os.open(path.parent, os.O_WRONLY | os.O_TMPFILE, 0o600), "wb") as file:
            file.write(text.encode())
            file.flush()
            os.fchmod(file.fileno(), permissions)
            source = f"/proc/self/fd/{file.fileno()}"
            if is_new:
                with contextlib.suppress(FileExistsError):  # it has come meanwhile
                    os.link(source, path, src_dir_fd=folder, follow_symlinks=True)
                    return
            temporary = path.with_name(f"{TEMPORARY}{os.getpid()}")  # a link does not replace another one, a name does
            temporary.unlink(missing_ok=True)
            with _removed_on_failure(temporary):
                os.link(source, temporary, src_dir_fd=folder, follow_symlinks=True)
                temporary.replace(path)
    finally:
        os.close(folder)


@contextlib.contextmanager
def _removed_on_failure(path: Path) -> Iterator[None]:
    try:
        yield
    except BaseException:
        path.unlink(missing_ok=True)
        raise


def _default_permissions() -> int:
    mask = os.umask(0)
    os.umask(mask)
    return 0o666 & ~mask
