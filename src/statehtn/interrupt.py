"""What a Ctrl-C does to a call of the library: it returns what is known by then, or raises."""

from __future__ import annotations

from typing import Literal, Protocol, TypeVar

from statehtn.expected import one_of
from statehtn.model.status import Status

OnInterrupt = Literal["return", "raise"]
INTERRUPTS = ("return", "raise")


class Stoppable(Protocol):
    """A result that knows what ended its run."""

    @property
    def stopped(self) -> Status | None:
        """What ended the run before it was done; None for nothing."""
        ...


S = TypeVar("S", bound=Stoppable)


def check_interrupt(interrupt: object) -> None:
    """Check an argument `interrupt`.

    Raises:
        UsageError: it is neither `return` nor `raise`.
    """
    one_of(interrupt, INTERRUPTS, "value of 'interrupt'")


def returned(result: S, interrupt: OnInterrupt) -> S:
    """Return a result.

    Raises:
        KeyboardInterrupt: one ended the run, and `interrupt` asks for it; the result is its argument.
    """
    if interrupt == "raise" and result.stopped is Status.INTERRUPTED:
        raise KeyboardInterrupt(result)
    return result
