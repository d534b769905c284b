"""Sets of tuples of objects, found by any of their positions."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Sequence

Row = tuple[str, ...]
NOTHING: Sequence[Row] = ()


class Relation:
    """Tuples of objects: the facts of a predicate, or the arguments with which a task can be accomplished."""

    def __init__(self, rows: Iterable[Row] = ()) -> None:
        self.rows = frozenset(rows)
        self._indexes: dict[tuple[int, ...], dict[Row, list[Row]]] = {}

    def __contains__(self, row: object) -> bool:
        return row in self.rows

    def __len__(self) -> int:
        return len(self.rows)

    def matching(self, positions: tuple[int, ...], values: Row) -> Sequence[Row]:
        """Return the rows that have these values at these positions, in alphabetical order."""
        index = self._indexes.get(positions)
        if index is None:
            found: defaultdict[Row, list[Row]] = defaultdict(list)
            for row in sorted(self.rows):
                found[tuple(row[position] for position in positions)].append(row)
            index = self._indexes[positions] = dict(found)
        return index.get(values, NOTHING)


EMPTY = Relation()
