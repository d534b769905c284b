"""What is said about a model: how grave it is, where, what, and what to do."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from enum import StrEnum

from statehtn.errors import Place


class Level(StrEnum):
    """How grave a finding is: an error is refused or leaves no plan, a warning is likely a slip, a note is neither."""

    ERROR = "error"
    WARNING = "warning"
    NOTE = "note"


CODES = {
    "syntax": "the file is not HDDL",
    "unsupported": "HDDL or PDDL that this planner does not do",
    "undefined": "a name that nothing declares",
    "declared-twice": "a name that is declared twice",
    "arguments": "a wrong number of arguments",
    "types": "an argument of a type that does not fit",
    "cyclic-types": "types above themselves",
    "cyclic-ordering": "an ordering without a beginning",
    "probabilities": "probabilities that do not sum to 1, or are none",
    "costs": "a cost that is none",
    "sloppy": "what other programs may not read, or read otherwise",
    "contradiction": "a condition that never holds, in whatever state",
    "added-and-deleted": "an effect that adds and deletes the same fact",
    "no-method": "a compound task without a method",
    "endless-recursion": "a task whose decomposition never ends",
    "no-object": "a parameter of a type without objects",
    "never-true": "a condition that neither ':init' nor an action makes true",
    "unused-task": "a task or an action that no network mentions",
    "no-plan": "no plan, with the reason",
    "never-applies": "an action that can never be executed in the problem, or a method that can never be used",
    "in-no-plan": "an action or a method that is a part of no plan of the problem",
    "no-cost": "an action without a cost among actions with costs",
    "no-value": "a function whose value is needed and not given",
    "wide-type": "an argument whose type allows more than its task or predicate takes",
    "redundant-ordering": "an ordering that follows from others",
    "unused-parameter": "a parameter that nothing mentions",
    "unused-predicate": "a predicate that nothing mentions, or nothing reads",
    "unused-function": "a function that no cost mentions",
    "unused-type": "a type that nothing mentions",
}
"""All codes of findings and what they mean; causes stand before what may follow from them."""

_LEVELS = {level: rank for rank, level in enumerate(Level)}
_CODES = {code: rank for rank, code in enumerate(CODES)}


@dataclass(frozen=True, slots=True)
class Finding:
    """One thing that is wrong or suspicious in a model.

    Args:
        level: how grave it is.
        place: file, line and column, from 1.
        message: one sentence about it.
        advice: what to do.
        code: of `CODES`.
        about: the kind and the name of what the finding is about, such as `("action", "drive")`; None if it is about
            none in particular.
    """

    level: Level
    place: Place
    message: str
    advice: str
    code: str
    about: tuple[str, str] | None = None

    def __str__(self) -> str:
        advice = f"; {self.advice}" if self.advice else ""
        return f"{self.place}: {self.level}: {self.message}{advice} [{self.code}]"

    def to_dict(self) -> dict[str, object]:
        """Return the finding as JSON has it."""
        return {
            "level": str(self.level),
            "file": self.place.file,
            "line": self.place.line,
            "column": self.place.column,
            "message": self.message,
            "advice": self.advice,
            "code": self.code,
        }


def in_order(findings: Iterable[Finding]) -> list[Finding]:
    """Return findings by level, causes before what may follow from them, then by place; each once."""

    def rank(finding: Finding) -> tuple[int, int, int, int]:
        return _LEVELS[finding.level], _CODES[finding.code], finding.place.line, finding.place.column

    return sorted(dict.fromkeys(findings), key=rank)
