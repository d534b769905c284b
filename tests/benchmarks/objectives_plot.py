"""The figure of `tests.benchmarks.objectives growth`: seconds against what grows, both axes logarithmic."""

from __future__ import annotations

from pathlib import Path

import matplotlib

from tests.benchmarks.objectives import LEAST_SECONDS, Row

PANELS = {"step": "cells for a cost of 1", "days": "days that were observed", "prices": "prices of an action"}
LOOKS = (("#0072b2", "o"), ("#d55e00", "s"))
SIZE = (11.0, 3.6)  # inches


def draw(rows: list[Row], files: list[Path]) -> None:
    """Draw the rows that are solved into every file; the ending tells the kind of image."""
    matplotlib.use("Agg")
    from matplotlib import pyplot

    with matplotlib.rc_context({"svg.hashsalt": "objectives", "font.size": 9}):
        whole, panels = pyplot.subplots(1, len(PANELS), figsize=SIZE, layout="constrained")
        for axes, (kind, title) in zip(panels, PANELS.items(), strict=True):
            found = [row for row in rows if row.problem.startswith(kind) and row.solved]
            labels = dict.fromkeys(row.objective for row in found)
            for label, (colour, marker) in zip(labels, LOOKS, strict=False):
                known = [(size(row), max(row.search_seconds, LEAST_SECONDS)) for row in found if row.objective == label]
                axes.plot(*zip(*sorted(known), strict=True), marker=marker, color=colour, markersize=5, label=label)
            axes.set(xscale="log", yscale="log", xlabel=title, ylabel="seconds of search")
            axes.grid(True, which="major", color="#dddddd", linewidth=0.6)
            axes.spines[["top", "right"]].set_visible(False)
            if labels:
                axes.legend(frameon=False, loc="lower left", bbox_to_anchor=(0, 1))
        for file in files:
            whole.savefig(file, dpi=150, metadata={"Date": None} if file.suffix == ".svg" else None)
        pyplot.close(whole)


def size(row: Row) -> float:
    """How much there is of what grows."""
    kind, number = row.problem.split()
    return 1 / float(number) if kind == "step" else float(number)
