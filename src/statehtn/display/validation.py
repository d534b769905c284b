"""Verdicts on plans as HTML."""

from __future__ import annotations

from collections.abc import Sequence
from html import escape
from typing import Protocol

from statehtn.display.table import Column, Table

COLUMNS = (Column("", is_number=True), Column("cost"), Column("expected", is_number=True))
MOST_REASONS = 20


class ShownLaw(Protocol):
    """What is shown of the law of a cost, besides its text."""

    @property
    def mean(self) -> float:
        """The expected cost."""
        ...


def validation_html(valid: bool, reasons: Sequence[str], costs: Sequence[ShownLaw]) -> str:
    """Return the verdict, the reasons, and a table of the costs of the steps that can be executed."""
    parts = [f"<b>{'valid' if valid else 'invalid'}</b>"]
    if reasons:
        shown = [*map(escape, reasons[:MOST_REASONS])]
        if len(reasons) > MOST_REASONS:
            shown.append(f"and {len(reasons) - MOST_REASONS} more")
        parts.append(f"<ul>{''.join(f'<li>{reason}</li>' for reason in shown)}</ul>")
    rows = [(str(number), str(law), f"{law.mean:.10g}") for number, law in enumerate(costs, 1)]
    if rows:
        parts.append(Table(COLUMNS, rows).to_html())
    return f"<div>{''.join(parts)}</div>"
