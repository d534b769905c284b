"""The record of a run, and its row in the table of results."""

from __future__ import annotations

from dataclasses import dataclass, fields
from typing import Any

from statehtn.experiments.run import Run
from statehtn.model.status import Status

KEY_COLUMNS = ("domain", "problem", "objective", "keep", "solver", "heuristic", "repeat")
AGENT_COLUMNS = ("attitude", "alpha")
"""Of neutral, averse and seeking agents, whose objectives they say in another way."""
RESULT_COLUMNS = ("risk_cost", "value", "lower_bound", "gap", "expected_cost", "log10_expected_utility", "length")
EFFORT_COLUMNS = ("facts", "actions", "tasks", "methods", "expanded", "generated", "evaluated")
MEASURED_COLUMNS = ("parse_seconds", "ground_seconds", "search_seconds", "peak_memory_mb")
COLUMNS = (*KEY_COLUMNS, *AGENT_COLUMNS, "status", *RESULT_COLUMNS, *EFFORT_COLUMNS, *MEASURED_COLUMNS)
MEASURED_DIGITS = 6

Row = dict[str, str]
"""The values of a row by column; what is not known is empty."""


@dataclass(frozen=True, slots=True)
class Record:
    """What has come of a run.

    Args:
        run: the run.
        status: that of the result; without one `input-error`, `unsupported`, `error` or `killed`.
        exit_code: of its process; negative: the signal that ended it.
        seconds: from the start of its process to its end.
        message: what it wrote to standard error, or why it was killed.
        result: the object of `statehtn plan --json`, if it has printed one.
        machine: the name of the computer that it ran on.
        version: that of statehtn.
    """

    run: Run
    status: str
    exit_code: int
    seconds: float
    message: str
    result: dict[str, Any] | None
    machine: str = ""
    version: str = ""

    @property
    def was_interrupted(self) -> bool:
        """Whether somebody ended the run from outside, with or without a plan: it counts for nothing."""
        stopped = (self.result or {}).get("stopped")
        return Status.INTERRUPTED in (self.status, stopped)

    def row(self) -> Row:
        """Return the row of this run in the table of results."""
        result = self.result or {}
        effort = result.get("statistics") or {}
        measured = {column: effort.get(column) for column in MEASURED_COLUMNS}
        run = self.run.to_dict()
        values = [
            *self.run.key,
            *(_text(run[column]) for column in AGENT_COLUMNS),
            self.status,
            *(_text(result.get(column)) for column in RESULT_COLUMNS),
            *(_text(effort.get(column)) for column in EFFORT_COLUMNS),
            *("" if value is None else str(round(value, MEASURED_DIGITS)) for value in measured.values()),
        ]
        return dict(zip(COLUMNS, values, strict=True))

    def to_dict(self) -> dict[str, Any]:
        """Return everything that is known, as JSON has it; `key` has the first columns of the row."""
        known = {field.name: getattr(self, field.name) for field in fields(self)}
        return {"key": list(self.run.key), **known, "run": self.run.to_dict()}


def _text(value: object) -> str:
    return "" if value is None else str(value)
