"""An attitude map as a table: each plan, the agents for whom it is good, and how good it is proven to be."""

from __future__ import annotations

import math

from statehtn.display.table import Column, Table
from statehtn.display.words import number
from statehtn.sweeps.attitude_map import AttitudeMap, MapPiece

HEADS = ("steps", "least", "expected", "most", "gap")


def map_text(found: AttitudeMap) -> str:
    """Return a table with a row for every plan, and what it means, in lines."""
    return "\n".join((_table(found).to_text(), *_notes(found))) if found.pieces else repr(found)


def map_html(found: AttitudeMap) -> str:
    """Return what `map_text` does as HTML for a notebook."""
    notes = "".join(f"<div>{note}</div>" for note in _notes(found))
    return f"<div>{_table(found).to_html()}{notes}</div>"


def _table(found: AttitudeMap) -> Table:
    ends = [f"{found.low:g}", *(str(one) for one in found.breaks), f"{found.high:g}"]
    rows = [(ends[i], ends[i + 1], *_cells(piece)) for i, piece in enumerate(found.pieces)]
    columns = (Column("alpha from"), Column("to"), *(Column(head, is_number=True) for head in HEADS))
    return Table(columns, rows)


def _cells(piece: MapPiece) -> tuple[str, ...]:
    costs = (piece.certainty_equivalent(alpha) for alpha in (-math.inf, 0.0, math.inf))
    return str(piece.found.length), *map(number, costs), f"{piece.gap:.2g}"


def _notes(found: AttitudeMap) -> tuple[str, ...]:
    if not found.pieces:
        return ()
    notes = [
        "alpha: negative for seeking agents, 0 for the neutral one; the best plan changes between the two in brackets",
        "gap: no plan is better than this one by more for any agent of its row, in certainty equivalents",
    ]
    if found.stopped is not None:
        notes.append(f"the sweep was ended before it was done: {found.stopped}")
    return tuple(notes)
