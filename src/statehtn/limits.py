"""Limits that hold in every phase: reading, grounding and search."""

from __future__ import annotations

import math
import os
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from types import FrameType
from typing import TypeVar

from statehtn.errors import UsageError
from statehtn.expected import number
from statehtn.model.status import Status

T = TypeVar("T")


class LimitReached(BaseException):
    """A limit ended a phase before it had anything to show; the planner turns it into a result.

    As with `KeyboardInterrupt`, no `except Exception` of a library or of a user's callable is to swallow it.
    """

    def __init__(self, status: Status) -> None:
        self.status = status
        super().__init__(f"the {status.value.replace('-', ' ')} was reached")


ENDINGS = (LimitReached, MemoryError, KeyboardInterrupt)
"""Exceptions that end a phase before it has anything to show."""


MOST_MB = 2**63 / 1e6
"""More memory than any machine can name; a limit beyond it is none."""

SECONDS_TO_READ = 1.0
"""A plan that is found right before the time is over is given that long to be read: enough for some 100 000 tasks."""

SECONDS_BETWEEN_LOOKS = 0.05
"""At the limits, while a library computes that knows of none."""
SECONDS_TO_END = 0.5
"""So long a library has to end after a limit, before it is told of it once more."""

STOPS = (Status.TIME_LIMIT, Status.MEMORY_LIMIT, Status.INTERRUPTED)
"""The statuses of runs that something ended before they were done."""


def status_of(ending: BaseException) -> Status:
    """Return the status of a run that one of `ENDINGS` ended."""
    match ending:
        case LimitReached(status=status):
            return status
        case MemoryError():
            return Status.MEMORY_LIMIT
        case _:
            return Status.INTERRUPTED


def ending_by(status: Status) -> BaseException:
    """Return what ends a phase of a run that ends with one of `STOPS`: it is no limit that an interruption reaches."""
    return KeyboardInterrupt() if status is Status.INTERRUPTED else LimitReached(status)


@dataclass(frozen=True, slots=True)
class Limits:
    """A point in time and an amount of memory that a run must not pass; make one by `Limits.starting_now`.

    Args:
        deadline: seconds of `time.monotonic`, or None.
        memory_mb: resident memory of the whole process, in units of 10^6 bytes, or None.
        steps: how often a call of the core may look at its limits, or None; it ends at the same node on any machine.
    """

    deadline: float | None = None
    memory_mb: float | None = None
    steps: int | None = None

    @staticmethod
    def starting_now(time_limit: float | None = None, memory_limit: float | None = None) -> Limits:
        """Start the clock: `time_limit` in seconds, `memory_limit` in MB; both positive, None for no limit.

        Raises:
            UsageError: a limit is not positive.
        """
        seconds = _positive("time limit", time_limit)
        megabytes = _positive("memory limit", memory_limit)
        return Limits(
            None if seconds is None else time.monotonic() + seconds,
            None if megabytes is None or megabytes >= MOST_MB else megabytes,
        )

    def with_grace(self, seconds: float, *, is_over: bool = False) -> Limits:
        """Return limits that leave at least so many seconds from now on, and a twentieth of the memory.

        Where the run `is_over`, because something has stopped it, they leave no more than that.
        """
        until = time.monotonic() + seconds
        deadline = None if self.deadline is None else max(self.deadline, until)
        return Limits(
            until if is_over else deadline,
            None if self.memory_mb is None else max(self.memory_mb, resident_mb() + self.memory_mb / 20),
            self.steps,
        )

    def for_a_part(self, share: float) -> Limits:
        """Return limits that leave so much of the time that is left, between 0 and 1; the other limits are the same."""
        if self.deadline is None:
            return self
        now = time.monotonic()
        return replace(self, deadline=now + max(0.0, self.deadline - now) * share)

    def sooner(self, seconds: float) -> Limits:
        """Return limits that leave so much less time, but half of what is left at least."""
        if self.deadline is None:
            return self
        return replace(self, deadline=self.deadline - min(seconds, max(0.0, self.deadline - time.monotonic()) / 2))

    def left(self) -> tuple[float | None, int | None, int | None]:
        """Return what is left of the time, in seconds, the memory in bytes, and the steps, as the core takes them."""
        return (
            None if self.deadline is None else self.deadline - time.monotonic(),
            None if self.memory_mb is None else int(self.memory_mb * 1e6),
            self.steps,
        )

    def check(self) -> None:
        """Raise `LimitReached` if the time is over or the memory is used up.

        Takes about a microsecond; call it every thousand units of work or so.
        """
        if self.deadline is not None and time.monotonic() >= self.deadline:
            raise LimitReached(Status.TIME_LIMIT)
        if self.memory_mb is not None and resident_mb() > self.memory_mb:
            raise LimitReached(Status.MEMORY_LIMIT)


