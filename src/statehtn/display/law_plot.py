"""Laws of costs as pictures."""

from __future__ import annotations

import textwrap
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy

from statehtn.display.axes import new_or_given
from statehtn.model.cost.law import CostLaw

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.lines import Line2D

CURVE = "distribution function of a cost"  # what marks the curves of this module among the lines of a diagram
LABEL_WIDTH = 26  # characters, so that a legend fits into small axes


def plot_law(law: CostLaw, ax: Axes | None, label: str, color: str | None) -> Axes:
    """Draw a distribution function in steps, with its mean and its worst cases, beside those that are there already.

    Args:
        law: of a cost.
        ax: where to draw; a new figure where it is None.
        label: the law's name in the legend.
        color: of all its lines; the next one of the colour cycle where it is None.

    Raises:
        UsageError: matplotlib is not installed, or these are no axes.
    """
    costs, probabilities = law.curve()
    quantile, cvar = law.quantile(0.95), law.cvar(0.95)
    ax = new_or_given(ax, figsize=(6.4, 3.6), layout="constrained")
    others = [line for line in ax.get_lines() if line.get_gid() == CURVE]
    left, right = _limits(costs, cvar, ax if others else None)
    (curve,) = ax.step(
        [left, *costs, right],
        [0.0, *probabilities, probabilities[-1]],
        where="post",
        linewidth=1.6,
        label=textwrap.fill(label, LABEL_WIDTH),
        gid=CURVE,
        color=color,
    )
    for cost, style, name in (
        (law.mean, "-", "mean"),
        (quantile, "--", "95% quantile"),
        (cvar, ":", "mean of worst 5%"),
    ):
        ax.axvline(cost, color=curve.get_color(), linewidth=1, linestyle=style, label=f"{name} {cost:.4g}")
    for other in others:
        _stretch(other, left, right)
    ax.set(xlabel="cost", ylabel="probability of paying no more", xlim=(left, right), ylim=(0, 1.02))
    ax.spines[["top", "right"]].set_visible(False)
    ax.legend(loc="lower right", fontsize="small", framealpha=0.85, edgecolor="none")
    return ax


def _limits(costs: Sequence[float], worst: float, shared: Axes | None) -> tuple[float, float]:
    """Return the ends of the axis of costs: of this law, and of those that share the diagram."""
    most = max(costs[-1], worst)
    margin = 0.05 * (most - costs[0]) or 0.05 * (costs[0] or 1.0)
    left, right = costs[0] - margin, most + margin
    if shared is None:
        return left, right
    old_left, old_right = shared.get_xlim()
    return min(left, old_left), max(right, old_right)


def _stretch(curve: Line2D, left: float, right: float) -> None:
    """Let a curve go on, at 0 and at its largest probability, to the ends of the axis."""
    costs = numpy.array(curve.get_xdata())
    costs[0], costs[-1] = left, right
    curve.set_xdata(costs)
