"""Execute runs, each in a process of its own, so that a crash, a limit or a kill of one harms no other."""

from __future__ import annotations

import json
import os
import platform
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Generator, Iterable
from concurrent.futures import CancelledError, ThreadPoolExecutor, as_completed
from contextlib import suppress
from typing import Any

import statehtn
from statehtn.experiments.records import Record
from statehtn.experiments.run import Run
from statehtn.limits import resident_mb

GRACE_SECONDS = 10.0
GRACE_MEGABYTES = 200.0
GRACE_SHARE = 0.1
"""A run is killed when it has overrun a limit by so many seconds, or megabytes, and this share of the limit.

The planner keeps its limits itself, and then tells what it knows by then; this is for the day when it does not. Memory
is watched where the system tells it (Linux). A limit on the address space would be none on memory: much is reserved
that is never used.
"""
WATCH_SECONDS = 0.2
STATUSES_WITHOUT_RESULT = {
    21: "memory-limit",
    30: "input-error",
    31: "unsupported",
    130: "interrupted",
    -signal.SIGINT: "interrupted",
    -signal.SIGTERM: "interrupted",
    -signal.SIGHUP: "interrupted",
}
"""The status of a run that has printed no result, by its exit code (`docs/exit-codes.md`); of all others, `error`."""
MESSAGE_LENGTH = 4000


class Children:
    """The processes that are running, so that all of them can be ended at once, and no other starts after that."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._running: set[subprocess.Popen[str]] = set()
        self._stopped = False

    def start(self, arguments: list[str], pipe: int) -> subprocess.Popen[str]:
        """Start `statehtn` with these arguments; it ends, too, when nobody has the other end of the pipe any more.

        Raises:
            CancelledError: `stop` has been called.
        """
        with self._lock:
            if self._stopped:
                raise CancelledError
            process = subprocess.Popen(
                [sys.executable, "-m", "statehtn.experiments.child", *arguments],
                stdin=pipe,
                stdout=subprocess.PIPE,
                stderr=subprocess.PIPE,
                encoding="utf-8",
                errors="replace",
                start_new_session=True,  # Ctrl-C is for the runner, which ends its children itself
            )
            self._running.add(process)
            return process

    def ended(self, process: subprocess.Popen[str]) -> None:
        """Forget a process."""
        with self._lock:
            self._running.discard(process)

    @property
    def stopped(self) -> bool:
        """Whether `stop` has been called."""
        return self._stopped

    def stop(self) -> None:
        """Kill all that are running."""
        with self._lock:
            self._stopped = True
            for process in self._running:
                process.kill()


def execute(run: Run, children: Children | None = None) -> Record:
    """Execute a run in a process of its own and return what has come of it; `children` can end it early.

    Raises:
        CancelledError: they have.
        OSError: no process can be started.
    """
    children = Children() if children is None else children
    start = time.perf_counter()
    reading, writing = os.pipe()
    try:
        try:
            process = children.start(run.arguments(), reading)
        finally:
            os.close(reading)
        output, errors, overrun = _watch(process, run)
        children.ended(process)
    finally:
        os.close(writing)
    result = None if overrun else _result(output)
    return Record(
        run=run,
        status="killed" if overrun else _status(result, process.returncode),
        exit_code=process.returncode,
        seconds=time.perf_counter() - start,
        message=overrun or _message(errors, process.returncode),
        result=result,
        machine=platform.node(),
        version=statehtn.__version__,
    )


def _watch(process: subprocess.Popen[str], run: Run) -> tuple[str, str, str]:
    """Wait for the end of a run, or kill it; return what it has written to both outputs, and why it was killed."""
    start = time.monotonic()
    while True:
        try:
            output, errors = process.communicate(timeout=WATCH_SECONDS)
        except subprocess.TimeoutExpired:
            overrun = _overrun(run, time.monotonic() - start, resident_mb(process.pid))
            if overrun:
                process.kill()
                return *process.communicate(), overrun
        else:
            return output, errors, ""


def _overrun(run: Run, seconds: float, megabytes: float) -> str:
    """Say which limit a run has overrun by more than the grace; empty if none."""
    for used, limit, grace, unit in (
        (seconds, run.time_limit, GRACE_SECONDS, "s"),
        (megabytes, run.memory_limit, GRACE_MEGABYTES, "MB"),
    ):
        if limit is not None and used > limit * (1 + GRACE_SHARE) + grace:
            return f"killed at {used:.4g} {unit}, far beyond the limit of {limit:g} {unit}"
    return ""


def _result(output: str) -> dict[str, Any] | None:
    """Return the object that the child has printed, None where it is missing or not whole."""
    with suppress(ValueError):
        result = json.loads(output)
        if isinstance(result, dict) and "status" in result:
            return result
    return None


def _status(result: dict[str, Any] | None, exit_code: int) -> str:
    return STATUSES_WITHOUT_RESULT.get(exit_code, "error") if result is None else str(result["status"])


def _message(errors: str, exit_code: int) -> str:
    """Return the last words of the child; where a signal has ended it, say so."""
    words = errors.strip()[-MESSAGE_LENGTH:]
    return f"{words}\nended by signal {-exit_code}".strip() if exit_code < 0 else words


def execute_all(runs: Iterable[Run], jobs: int) -> Generator[Record]:
    """Execute runs, `jobs` at once, and yield their records as they end; close the iterator to end them all.

    Raises:
        KeyboardInterrupt: a run was interrupted from outside, as on the machine's way down; it counts for nothing.
        OSError: no process can be started.
    """
    children = Children()
    with ThreadPoolExecutor(jobs) as executor:
        try:
            for future in as_completed([executor.submit(execute, run, children) for run in runs]):
                record = future.result()
                if record.was_interrupted:
                    raise KeyboardInterrupt
                yield record
        finally:
            executor.shutdown(wait=False, cancel_futures=True)
            children.stop()
