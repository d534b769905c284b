"""The figure of `tests.benchmarks.growth`: time, nodes and memory against size, both axes logarithmic."""

from __future__ import annotations

from pathlib import Path

import matplotlib

from tests.benchmarks.growth import MEASURES, Measure, fit, points
from tests.benchmarks.records import Row

LOOKS = (("#0072b2", "o"), ("#d55e00", "s"), ("#009e73", "^"))
SIZE = (11.0, 3.8)  # inches


def draw(found: dict[str, list[Row]], files: list[Path]) -> None:
    """Draw the rows by family, with the fitted powers, into every file; the ending tells the kind of image."""
    matplotlib.use("Agg")
    from matplotlib import pyplot

    with matplotlib.rc_context({"svg.hashsalt": "growth", "font.size": 9}):
        figure, panels = pyplot.subplots(1, len(MEASURES), figsize=SIZE, sharex=True, layout="constrained")
        for axes, what in zip(panels, MEASURES, strict=True):
            for (name, rows), (colour, marker) in zip(found.items(), LOOKS, strict=False):
                _family(axes, name, rows, what, colour, marker)
            axes.set(xscale="log", yscale="log", xlabel="ground actions and methods", ylabel=what.name)
            axes.grid(True, which="major", color="#dddddd", linewidth=0.6)
            axes.spines[["top", "right"]].set_visible(False)
            if axes.has_data():
                axes.legend(frameon=False, loc="lower left", bbox_to_anchor=(0, 1))
        for file in files:
            figure.savefig(file, dpi=150, metadata={"Date": None} if file.suffix == ".svg" else None)
        pyplot.close(figure)


def _family(axes: matplotlib.axes.Axes, name: str, rows: list[Row], what: Measure, colour: str, marker: str) -> None:
    """Draw a family's points and, where there are enough, the line fitted to them."""
    known = points(rows, what)
    if not known:
        return
    sizes, values = zip(*known, strict=True)
    fitted = fit(known)
    label = f"{name}: size$^{{{fitted.exponent:.1f}}}$" if fitted else name
    axes.plot(sizes, values, marker, color=colour, markersize=5, label=label)
    if fitted:
        ends = [min(sizes), max(sizes)]
        axes.plot(ends, [fitted.factor * end**fitted.exponent for end in ends], color=colour, linewidth=1)
