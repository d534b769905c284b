"""Where pictures are drawn."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from statehtn.errors import UsageError
from statehtn.expected import shown

if TYPE_CHECKING:
    from matplotlib.axes import Axes


def new_or_given(ax: Axes | None, **figure: Any) -> Axes:
    """Return the axes that are given, or those of a new figure.

    Raises:
        UsageError: matplotlib is not installed, or these are no axes.
    """
    try:
        from matplotlib import axes, pyplot
    except ImportError:
        raise UsageError("drawing needs the package 'matplotlib': pip install 'statehtn[plots]'") from None
    if ax is None:
        _, ax = pyplot.subplots(**figure)
    if not isinstance(ax, axes.Axes):
        raise UsageError(
            f"expected axes of matplotlib to draw on, found {shown(ax)}; of several take one, such as axes[0]"
        )
    return ax
