"""The files of an experiment: one row for each run in a CSV file, and everything else in JSON Lines beside it."""

from __future__ import annotations

import csv
import io
import json
import os
import shutil
from collections.abc import Collection, Iterable, Sequence
from contextlib import ExitStack, closing
from pathlib import Path
from types import TracebackType

from statehtn.errors import UsageError
from statehtn.experiments.records import COLUMNS, KEY_COLUMNS, Record, Row
from statehtn.experiments.run import Run

Key = tuple[str, ...]
Limits = tuple[float | None, float | None]
JSON_START = '{"key": ["'


def csv_line(values: Iterable[str]) -> str:
    """Return a line of a CSV file, without its newline."""
    buffer = io.StringIO()
    csv.writer(buffer, lineterminator="").writerow(values)
    return buffer.getvalue()


class RecordFiles:
    """The two files, open for more records; a run is done when its row is in the CSV file.

    The JSON is written before the row, and each is written at once: if the process is killed in between, the run is
    done again, and its last JSON counts. An incomplete line at the end of a file is dropped when it is opened.

    Args:
        name: the CSV file; that of JSON Lines has `.jsonl` for its suffix.

    Raises:
        UsageError: a file cannot be written, is being written by another process, or holds something else.
    """

    def __init__(self, name: str) -> None:
        self.name = name
        self.json_name = str(Path(name).with_suffix(".jsonl"))
        if Path(name) == Path(self.json_name):
            raise UsageError(f"'{name}' is the name of the file beside the table; choose another, such as *.csv")
        with ExitStack() as opened:
            self._csv = opened.enter_context(closing(_LineFile(name, csv_line(COLUMNS))))
            self._json = opened.enter_context(closing(_LineFile(self.json_name, JSON_START)))
            self._rows = self._read_rows()
            self._limits = self._read_limits()
            self._csv.drop_incomplete_line()
            self._json.drop_incomplete_line()
            if not self._csv.lines:
                self._csv.append(csv_line(COLUMNS))
            self._opened = opened.pop_all()

    def __enter__(self) -> RecordFiles:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._opened.close()

    def missing(self, runs: Sequence[Run]) -> list[Run]:
        """Return those of the runs that are still to be done.

        Raises:
            UsageError: runs with other limits are in the table; what they tell must not be mixed.
        """
        self._check_limits(runs)
        return [run for run in runs if run.key not in self._rows]

    def forget(self, runs: Iterable[Run], statuses: Collection[str]) -> None:
        """Drop the rows of those of the runs that ended with one of these statuses, so that they are missing again.

        Raises:
            UsageError: runs with other limits are in the table.
            OSError: the table cannot be written; it is as it was.
        """
        self._check_limits(runs)
        ended = {run.key for run in runs if run.key in self._rows and self._rows[run.key]["status"] in statuses}
        if not ended:
            return
        self._rows = {key: row for key, row in self._rows.items() if key not in ended}
        self._csv.replace([csv_line(COLUMNS), *(csv_line(row.values()) for row in self._rows.values())])

    def rows(self, runs: Iterable[Run]) -> list[Row]:
        """Return the rows of those of the runs that are done."""
        return [self._rows[run.key] for run in runs if run.key in self._rows]

    def append(self, record: Record) -> None:
        """Write a record to both files.

        Raises:
            OSError: it cannot be written.
        """
        row = record.row()
        self._json.append(json.dumps(record.to_dict(), allow_nan=False))
        self._csv.append(csv_line(row.values()))
        self._rows[record.run.key] = row

    def _check_limits(self, runs: Iterable[Run]) -> None:
        asked = {(run.time_limit, run.memory_limit) for run in runs}
        for key, limits in self._limits.items():
            if key in self._rows and limits not in asked:
                raise UsageError(
                    f"the runs in '{self.name}' have {_limits_text(limits)}, those to be done "
                    f"{' or '.join(map(_limits_text, asked))}; choose the same limits or another --output"
                )

    def _read_rows(self) -> dict[Key, Row]:
        rows = {}
        for number, values in enumerate(csv.reader(self._csv.lines), 1):
            if len(values) != len(COLUMNS) or (number == 1 and tuple(values) != COLUMNS):
                raise UsageError(f"line {number} of '{self.name}' is none of a comparison's; choose another --output")
            if number > 1:
                rows[tuple(values[: len(KEY_COLUMNS)])] = dict(zip(COLUMNS, values, strict=True))
        return rows

    def _read_limits(self) -> dict[Key, Limits]:
        limits = {}
        for number, line in enumerate(self._json.lines, 1):
            try:
                record = json.loads(line)
                limits[tuple(record["key"])] = (record["run"]["time_limit"], record["run"]["memory_limit"])
            except (ValueError, KeyError, TypeError):
                message = f"line {number} of '{self.json_name}' is no record of a run; choose another --output"
                raise UsageError(message) from None
        return limits


