"""Trees as pictures."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from statehtn.display.axes import new_or_given
from statehtn.errors import UsageError
from statehtn.model.decomposition_tree import TreeRow

if TYPE_CHECKING:
    from matplotlib.axes import Axes

CHARACTER = 0.0755  # inches, of the font below
FONT_SIZE = 9
GAP = 0.5  # inches between columns
ROW = 0.42  # inches
MOST_ROWS = 400
INNER, LEAF, EDGE, LINE = "#e8eef7", "#fdf0d9", "#5b6b82", "#9aa7b8"


def plot_tree(rows: Sequence[TreeRow], ax: Axes | None = None) -> Axes:
    """Draw a tree from left to right: inner nodes in blue with their notes below them, leaves in yellow.

    Args:
        ax: where to draw; a new figure of a size that fits where it is None.

    Raises:
        UsageError: matplotlib is not installed, these are no axes, or the tree has too many rows for a picture.
    """
    if len(rows) > MOST_ROWS:
        raise UsageError(f"a picture of {len(rows)} nodes cannot be read (at most {MOST_ROWS}); print the tree instead")
    lefts, widths = _columns(rows)
    heights = _heights(rows)
    width, height = lefts[-1] + widths[-1] + 0.2, (max(heights) + 1) * ROW + 0.2
    ax = new_or_given(ax, figsize=(width, height), layout="tight")
    ax.set(xlim=(-0.1, width), ylim=(height - 0.3, -ROW / 2 - 0.1))
    ax.axis("off")
    path: list[int] = []  # the rows from the root to this one
    for index, row in enumerate(rows):
        del path[row.depth :]
        x, y = lefts[row.depth], heights[index] * ROW
        if path:
            start = lefts[rows[path[-1]].depth] + 0.1  # inside the parent's box, which covers it
            bend = lefts[row.depth] - GAP / 2
            y_above = heights[path[-1]] * ROW
            ax.plot([start, bend, bend, x], [y_above, y_above, y, y], color=LINE, linewidth=1, zorder=1)
        path.append(index)
        ax.text(
            x + 0.06,
            y,
            f"{row.label}\n{row.note}" if row.note else row.label,
            va="center",
            fontsize=FONT_SIZE,
            linespacing=1.1,
            family="monospace",
            zorder=2,
            bbox={"boxstyle": "round,pad=0.25", "facecolor": LEAF if row.is_leaf else INNER, "edgecolor": EDGE},
        )
    return ax


def _width(row: TreeRow) -> float:
    return CHARACTER * max(len(row.label), len(row.note)) + 0.2


def _columns(rows: Sequence[TreeRow]) -> tuple[list[float], list[float]]:
    """Return the left edge and the width of the column of every depth, in inches."""
    widths = [0.0] * (1 + max(row.depth for row in rows))
    for row in rows:
        widths[row.depth] = max(widths[row.depth], _width(row))
    lefts = [0.0]
    for width in widths[:-1]:
        lefts.append(lefts[-1] + width + GAP)
    return lefts, widths


def _heights(rows: Sequence[TreeRow]) -> list[float]:
    """Return how far down every row stands: ends one after the other, others amid their children."""
    found = [0.0] * len(rows)
    below: dict[int, list[float]] = {}  # by depth: the heights of the children that are waiting for their parent
    count = sum(1 for index in range(len(rows)) if _is_end(rows, index))
    for index in reversed(range(len(rows))):
        depth = rows[index].depth
        children = below.pop(depth + 1, None)
        if children is None:
            count -= 1
            found[index] = float(count)
        else:
            found[index] = (children[0] + children[-1]) / 2
        below.setdefault(depth, []).append(found[index])
    return found


def _is_end(rows: Sequence[TreeRow], index: int) -> bool:
    return index + 1 == len(rows) or rows[index + 1].depth <= rows[index].depth
