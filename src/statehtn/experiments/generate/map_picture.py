"""Draw the map of a vehicle problem."""

from __future__ import annotations

from pathlib import Path

from statehtn.errors import UsageError
from statehtn.experiments.generate.roads import END, START, Kind, RoadMap

COLOURS = {Kind.COUNTRY: "#555555", Kind.SHORTCUT: "#d55e00", Kind.HIGHWAY: "#0072b2", Kind.SIDE: "#bbbbbb"}
WIDTHS = {Kind.COUNTRY: 1.6, Kind.SHORTCUT: 1.6, Kind.HIGHWAY: 3.2, Kind.SIDE: 1.0}
ICE = "#56b4e9"
MOST_NAMES = 80  # locations; with more of them their names would hide the roads


def draw_map(road_map: RoadMap, names: list[str], file: Path) -> None:
    """Draw roads by their kinds, and what is in the way, into an SVG file.

    Args:
        road_map: the map.
        names: of its locations.
        file: the picture.

    Raises:
        UsageError: matplotlib is missing, or the file cannot be written.
    """
    try:
        import matplotlib as mpl
        from matplotlib.figure import Figure
    except ImportError:
        raise UsageError("a map needs matplotlib: pip install 'statehtn[plots]'") from None

    mpl.rcParams["svg.hashsalt"] = "statehtn"  # the same picture makes the same bytes
    figure = Figure(figsize=(10, 6), layout="constrained")
    axes = figure.add_subplot()
    axes.set_aspect("equal")
    axes.axis("off")
    for road in road_map.roads:
        ends = [road_map.places[road.tail], road_map.places[road.head]]
        x, y = zip(*ends, strict=True)
        if road.is_slippery:
            axes.plot(x, y, color=ICE, linewidth=6, solid_capstyle="round", zorder=1)
        axes.plot(x, y, color=COLOURS[road.kind], linewidth=WIDTHS[road.kind], solid_capstyle="round", zorder=2)
        if not road.is_two_way:
            middle = ((x[0] + x[1]) / 2, (y[0] + y[1]) / 2)
            beyond = (middle[0] + 0.01 * (x[1] - x[0]), middle[1] + 0.01 * (y[1] - y[0]))
            arrow = {"arrowstyle": "-|>", "color": COLOURS[road.kind], "linewidth": 0, "mutation_scale": 9}
            axes.annotate("", beyond, middle, arrowprops=arrow, zorder=2)
    for place, (x_at, y_at) in enumerate(road_map.places):
        marker = "^" if place in road_map.moving else "s" if place in road_map.still else "o"
        colour = "#e69f00" if marker == "^" else "#cc79a7" if marker == "s" else "white"
        size = 9 if place in (START, END) or marker != "o" else 4
        axes.plot(x_at, y_at, marker, color=colour, markeredgecolor="black", markersize=size, zorder=3)
        if place in (START, END) or len(names) <= MOST_NAMES:
            axes.annotate(names[place], (x_at, y_at), (4, 5), textcoords="offset points", fontsize=8, zorder=4)
    _explain(axes)
    try:
        figure.savefig(file, format="svg", metadata={"Date": None})
    except OSError as error:
        raise UsageError(f"cannot write '{file}': {error.strerror}") from None


def _explain(axes: object) -> None:
    """Add the legend."""
    from matplotlib.axes import Axes
    from matplotlib.lines import Line2D

    assert isinstance(axes, Axes)
    lines = [Line2D([], [], color=COLOURS[kind], linewidth=WIDTHS[kind], label=kind.value) for kind in Kind]
    lines.append(Line2D([], [], color=ICE, linewidth=6, label="ice"))
    for marker, colour, label in (("^", "#e69f00", "pedestrians"), ("s", "#cc79a7", "building site")):
        lines.append(Line2D([], [], color=colour, marker=marker, markeredgecolor="black", linestyle="", label=label))
    axes.legend(handles=lines, loc="upper center", bbox_to_anchor=(0.5, 0.0), ncols=4, frameon=False, fontsize=8)
