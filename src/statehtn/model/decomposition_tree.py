"""The decomposition of a plan, to look at."""

from __future__ import annotations

from dataclasses import dataclass
from html import escape
from typing import TYPE_CHECKING

from statehtn.model.plan import Decomposition, Plan

if TYPE_CHECKING:
    from matplotlib.axes import Axes


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


@dataclass(frozen=True, slots=True, repr=False)
class DecompositionTree:
    """How a plan comes from the initial network: prints as a tree, shows itself in notebooks, and can be drawn.

    Compound tasks stand with the method that decomposed them and above its subtasks, in the method's own order; the
    numbers of the actions tell the order in which they are executed.
    """

    plan: Plan

    @property
    def rows(self) -> tuple[TreeRow, ...]:
        """The nodes of the tree, parents first."""
        found = [TreeRow(0, "initial network")]
        pending = [(1, root) for root in reversed(self.plan.roots)]
        while pending:
            depth, node = pending.pop()
            if isinstance(node, Decomposition):
                label = f"({' '.join((node.task, *node.arguments))})"
                found.append(TreeRow(depth, label, f"by {node.method}"))
                pending += [(depth + 1, child) for child in reversed(node.children)]
            else:
                found.append(TreeRow(depth, f"{node + 1}. {self.plan.steps[node]}", is_leaf=True))
        return tuple(found)

    def __repr__(self) -> str:
        return f"<decomposition tree of {self.plan!r}>"

    def __str__(self) -> str:
        from statehtn.display.tree import tree_text

        return tree_text(self.rows)

    def _repr_html_(self) -> str:
        return f'<pre style="line-height: 1.25">{escape(str(self))}</pre>'

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the tree from left to right by matplotlib (`pip install 'statehtn[plots]'`).

        Args:
            ax: where to draw; a new figure of a size that fits where it is None.

        Raises:
            UsageError: matplotlib is not installed, or there are too many nodes for a picture.
        """
        from statehtn.display.tree_plot import plot_tree

        return plot_tree(self.rows, ax)
