"""Trees as text."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from statehtn.model.decomposition_tree import TreeRow


def tree_text(rows: Sequence[TreeRow]) -> str:
    """Return a tree in box-drawing characters, a line for each row.

    rich takes a hundred times as long for the same lines: minutes for the decomposition of a long plan.
    """
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
