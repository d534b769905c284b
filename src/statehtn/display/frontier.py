"""A frontier of mean and risk as a table."""

from __future__ import annotations

import math
from html import escape

from statehtn.display.table import Column, Table
from statehtn.display.words import number
from statehtn.sweeps.frontier import Frontier


def frontier_text(frontier: Frontier) -> str:
    """Return a table with a row for every plan, and what is not proven, in lines."""
    return "\n".join((_table(frontier).to_text(), *_notes(frontier))) if frontier.points else repr(frontier)


def frontier_html(frontier: Frontier) -> str:
    """Return what `frontier_text` does as HTML for a notebook."""
    notes = "".join(f"<div>{escape(note)}</div>" for note in _notes(frontier))
    return f"<div>{_table(frontier).to_html()}{notes}</div>"


def _table(frontier: Frontier) -> Table:
    gaps = ["", *("unknown" if math.isinf(gap) else f"{gap:.2g}" for gap in frontier.gaps)]
    rows = [
        (str(point.found.length), number(point.mean), number(point.risk), gap)
        for point, gap in zip(frontier.points, gaps, strict=True)
    ]
    heads = ("steps", "mean", frontier.risk, "gap before")
    return Table([Column(head, is_number=True) for head in heads], rows)


def _notes(frontier: Frontier) -> list[str]:
    notes = []
    if any(frontier.gaps):
        notes.append("gap before: a plan may be missing before this one, better by no more than that")
    if frontier.stopped is not None:
        notes.append(f"the search was ended before it was done: {frontier.stopped}; plans of lower risk may be missing")
    return notes