def _positive(name: str, value: float | None) -> float | None:
    """Return a limit; None if there is none, or an infinite one.

    Raises:
        UsageError: it is not positive.
    """
    if value is None:
        return None
    limit = number(value, f"the {name}")
    if not limit > 0:
        raise UsageError(f"the {name} must be a positive number, found {limit:g}")
    return None if math.isinf(limit) else limit


@contextmanager
def watched(limits: Limits, ends_imports: bool = False) -> Iterator[None]:
    """Let a library compute that knows of no limits: a timer's signal looks at them meanwhile.

    Signals reach the main thread of a process only; elsewhere, and where the system has no such timer, the limits are
    looked at when the library has come to its end.

    Args:
        limits: they hold.
        ends_imports: end the import of a module, too, where that takes long. It is left half imported, which does not
            matter to a process that ends with this run.

    Raises:
        LimitReached: a limit is reached.
    """
    import signal  # here, since importing the package must be quick
    import threading

    has_signals = threading.current_thread() is threading.main_thread() and hasattr(signal, "setitimer")
    if not has_signals or (limits.deadline is None and limits.memory_mb is None):
        yield
        limits.check()
        return

    def look(_signal: int, frame: FrameType | None) -> None:
        if not may_be_ended(frame, ends_imports):
            return
        try:
            limits.check()
        except LimitReached:
            # Not at once again; but it may be lost, where it is raised in a callback of the collector, say.
            signal.setitimer(signal.ITIMER_REAL, SECONDS_TO_END, SECONDS_TO_END)
            raise

    handler = signal.signal(signal.SIGALRM, look)
    timer = signal.setitimer(signal.ITIMER_REAL, SECONDS_BETWEEN_LOOKS, SECONDS_BETWEEN_LOOKS)
    try:
        yield
    except Exception:
        if ends_imports:  # modules in C make errors of their own of what ends their import
            limits.check()
        raise
    finally:
        signal.setitimer(signal.ITIMER_REAL, *timer)
        signal.signal(signal.SIGALRM, handler)
    limits.check()


def in_spite_of_interrupt(work: Callable[[], T], limits: Limits) -> tuple[T, bool]:
    """Do something short without which what was found would be lost: Ctrl-C has it done anew, within another second.

    Returns:
        What the work returns, and whether it was interrupted.

    Raises:
        KeyboardInterrupt: it was interrupted twice.
        LimitReached: another second was too little.
    """
    try:
        return work(), False
    except KeyboardInterrupt:
        with watched(limits.with_grace(SECONDS_TO_READ, is_over=True)):
            return work(), True


LOSE_EXCEPTIONS = ("weakref.py", "_weakrefset.py")
"""Files of Python with functions that are called while an object is destroyed: what they raise is printed and lost."""


def may_be_ended(frame: FrameType | None, ends_imports: bool = False) -> bool:
    """Tell whether an exception may be raised here: not in a destructor, nor while a module is imported as a rule."""
    while frame is not None:
        code = frame.f_code
        if code.co_filename.startswith("<frozen importlib") and not ends_imports:
            return False  # the module would be left half imported
        if code.co_name == "__del__" or code.co_filename.endswith(LOSE_EXCEPTIONS):
            return False
        frame = frame.f_back
    return True


def resident_mb(process: int | None = None) -> float:
    """Return the resident memory of this process, or of another, in MB (10^6 bytes).

    It is 0 for a process that has ended, and where the system does not tell.
    """
    try:
        with open(f"/proc/{'self' if process is None else process}/statm", "rb") as file:
            return int(file.read().split()[1]) * os.sysconf("SC_PAGE_SIZE") / 1e6
    except (OSError, IndexError):
        return 0.0
