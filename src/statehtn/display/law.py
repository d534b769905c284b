"""Laws of costs in a line, and as tables for notebooks."""

from __future__ import annotations

from collections.abc import Sequence

from statehtn.display.table import Column, Table

MOST_CHARACTERS = 80
MOST_OUTCOMES = 20


def brief(text: str) -> str:
    """Return a text, cut where it is long."""
    return text if len(text) <= MOST_CHARACTERS else f"{text[: MOST_CHARACTERS - 3]}..."


def law_html(text: str, values: Sequence[tuple[str, float]], outcomes: Sequence[tuple[float, float]]) -> str:
    """Return a table of a law: its values by name, and its outcomes (probability, cost) where they are few."""
    rows = [(name, f"{value:.6g}") for name, value in values]
    table = Table((Column(text), Column("", is_number=True)), rows).to_html()
    if 1 < len(outcomes) <= MOST_OUTCOMES:
        rows = [(f"{cost:g}", f"{probability:g}") for probability, cost in outcomes]
        table += Table((Column("outcome", is_number=True), Column("probability", is_number=True)), rows).to_html()
    return f"<div>{table}</div>"
