"""Laws of costs as pictures."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from statehtn.errors import UsageError

if TYPE_CHECKING:
    from matplotlib.axes import Axes

CURVE, MEAN, TAIL = "#2f5d9b", "#5b6b82", "#b4561e"


def plot_law(
    costs: Sequence[float],
    probabilities: Sequence[float],
    mean: float,
    worst: tuple[float, float],
    ax: Axes | None = None,
) -> Axes:
    """Draw a distribution function in steps, with its mean and its worst cases.

    Args:
        costs: ascending.
        probabilities: of each cost or less.
        mean: of the law.
        worst: the cost that is not exceeded in 95% of all cases, and the mean of the other 5%.
        ax: where to draw; a new figure where it is None.

    Raises:
        UsageError: matplotlib is not installed.
    """
    try:
        from matplotlib import pyplot
    except ImportError:
        raise UsageError("drawing needs the package 'matplotlib': pip install 'statehtn[plots]'") from None
    if ax is None:
        _, ax = pyplot.subplots(figsize=(6.4, 3.6), layout="constrained")
    margin = 0.05 * (max(costs[-1], worst[1]) - costs[0]) or 0.05 * (costs[0] or 1.0)
    left, right = costs[0] - margin, max(costs[-1], worst[1]) + margin
    ax.step([left, *costs, right], [0.0, *probabilities, probabilities[-1]], where="post", color=CURVE, linewidth=1.6)
    ax.axvline(mean, color=MEAN, linewidth=1, label=f"mean {mean:.4g}")
    ax.axvline(worst[0], color=TAIL, linewidth=1, linestyle="--", label=f"95% quantile {worst[0]:.4g}")
    ax.axvline(worst[1], color=TAIL, linewidth=1, linestyle=":", label=f"mean of the worst 5% {worst[1]:.4g}")
    ax.set(xlabel="cost", ylabel="probability of paying no more", xlim=(left, right), ylim=(0, 1.02))
    ax.spines[["top", "right"]].set_visible(False)
    ax.legend(loc="lower center", bbox_to_anchor=(0.5, 1), ncols=3, frameon=False, fontsize="small")
    return ax
