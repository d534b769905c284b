"""The figures of the report; what they show is in their captions, which the page writes."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from statehtn.experiments.report.svg import PLACEHOLDERS, STYLE, inline_svg
from statehtn.model.cost.law import CostLaw

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

SIZE = (5.0, 3.6)  # inches of 72 units: a phone shows the units as pixels, more or less
SQUARE = (5.0, 4.7)
MARKERS = {"o": "●", "^": "▲", "s": "■", "D": "◆", "v": "▼", "P": "✚"}
"""The markers, and how text shows them."""
DASHES: dict[str, tuple[float, ...]] = {"solid": (), "dashed": (5, 2), "dotted": (1.5, 1.5), "mixed": (6, 2, 1.5, 2)}
MOST_TICKS = 7
STEPS = 400
"""A curve has no more steps than can be seen."""


@dataclass(frozen=True, slots=True)
class Look:
    """How a series is drawn: a colour of the page, a marker and a dash pattern."""

    colour: str
    marker: str = "o"
    dash: str = "solid"

    @property
    def sign(self) -> str:
        """The marker as text."""
        return MARKERS[self.marker]

    @property
    def pattern(self) -> str:
        """The dash pattern as SVG has it."""
        return " ".join(f"{length:g}" for length in DASHES[self.dash])


@dataclass(frozen=True, slots=True)
class Point:
    """Two measures of one thing, None where it was not solved, and its name."""

    x: float | None
    y: float | None
    tip: str


@dataclass(frozen=True, slots=True)
class Curve:
    """The distribution of a plan's total cost."""

    total: CostLaw
    look: Look


def scatter(name: str, label: str, axes_labels: tuple[str, str], groups: Sequence[tuple[Look, Sequence[Point]]]) -> str:
    """Draw two measures against each other, on logarithmic scales, with those that one has not solved on the rims.

    Args:
        name: of the figure, unique on the page.
        label: what it shows.
        axes_labels: of x and y.
        groups: points with one look; each has x or y, and both are positive.
    """
    with _style():
        figure, axes = _figure(SQUARE)
        values = [value for _, points in groups for point in points for value in (point.x, point.y) if value]
        low, high = _bounds(values)
        rim = high * (high / low) ** 0.07
        has_rim = any(value is None for _, points in groups for point in points for value in (point.x, point.y))
        end = rim * (high / low) ** 0.04 if has_rim else high
        axes.plot([low, high], [low, high], color=PLACEHOLDERS["muted"], linewidth=0.8)
        if has_rim:
            for draw in (axes.axvline, axes.axhline):
                draw(rim, color=PLACEHOLDERS["muted"], linewidth=0.8, dashes=DASHES["dotted"])
        tips = {}
        for index, (look, points) in enumerate(groups):
            axes.scatter(
                [rim if point.x is None else point.x for point in points],
                [rim if point.y is None else point.y for point in points],
                s=26,
                marker=look.marker,
                color=PLACEHOLDERS[look.colour],
                alpha=0.75,
                linewidths=0,
                gid=f"points-{index}",
                clip_on=False,
                zorder=3,
            )
            tips[f"points-{index}"] = [point.tip for point in points]
        axes.set(xscale="log", yscale="log", xlim=(low, end), ylim=(low, end))
        axes.set(xlabel=axes_labels[0], ylabel=axes_labels[1])
        for axis in (axes.xaxis, axes.yaxis):
            ticks = _logarithmic(axis, low, high)
            if has_rim:
                ticks = [tick for tick in ticks if tick < 0.9 * high]
                axis.set_ticks([*ticks, rim], labels=[*map(amount, ticks), "not solved"])
        return inline_svg(figure, name, label, tips)


def cactus(name: str, label: str, ylabel: str, series: Sequence[tuple[Look, Sequence[float]]]) -> str:
    """Draw how many are solved within which time, for each series of positive times in seconds."""
    from matplotlib.ticker import MaxNLocator

    with _style():
        figure, axes = _figure(SIZE)
        low, high = _bounds([value for _, values in series for value in values])
        for look, values in series:
            axes.plot(
                range(1, len(values) + 1),
                sorted(values),
                color=PLACEHOLDERS[look.colour],
                linewidth=1.8,
                dashes=DASHES[look.dash] or (None, None),
                marker=look.marker,
                markersize=4,
                markevery=[len(values) - 1],
                solid_capstyle="round",
            )
        axes.set(yscale="log", ylim=(low, high), xlim=(0, max(len(values) for _, values in series) * 1.03))
        axes.set(xlabel="solved", ylabel=ylabel)
        axes.xaxis.set_major_locator(MaxNLocator(integer=True))
        _logarithmic(axes.yaxis, low, high)
        return inline_svg(figure, name, label)


def distributions(name: str, label: str, curves: Sequence[Curve]) -> str:
    """Draw the probability that the total cost does not exceed a value, for several plans."""
    with _style():
        figure, axes = _figure(SIZE)
        left = min(curve.total.least for curve in curves)
        right = max(curve.total.quantile(0.999) for curve in curves)
        margin = 0.06 * (right - left) or max(0.05 * right, 1.0)
        for curve in reversed(curves):
            axes.plot(
                *curve.total.curve(STEPS),
                drawstyle="steps-post",
                color=PLACEHOLDERS[curve.look.colour],
                linewidth=2,
                dashes=DASHES[curve.look.dash] or (None, None),
            )
        axes.set(xlim=(left - margin, right + margin), ylim=(0, 1.02), yticks=[0, 0.25, 0.5, 0.75, 1])
        axes.set_yticklabels(["0", "25 %", "50 %", "75 %", "100 %"])
        axes.set(xlabel="total cost of the plan", ylabel="chance to pay no more")
        return inline_svg(figure, name, label)


def amount(value: float) -> str:
    """Return a number as an axis shows it."""
    for unit, factor in (("M", 1e6), ("k", 1e3)):
        if value >= 10 * factor:
            return f"{value / factor:g}{unit}"
    return f"{value:g}"


def _style() -> Any:
    from matplotlib import rc_context

    return rc_context(STYLE)


def _figure(size: tuple[float, float]) -> tuple[Figure, Axes]:
    from matplotlib.figure import Figure

    figure = Figure(figsize=size, layout="constrained")
    return figure, figure.add_subplot()


def _bounds(values: Sequence[float]) -> tuple[float, float]:
    """Return the numbers 1, 2 or 5 times a power of ten between which all values are."""
    steps = _steps(min(values) / 10, max(values) * 10)
    return max(step for step in steps if step < min(values)), min(step for step in steps if step > max(values))


def _steps(low: float, high: float, mantissas: Sequence[int] = (1, 2, 5)) -> list[float]:
    """Return the powers of ten and their multiples from one number to another."""
    exponents = range(math.floor(math.log10(low)), math.ceil(math.log10(high)) + 1)
    steps = [float(f"{mantissa}e{exponent}") for exponent in exponents for mantissa in mantissas]
    return [step for step in steps if low * 0.999 <= step <= high * 1.001]


def _logarithmic(axis: Any, low: float, high: float) -> list[float]:
    """Label a logarithmic axis, and return where; some seven labels."""
    from matplotlib.ticker import NullLocator

    ticks = _steps(low, high)
    if len(ticks) > MOST_TICKS:
        ticks = _steps(low, high, (1,))
        ticks = ticks[:: -(-len(ticks) // MOST_TICKS)]
    axis.set_minor_locator(NullLocator())
    axis.set_ticks(ticks, labels=[amount(tick) for tick in ticks])
    return ticks
