"""Two solvers, or one with two settings, on the same problems: who needs how much time, and how many expansions."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

from statehtn.experiments.report.cases import Case, by_question
from statehtn.experiments.report.plots import Look, Point, scatter
from statehtn.experiments.report.tables import figure

MOST_DUELS = 6


@dataclass(frozen=True, slots=True)
class Measure:
    """Something to be measured: its name, its unit on an axis, and the least that a logarithmic scale shows."""

    name: str
    unit: str
    of: Callable[[Case], float | None]
    least: float


MEASURES = (
    Measure("time", "seconds", lambda case: case.seconds, 1e-4),
    Measure("expansions", "expansions", lambda case: case.expanded, 1.0),
)


@dataclass(frozen=True, slots=True)
class Duel:
    """Two settings compared by one measure.

    Args:
        name: of the figure, unique on the page.
        title: what is compared.
        svg: the figure.
        caption: who needs less, and how often.
    """

    name: str
    title: str
    svg: str
    caption: str


def duels(cases: Sequence[Case], settings: Sequence[str], looks: Mapping[str, Look]) -> list[Duel]:
    """Return the first settings against each of the others, in time and in expansions.

    Args:
        cases: all of them.
        settings: in order; at most `MOST_DUELS` beside the first.
        looks: how the points of each domain are drawn.
    """
    found: list[Duel] = []
    questions = by_question(cases)
    for other in settings[1 : 1 + MOST_DUELS]:
        pairs = []
        for group in questions.values():
            both = {case.settings: case for case in group}
            if settings[0] in both and other in both:
                pairs.append((both[settings[0]], both[other]))
        for measure in MEASURES:
            duel = _duel(f"duel-{len(found) + 1}", measure, (settings[0], other), pairs, looks)
            if duel is not None:
                found.append(duel)
    return found


def _duel(
    name: str,
    measure: Measure,
    settings: tuple[str, str],
    pairs: Sequence[tuple[Case, Case]],
    looks: Mapping[str, Look],
) -> Duel | None:
    points: dict[str, list[Point]] = {}
    for left, right in pairs:
        x, y = (max(measure.of(c) or 0.0, measure.least) if c.is_answered else None for c in (left, right))
        if x is not None or y is not None:
            tip = f"{left.problem}, {left.agent}: {_value(x)} against {_value(y)} {measure.unit}"
            points.setdefault(left.domain, []).append(Point(x, y, tip))
    if not points:
        return None
    groups = [(looks[domain], own) for domain, own in points.items()]
    title = f"{measure.name}: {settings[0]} against {settings[1]}"
    labels = (f"{settings[0]}: {measure.unit}", f"{settings[1]}: {measure.unit}")
    caption = _caption([point for own in points.values() for point in own], len(pairs), settings)
    return Duel(name, title, scatter(name, f"{title}. {caption}", labels, groups), caption)


def _value(value: float | None) -> str:
    return "not solved" if value is None else figure(value, 3)


def _caption(points: Sequence[Point], asked: int, settings: tuple[str, str]) -> str:
    """Say who needs less how often, by how much on average, and what was not solved."""
    both = [(point.x, point.y) for point in points if point.x is not None and point.y is not None]
    parts = []
    if both:
        less, more = sum(x < y for x, y in both), sum(x > y for x, y in both)
        ratio = math.exp(sum(math.log(y / x) for x, y in both) / len(both))
        winner, factor = (settings[0], ratio) if ratio >= 1 else (settings[1], 1 / ratio)
        parts.append(
            f"Solved by both: {len(both)} of {asked}. {settings[0]} needs less {less} times, {settings[1]} {more} "
            f"times; the geometric mean is {figure(factor, 3)} times lower for {winner}."
        )
    alone = [sum(point.y is None for point in points), sum(point.x is None for point in points)]
    parts += [f"Solved by {who} alone: {count}." for who, count in zip(settings, alone, strict=True) if count]
    if asked > len(points):
        parts.append(f"By neither: {asked - len(points)}.")
    return " ".join(parts)
