# ruff: noqa: D102 (the protocols repeat what the docstrings of `Result` say)
"""Results of planning runs as text and as HTML."""

from __future__ import annotations

from collections.abc import Sequence
from html import escape
from typing import Protocol

from statehtn.display.table import Column, Table

COLUMNS = (
    Column("", is_number=True),
    Column("action"),
    Column("cost"),
    Column("expected", is_number=True),
    Column("certainty equivalent", is_number=True),
)


class ShownStep(Protocol):
    """What is shown of an action of a plan; `step` and `law` are shown as they print."""

    @property
    def step(self) -> object: ...
    @property
    def law(self) -> object: ...
    @property
    def expected_cost(self) -> float: ...
    @property
    def risk_cost(self) -> float: ...


class ShownPlan(Protocol):
    """What is shown of a plan besides its actions."""

    @property
    def decomposition(self) -> object: ...


class ShownResult(Protocol):
    """What is shown of a result; see `statehtn.Result`."""

    @property
    def status(self) -> object: ...
    @property
    def attitude(self) -> str: ...
    @property
    def alpha(self) -> float | None: ...
    @property
    def plan(self) -> ShownPlan | None: ...
    @property
    def steps(self) -> Sequence[ShownStep]: ...
    @property
    def expected_cost(self) -> float | None: ...
    @property
    def risk_cost(self) -> float | None: ...
    @property
    def expected_utility(self) -> str | None: ...
    @property
    def lower_bound(self) -> float | None: ...


def result_text(result: ShownResult) -> str:
    """Return the status, a table of the actions with their costs, and the plan's price, in lines."""
    lines = [_head(result)]
    if result.plan is not None:
        lines.append(_table(result).to_text())
    return "\n".join([*lines, *_notes(result)])


def result_html(result: ShownResult) -> str:
    """Return what `result_text` does as HTML for a notebook, and the decomposition, folded."""
    parts = [f"<b>{escape(_head(result))}</b>"]
    if result.plan is not None:
        parts.append(_table(result).to_html())
    parts += [f"<div>{escape(note)}</div>" for note in _notes(result)]
    if result.plan is not None:
        tree = escape(str(result.plan.decomposition))
        parts.append(f'<details><summary>decomposition</summary><pre style="line-height: 1.25">{tree}</pre></details>')
    return f"<div>{''.join(parts)}</div>"


def steps_html(steps: Sequence[ShownStep]) -> str:
    """Return a table of steps with their costs as HTML for a notebook."""
    return Table(COLUMNS, _rows(steps)).to_html()


def _head(result: ShownResult) -> str:
    agent = result.attitude if result.alpha is None else f"{result.attitude}, alpha {result.alpha:g}"
    return f"status: {result.status} (risk-{agent})"


def _table(result: ShownResult) -> Table:
    return Table(
        COLUMNS, _rows(result.steps), ("", "in all", "", _number(result.expected_cost), _number(result.risk_cost))
    )


def _rows(steps: Sequence[ShownStep]) -> list[tuple[str, ...]]:
    return [
        (str(number), str(priced.step), str(priced.law), _number(priced.expected_cost), _number(priced.risk_cost))
        for number, priced in enumerate(steps, 1)
    ]


def _notes(result: ShownResult) -> list[str]:
    if result.plan is None:
        if result.lower_bound is None:
            return []
        return [f"every plan has a certainty equivalent of at least {_number(result.lower_bound)}"]
    notes = [f"expected utility {result.expected_utility}"]
    if str(result.status) != "optimal" and result.lower_bound is not None:
        notes.append(f"no plan has a certainty equivalent below {_number(result.lower_bound)}")
    return notes


def _number(value: float | None) -> str:
    return "" if value is None else f"{value:.10g}"
