"""Signals that end a run: SIGTERM and SIGHUP as Ctrl-C does, and none of them at the expense of what was found."""

from __future__ import annotations

import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from functools import partial
from types import FrameType

from statehtn.limits import SECONDS_BETWEEN_LOOKS, may_be_ended

SECONDS_TO_SHOW = 1.0
"""What was found is given that long to be printed and written after a signal."""
MOST_WAITS = 20
"""While a module is imported, of `SECONDS_BETWEEN_LOOKS` each."""
CAUGHT = [getattr(signal, name) for name in ("SIGINT", "SIGTERM", "SIGHUP") if hasattr(signal, name)]


@contextmanager
def signals_as_interrupt() -> Iterator[None]:
    """Raise `KeyboardInterrupt` for each of them: a batch system's stop, or a closed terminal, ends in a result, too.

    What is ignored (`nohup`) stays so. After the first one those that no key sends are ignored: a terminal that is
    closed sends several, and the result has to be written. A second Ctrl-C ends that, too.
    """
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    caught = [number for number in CAUGHT if signal.getsignal(number) != signal.SIG_IGN]
    previous = [(number, signal.signal(number, _interrupt)) for number in caught]
    try:
        yield
    finally:
        if hasattr(signal, "setitimer") and signal.getsignal(signal.SIGALRM) is _interrupt:
            signal.setitimer(signal.ITIMER_REAL, 0)
            signal.signal(signal.SIGALRM, signal.SIG_DFL)
        for number, handler in previous:
            signal.signal(number, handler)


def let_finish() -> None:
    """Give what is printed and written from now on another second after a signal; a second Ctrl-C ends it at once.

    To be called within `signals_as_interrupt`, once all is found that will be; elsewhere it does nothing.
    """
    if threading.current_thread() is threading.main_thread() and hasattr(signal, "setitimer"):
        for number in CAUGHT:
            if signal.getsignal(number) is _interrupt:
                signal.signal(number, _interrupt_soon)


def _interrupt(number: int, frame: FrameType | None, waits: int = MOST_WAITS) -> None:
    """Raise `KeyboardInterrupt`; a little later while a module is imported, which may make another error of it."""
    if waits > 0 and number != getattr(signal, "SIGALRM", None) and not may_be_ended(frame):
        signal.signal(number, partial(_interrupt, waits=waits - 1))
        main = threading.main_thread().ident  # which may be waiting for something, and is to wake up
        again = threading.Timer(SECONDS_BETWEEN_LOOKS, signal.pthread_kill, (main, number))
        again.daemon = True
        again.start()
        return
    signal.signal(number, _interrupt)
    _ignore_all_but_ctrl_c(number)
    raise KeyboardInterrupt


def _interrupt_soon(number: int, _frame: FrameType | None) -> None:
    _ignore_all_but_ctrl_c(number)
    signal.signal(signal.SIGINT, _interrupt)
    signal.signal(signal.SIGALRM, _interrupt)
    signal.setitimer(signal.ITIMER_REAL, SECONDS_TO_SHOW)


def _ignore_all_but_ctrl_c(number: int) -> None:
    if number == signal.SIGINT:
        return  # where a terminal is closed or a batch system stops the run meanwhile, that ends it, too
    for other in CAUGHT:
        if other != signal.SIGINT and signal.getsignal(other) in (_interrupt, _interrupt_soon):
            signal.signal(other, signal.SIG_IGN)
