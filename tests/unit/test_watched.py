"""Limits that a timer looks at while a library computes that knows of none."""

from __future__ import annotations

import gc
import signal
import time
import weakref
from collections.abc import Callable

import pytest

from statehtn.limits import SECONDS_BETWEEN_LOOKS, LimitReached, Limits, watched


class Finalised:
    """Has a destructor that takes several looks at the limits."""

    def __init__(self, finalise: Callable[[], None]) -> None:
        self.finalise = finalise

    def __del__(self) -> None:
        self.finalise()


def spin() -> None:
    until = time.monotonic() + 4 * SECONDS_BETWEEN_LOOKS
    while time.monotonic() < until:
        pass


def test_a_limit_is_looked_at_while_a_library_computes() -> None:
    handler = signal.getsignal(signal.SIGALRM)

    def compute(limits: Limits) -> None:
        begin = time.monotonic()
        with watched(limits):
            while time.monotonic() < begin + 30:
                pass

    begin = time.monotonic()
    for limits in (Limits.starting_now(0.1), Limits.starting_now(memory_limit=1)):
        with pytest.raises(LimitReached):
            compute(limits)
    assert time.monotonic() < begin + 25
    assert signal.getsignal(signal.SIGALRM) is handler
    assert signal.getitimer(signal.ITIMER_REAL) == (0, 0)


@pytest.mark.parametrize("is_weak", [False, True])
def test_no_limit_is_lost_in_a_destructor(is_weak: bool, monkeypatch: pytest.MonkeyPatch) -> None:
    lost: list[object] = []
    monkeypatch.setattr("sys.unraisablehook", lost.append)
    ended: list[bool] = []

    def destroy() -> None:
        spin()
        ended.append(True)

    def compute() -> None:
        thing = Finalised(destroy if not is_weak else lambda: None)
        if is_weak:
            weakref.finalize(thing, destroy)
        del thing
        while True:
            pass

    with pytest.raises(LimitReached), watched(Limits.starting_now(1e-6)):
        compute()
    assert (ended, lost) == ([True], [])


@pytest.mark.filterwarnings("ignore:Exception ignored:pytest.PytestUnraisableExceptionWarning")
def test_a_limit_whose_exception_is_lost_comes_again() -> None:
    begin = time.monotonic()

    def called_by_the_collector(*_: object) -> None:
        while time.monotonic() < begin + 20:
            pass

    def compute() -> None:
        gc.callbacks.append(called_by_the_collector)
        try:
            gc.collect()
        finally:
            gc.callbacks.remove(called_by_the_collector)
        while time.monotonic() < begin + 20:
            pass

    with pytest.raises(LimitReached), watched(Limits.starting_now(0.1)):
        compute()
    assert time.monotonic() < begin + 18
