"""Every error that a user can meet: what is wrong, where, what was found and what was expected."""

from __future__ import annotations

import re
from dataclasses import dataclass

_UNPRINTABLE = re.compile("[\x00-\x09\x0b-\x1f\x7f-\x9f\u200e\u200f\u2028-\u202e\u2066-\u2069\ud800-\udfff]")


def printable(text: str) -> str:
    r"""Return a text with all control characters but newlines as escapes (`\x1b`), so that it drives no terminal.

    Marks that turn the direction of writing, and halves of surrogate pairs, which no encoding has, are escaped, too.
    """
    return _UNPRINTABLE.sub(lambda match: match[0].encode("unicode_escape").decode("ascii"), text)


def one_line(text: str) -> str:
    r"""Return a text as `printable` does, its newlines as escapes, too: names of files can have some."""
    return printable(text).replace("\n", r"\n")


@dataclass(frozen=True, slots=True)
class Place:
    """A position in an input `file`; its `line` and `column` count from 1."""

    file: str
    line: int
    column: int

    def __str__(self) -> str:
        return f"{self.file}:{self.line}:{self.column}"


class StateHtnError(Exception):
    """Bad input of any kind; the base of all errors that statehtn raises on purpose.

    Args:
        message: one sentence: what is wrong, what was found, what was expected and what to do.
        place: where in the input, or None where there is no file.
    """

    def __init__(self, message: str, place: Place | None = None) -> None:
        self.message = message
        self.place = place
        super().__init__(one_line(f"{place}: {message}" if place else message))


class InputError(StateHtnError):
    """The domain, the problem, a plan or a cost is malformed or contradicts itself (exit code 30)."""


class UnsupportedError(StateHtnError):
    """The input is well formed but asks for something that this planner does not do (exit code 31)."""


class UsageError(StateHtnError, ValueError):
    """An argument of the library or the command line is out of its range (exit code 2)."""


class ClusterError(StateHtnError):
    """The cluster that runs were sent to is not there, is lost, or cannot execute them (exit code 69)."""


class InternalError(Exception):
    """The planner has caught itself in a mistake (exit code 70); not the user's fault, and worth a report."""
