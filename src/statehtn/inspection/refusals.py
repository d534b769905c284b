"""What the reader refuses or warns of, as findings: it says most of it itself; here are names and some advice."""

from __future__ import annotations

import re
from collections.abc import Iterator

from statehtn.errors import Place, StateHtnError, UnsupportedError
from statehtn.hddl.whole_reader import Reading
from statehtn.inspection.finding import Finding, Level

_KINDS = (
    (r"\bunknown keyword|\bunknown section", "syntax", "correct the word"),
    (r"\bunknown object\b.*no such constant", "undefined", "correct the name, or declare it in ':constants'"),
    (r"\bunknown variable", "undefined", "declare it in ':parameters', or correct its name"),
    (r"\bunknown label", "undefined", "give a subtask this label, or correct it"),
    (r"\bunknown ", "undefined", "declare it, or correct the name"),
    (r" takes .* arguments?, found", "arguments", "write as many as the declaration has, or change the declaration"),
    (r" is of type .* expects ", "types", "pass another argument, or change one of the two types"),
    (r"the types are in a cycle", "cyclic-types", "take one of them out of the circle"),
    (r"ordering of the subtasks is cyclic", "cyclic-ordering", "leave out one of these orderings"),
    (r"probabilities .* sum to", "probabilities", "make the probabilities of the block sum to 1"),
    (r"probability must not be negative", "probabilities", "probabilities are numbers from 0 to 1"),
    (r"pairs of a probability", "probabilities", "write a probability before each part, as in 0.3 (..) 0.7 (..)"),
    (r"probabilit", "probabilities", ""),
    (r"negative|a cost ", "costs", "costs are numbers of at least 0"),
    (r"already|twice|declared again|differ in case|a second section", "declared-twice", "keep one of them"),
)


def refusals(reading: Reading) -> Iterator[Finding]:
    """Yield the errors and warnings of the reader."""
    for error in reading.errors:
        yield _finding(error, Level.ERROR, "syntax")
    for warning in reading.warnings:
        yield _finding(warning, Level.WARNING, "sloppy")


def _finding(error: StateHtnError, level: Level, code: str) -> Finding:
    place = error.place or Place("<input>", 1, 1)
    if isinstance(error, UnsupportedError):
        return Finding(level, place, error.message, "state it in another way", "unsupported")
    for pattern, kind, advice in _KINDS:
        if re.search(pattern, error.message):
            is_asked = "did you mean" in error.message
            return Finding(level, place, error.message, "" if is_asked else advice, kind)
    return Finding(level, place, error.message, "", code)