class _LineFile:
    """A text file to which whole lines are appended; not to be changed by two processes at once.

    Args:
        name: the file; it is made if it is not there.
        start: how its content begins, if it has any.

    Raises:
        UsageError: it cannot be written, is open in another process, or begins otherwise.
    """

    def __init__(self, name: str, start: str) -> None:
        self.name = name
        if Path(name).exists() and not Path(name).is_file():
            raise UsageError(f"cannot write '{name}': it is no regular file")
        try:
            self._file = open(name, "a+b", buffering=0)  # noqa: SIM115 - it stays open
        except OSError as error:
            raise UsageError(f"cannot write '{name}': {error.strerror}") from None
        with ExitStack() as opened:
            opened.callback(self._file.close)
            self._whole, self.lines = self._read(start)
            opened.pop_all()

    def _read(self, start: str) -> tuple[int, list[str]]:
        """Lock the file; return how many bytes its whole lines are, and the lines."""
        if not _lock(self._file.fileno()):
            raise UsageError(f"cannot write '{self.name}': another comparison is writing it")
        self._file.seek(0)
        content = self._file.readall()
        if not content.startswith(start.encode()) and not start.encode().startswith(content):
            raise UsageError(f"'{self.name}' holds something else than a comparison's results; choose another --output")
        whole = content.rfind(b"\n") + 1
        return whole, content[:whole].decode(errors="surrogateescape").split("\n")[:-1]

    def drop_incomplete_line(self) -> None:
        """Cut off a last line that has no end."""
        self._file.truncate(self._whole)

    def append(self, line: str) -> None:
        """Write a line, and wait until the disk has it."""
        _write(self._file, f"{line}\n")

    def replace(self, lines: Iterable[str]) -> None:
        """Write these lines in the place of all; the file holds the old ones until it holds all of the new ones.

        The new file is locked before it gets the name, and the old one stays locked until then.
        """
        path = Path(os.path.realpath(self.name))  # of a symbolic link, the file it points to is replaced
        new = path.with_name(f".{path.name}.new")
        file = open(new, "w+b", buffering=0)  # noqa: SIM115 - it stays open
        try:
            shutil.copymode(path, new)
            _lock(file.fileno())
            _write(file, "".join(f"{line}\n" for line in lines))
            new.replace(path)
        except OSError:
            file.close()
            new.unlink(missing_ok=True)
            raise
        self._file.close()
        self._file = file

    def close(self) -> None:
        """Close the file and give up the lock."""
        self._file.close()


def _write(file: io.FileIO, text: str) -> None:
    """Write a text at the end of a file, and wait until the disk has it."""
    data = memoryview(text.encode(errors="surrogateescape"))
    while data:
        data = data[file.write(data) :]
    os.fsync(file.fileno())


def _lock(descriptor: int) -> bool:
    """Lock a file until it is closed or the process ends; False if another process has done so."""
    try:
        import fcntl
    except ImportError:  # not a POSIX system: the user must take care
        return True
    try:
        fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        return False
    except OSError:  # a file system without locks
        return True
    return True


def _limits_text(limits: Limits) -> str:
    seconds, megabytes = limits
    time = "no time limit" if seconds is None else f"a time limit of {seconds:g} s"
    return f"{time} and " + ("no memory limit" if megabytes is None else f"a memory limit of {megabytes:g} MB")
