"""Trees as text."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class TreeRow:
    """A node of a tree whose nodes are listed parents first, and children in order, each with all that is below it.

    Args:
        depth: 0 for a root; at most one more than that of the row before.
        label: what it is, in one line.
        note: more about it; may be empty.
        is_leaf: drawn as the end of a branch; such a row has nothing below it, though others may have nothing, either.
    """

    depth: int
    label: str
    note: str = ""
    is_leaf: bool = False


def tree_text(rows: Sequence[TreeRow]) -> str:
    """Return a tree in box-drawing characters, a line for each row."""
    lasts = list(_are_last(rows))
    lines = []
    bars: list[str] = []  # what stands to the left of each depth below the roots
    for row, is_last in zip(rows, lasts, strict=True):
        del bars[max(row.depth - 1, 0) :]
        branch = "" if row.depth == 0 else "└── " if is_last else "├── "
        lines.append("".join((*bars, branch, row.label, "  " if row.note else "", row.note)))
        if row.depth:
            bars.append("    " if is_last else "│   ")
    return "\n".join(lines)


def _are_last(rows: Sequence[TreeRow]) -> Iterator[bool]:
    """Yield for each row whether no sibling follows."""
    found = []
    followed: list[bool] = []  # by depth: whether a sibling stands further down
    for row in reversed(rows):
        del followed[row.depth + 1 :]
        followed += [False] * (row.depth + 1 - len(followed))
        found.append(not followed[row.depth])
        followed[row.depth] = True
    return reversed(found)
