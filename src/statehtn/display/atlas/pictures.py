"""The figures of the page: the attitude map, the frontiers, and the law of each plan's total cost."""

from __future__ import annotations

import math
from dataclasses import dataclass

from matplotlib import rc_context
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.transforms import blended_transform_factory

from statehtn.atlas.survey import Atlas, AtlasPlan
from statehtn.display.atlas.alpha_axis import AlphaAxis
from statehtn.experiments.report.plots import SIZE, STEPS
from statehtn.experiments.report.svg import PLACEHOLDERS, STYLE, inline_svg
from statehtn.sweeps.frontier import Frontier

COLOURS = 6
POINTS = 241
"""Of a curve on the map."""
WIDE = (9.0, 4.2)  # inches
BAND = 0.06  # of the height of the map: where the intervals are shown
UNITS = 72  # of the SVG in an inch


@dataclass(frozen=True, slots=True)
class Frame:
    """Where the axes of a figure stand, in the units of its SVG: what a marker is moved in."""

    left: float
    right: float
    top: float
    bottom: float


def colour(plan: int) -> str:
    """Return the colour of a plan, as the page calls it."""
    return f"series-{plan % COLOURS + 1}"


def map_picture(atlas: Atlas, axis: AlphaAxis) -> tuple[str, Frame]:
    """Draw every plan's certainty equivalent over alpha, bold where the plan is best, and the intervals as a band."""
    with rc_context(STYLE):
        figure = Figure(figsize=WIDE, layout="constrained")
        axes = figure.add_subplot()
        places = axis.places(POINTS)
        lowest, highest = math.inf, -math.inf
        for piece, plan in zip(atlas.map.pieces, atlas.of_piece, strict=True):
            values = [_drawable(piece.certainty_equivalent(axis.alpha(place))) for place in places]
            own = [place for place in places if axis.place(piece.low) <= place <= axis.place(piece.high)]
            own = sorted({axis.place(piece.low), *own, axis.place(piece.high)})
            best = [_drawable(piece.certainty_equivalent(axis.alpha(place))) for place in own]
            look = PLACEHOLDERS[colour(plan)]
            axes.plot(places, values, color=look, linewidth=0.9, alpha=0.6)
            axes.plot(own, best, color=look, linewidth=3.2, solid_capstyle="butt")
            lowest = min(lowest, *(value for value in best if math.isfinite(value)))
            highest = max(highest, *(value for value in best if math.isfinite(value)))
        _band(axes, atlas, axis)
        margin = 0.06 * (highest - lowest) or 1.0
        axes.set(xlim=(places[0], places[-1]), ylim=(lowest - 2.5 * margin, highest + margin))
        ticks = axis.ticks()
        axes.set_xticks([place for place, _ in ticks], [label for _, label in ticks])
        axes.set(xlabel="seeking  ←  alpha  →  averse", ylabel="certainty equivalent")
        return _with_frame(figure, axes, "map", "The certainty equivalent of every plan over alpha")


def _band(axes: Axes, atlas: Atlas, axis: AlphaAxis) -> None:
    """Draw the intervals along the lower end of the map, with the names of their plans where there is room."""
    across = blended_transform_factory(axes.transData, axes.transAxes)
    for piece, plan in zip(atlas.map.pieces, atlas.of_piece, strict=True):
        left, right = axis.place(piece.low), axis.place(piece.high)
        axes.axvspan(left, right, 0, BAND, color=PLACEHOLDERS[colour(plan)], linewidth=0, alpha=0.9)
        if right - left > 0.03:
            name = atlas.plans[plan].name
            axes.text((left + right) / 2, BAND * 1.3, name, transform=across, ha="center", va="bottom")


def frontier_picture(frontier: Frontier, atlas: Atlas, name: str) -> str:
    """Draw mean against risk: the frontier in steps, and the other plans of the page where their risk is known."""
    with rc_context(STYLE):
        figure = Figure(figsize=SIZE, layout="constrained")
        axes = figure.add_subplot()
        means = [point.mean for point in frontier.points]
        risks = [point.risk for point in frontier.points]
        axes.step(means, risks, where="post", color=PLACEHOLDERS["muted"], linewidth=1.2)
        numbers = [atlas.number(point.found) for point in frontier.points]
        axes.scatter(
            means,
            risks,
            s=42,
            c=[PLACEHOLDERS[colour(number)] for number in numbers],
            gid=f"{name}-points",
            clip_on=False,
            zorder=3,
        )
        tips = []
        for number, mean, risk in zip(numbers, means, risks, strict=True):
            plan = atlas.plans[number].name
            axes.annotate(plan, (mean, risk), (5, 5), textcoords="offset points")
            tips.append(f"plan {plan}: mean {mean:.6g}, {frontier.risk} {risk:.6g}")
        axes.set(xlabel="expected cost", ylabel=_risk_words(frontier.risk))
        axes.margins(0.12)
        return inline_svg(figure, name, f"Expected cost against {frontier.risk}", {f"{name}-points": tips})


def law_picture(plan: AtlasPlan, number: int) -> str:
    """Draw the chance to pay no more than an amount."""
    with rc_context(STYLE):
        figure = Figure(figsize=(SIZE[0], 2.6), layout="constrained")
        axes = figure.add_subplot()
        costs, chances = plan.total.curve(STEPS)
        left, right = plan.total.least, plan.total.quantile(0.999)
        margin = 0.06 * (right - left) or max(0.05 * right, 1.0)
        axes.plot(
            [left - margin, *costs, right + margin],
            [0.0, *chances, chances[-1]],
            drawstyle="steps-post",
            color=PLACEHOLDERS[colour(number)],
            linewidth=2,
        )
        axes.axvline(plan.total.mean, color=PLACEHOLDERS["muted"], linewidth=1)
        axes.set(xlim=(left - margin, right + margin), ylim=(0, 1.03), yticks=[0, 0.25, 0.5, 0.75, 1])
        axes.set_yticklabels(["0", "25 %", "50 %", "75 %", "100 %"])
        axes.set(xlabel="total cost (the line: its mean)", ylabel="chance to pay no more")
        return inline_svg(figure, f"law-{number}", f"The law of the total cost of plan {plan.name}")


def _with_frame(figure: Figure, axes: Axes, name: str, label: str) -> tuple[str, Frame]:
    svg = inline_svg(figure, name, label)
    box = axes.get_position()
    width, height = (size * UNITS for size in figure.get_size_inches())
    return svg, Frame(box.x0 * width, box.x1 * width, (1 - box.y1) * height, (1 - box.y0) * height)


def _drawable(value: float) -> float:
    return value if math.isfinite(value) else math.nan


def _risk_words(risk: str) -> str:
    kind, *numbers = risk.split()
    if kind == "deadline":
        return f"chance to pay more than {numbers[0]}"
    return "standard deviation" if kind == "deviation" else f"mean of the worst {100 * (1 - float(numbers[0])):g} %"
