"""Warnings and errors of the reader."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from contextlib import contextmanager

from statehtn.counted import counted
from statehtn.errors import InputError, StateHtnError, UnsupportedError
from statehtn.hddl.expressions import Node
from statehtn.hddl.tokens import Source, concise, shortened
from statehtn.log import warn


class HddlWarning(UserWarning):
    """A file is sloppy, but its meaning is clear; in strict mode this is an `InputError`."""


MAX_WARNINGS = 100
"""How many warnings are worked out; a large file with the same slip in every line would take minutes for more."""


class Diagnostics:
    """Collects the warnings of one run of the reader, or raises them in strict mode.

    Args:
        strict: raise warnings as errors.
        goes_on: collect the errors of actions and methods, too, and leave these out, instead of ending at the first.

    Attributes:
        found: the warnings.
        errors: what was refused, where the reader goes on.
        omitted: how many warnings there were beyond `MAX_WARNINGS`.
    """

    def __init__(self, strict: bool, goes_on: bool = False) -> None:
        self.strict = strict
        self.goes_on = goes_on
        self.found: list[InputError] = []
        self.errors: list[StateHtnError] = []
        self.omitted = 0

    def warn(self, message: str, source: Source, index: int) -> None:
        """Note a warning about a token.

        Raises:
            InputError: in strict mode.
        """
        if len(self.found) == MAX_WARNINGS:
            self.omitted += 1
            return
        error = source.error(message, index)
        if self.strict:
            raise error
        self.found.append(error)

    def emit(self, stacklevel: int) -> None:
        """Hand the warnings to Python, as if they came from the caller `stacklevel` frames up."""
        for error in self.found:
            warn(HddlWarning(str(error)), stacklevel + 1)
        if self.omitted:
            are = "is" if self.omitted == 1 else "are"
            warn(HddlWarning(f"{counted(self.omitted, 'more warning')} {are} left out"), stacklevel + 1)


class Reporter:
    """What a part of the reader says about one file."""

    def __init__(self, source: Source, diagnostics: Diagnostics) -> None:
        self.source = source
        self.diagnostics = diagnostics

    def warn_of_missing_spaces(self) -> None:
        """Note a warning for every variable that stands right behind another word; an error in strict mode."""
        for index in self.source.glued:
            variable = shortened(self.source.tokens[index])
            self.diagnostics.warn(f"expected a space before '{variable}'", self.source, index)

    @contextmanager
    def leaving_out(self) -> Iterator[None]:
        """Leave out a part of the file that is wrong, and note its error, if the reader is to go on."""
        try:
            yield
        except StateHtnError as error:
            if not self.diagnostics.goes_on:
                raise
            self.diagnostics.errors.append(error)

    def error(self, message: str, at: Node) -> InputError:
        """Return an error for the caller to raise."""
        return self.source.error(message, at.index)

    def unsupported(self, message: str, at: Node) -> UnsupportedError:
        """Return the error for something that is HDDL, or PDDL, but not done here."""
        return UnsupportedError(concise(message), self.source.place(at.index))

    def warn(self, message: str, at: Node) -> None:
        """Note a warning; an error in strict mode."""
        self.diagnostics.warn(message, self.source, at.index)


def unknown(kind: str, name: str, known: Iterable[str]) -> str:
    """Return the message that a name is not declared, with the most similar name that is; case does not matter."""
    message = f"unknown {kind} '{shortened(name)}'"
    candidates = {candidate.lower(): candidate for candidate in known}
    if len(name) > 60 or len(candidates) > 5000:  # difflib would take seconds
        return message
    import difflib  # only for errors: it takes 5 ms

    close = difflib.get_close_matches(name.lower(), candidates, n=1)
    return f"{message}; did you mean '{candidates[close[0]]}'?" if close else message
