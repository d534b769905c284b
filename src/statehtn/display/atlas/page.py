"""The page about one problem: one file of HTML that asks for nothing else."""

from __future__ import annotations

import difflib
import math
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from statehtn.atlas.between import all_deadlines, all_wealths
from statehtn.atlas.survey import LEVEL, Atlas, AtlasPlan, Choice
from statehtn.display.atlas.alpha_axis import AlphaAxis, words
from statehtn.experiments.report import page as report
from statehtn.model.cost.law import CostLaw
from statehtn.model.status import Status

FOLDER = Path(__file__).parent
SLIDER_STEPS = 201
BETWEEN = 4
"""Places of the other sliders between two answers, at which is shown what follows from these."""
MOST_ROWS = 2000
"""Of a decomposition: what is longer is cut."""
MOST_CHANGES = 12
"""Actions named where a plan is compared with its neighbour; the others are counted."""
MOST_WITH_LAWS = 60
"""So many plans have a picture of their cost."""


@dataclass(frozen=True, slots=True)
class Card:
    """What the page says of a plan."""

    number: int
    name: str
    colour: str
    length: int
    measures: list[tuple[str, str]]
    where: list[str]
    changes: list[tuple[str, list[str]]]
    law: str
    actions: list[str]
    tree: str


def atlas_page(atlas: Atlas) -> str:
    """Return the page.

    Raises:
        UsageError: a package that it needs is not installed.
    """
    environment = report.environment_of_pages()
    page = environment.from_string(_asset("page.html.jinja")).render(
        atlas=atlas,
        style=(report.FOLDER / "page.css").read_text(encoding="utf-8") + _asset("page.css"),
        script=_asset("page.js"),
        **(_content(atlas) if atlas.map.pieces else {}),
    )
    return str(page)


def check_packages() -> None:
    """Look for everything that the page needs.

    Raises:
        UsageError: it is not installed.
    """
    report.environment_of_pages()


def _asset(name: str) -> str:
    return (FOLDER / name).read_text(encoding="utf-8")


def _content(atlas: Atlas) -> dict[str, Any]:
    from statehtn.display.atlas.pictures import frontier_picture, map_picture

    axis = AlphaAxis.of(atlas.map)
    svg, frame = map_picture(atlas, axis)
    frontiers = [(one, frontier_picture(one, atlas, f"frontier-{index}")) for index, one in enumerate(atlas.frontiers)]
    return {
        "map": svg,
        "frontiers": frontiers,
        "intervals": _intervals(atlas),
        "cards": [_card(atlas, number, plan) for number, plan in enumerate(atlas.plans)],
        "costs": _costs(atlas),
        "data": {
            "frame": [frame.left, frame.right, frame.top, frame.bottom],
            "alpha": _alpha_steps(atlas, axis),
            "deadline": _choice_steps(atlas, "deadline", all_deadlines(atlas, BETWEEN), atlas.deadlines),
            "wealth": _choice_steps(atlas, "wealth", all_wealths(atlas, BETWEEN), atlas.wealths),
        },
        "start": _neutral_step(axis),
        "open": _open(atlas),
        "level": LEVEL,
    }


def _alpha_steps(atlas: Atlas, axis: AlphaAxis) -> list[list[object]]:
    """Return for each step of the slider the plan, what is said of it, and where its marker stands, from 0 to 1."""
    steps: list[list[object]] = []
    for index, place in enumerate(axis.places(SLIDER_STEPS)):
        alpha = axis.low if index == 0 else axis.high if index == SLIDER_STEPS - 1 else axis.alpha(place)
        alpha = 0.0 if abs(place) < 1e-12 else alpha
        at = next(at for at, piece in enumerate(atlas.map.pieces) if alpha <= piece.high)
        piece, plan = atlas.map.pieces[at], atlas.of_piece[at]
        value = piece.certainty_equivalent(alpha)
        said = f"alpha {words(alpha)}: plan {atlas.plans[plan].name}, certainty equivalent {value:.6g}"
        said += "" if piece.gap <= 1e-9 * max(value, 1e-9) else f" (another plan may be better by {piece.gap:.2g})"
        steps.append([plan, said, index / (SLIDER_STEPS - 1)])
    return steps


def _neutral_step(axis: AlphaAxis) -> int:
    places = axis.places(SLIDER_STEPS)
    return min(range(SLIDER_STEPS), key=lambda index: abs(places[index]))


def _choice_steps(atlas: Atlas, what: str, known: Sequence[Choice], asked: Sequence[Choice]) -> list[list[object]]:
    """Return for each step of a slider the plan, and what is said of it: less where nothing was searched for."""
    answers = {choice.at for choice in asked}
    return [_choice_step(atlas, choice, f"{what} {choice.at:.6g}", choice.at in answers) for choice in known]


def _choice_step(atlas: Atlas, choice: Choice, what: str, is_answer: bool) -> list[object]:
    if choice.plan is None:
        return [None, f"{what}: no plan was found in time", 0.0]
    said = f"{what}: plan {atlas.plans[choice.plan].name}, value {choice.value:.5g}"
    which = "another plan" if is_answer else "a plan that is not on this page"
    if choice.gap is None:
        return [choice.plan, f"{said} (nothing is proven)", 0.0]
    is_best = choice.gap <= 1e-5 * max(1.0, abs(choice.value or 0))
    return [choice.plan, said + ("" if is_best else f" ({which} may be better by up to {choice.gap:.2g})"), 0.0]


def _intervals(atlas: Atlas) -> list[tuple[str, str, AtlasPlan, int, str]]:
    ends = [words(atlas.map.low), *(_break_words(one.low, one.high) for one in atlas.map.breaks), words(atlas.map.high)]
    return [
        (ends[at], ends[at + 1], atlas.plans[plan], plan, f"{piece.gap:.2g}" if piece.gap else "0")
        for at, (piece, plan) in enumerate(zip(atlas.map.pieces, atlas.of_piece, strict=True))
    ]


def _break_words(low: float, high: float) -> str:
    """Return a break point by one number where its ends agree in the digits that are shown."""
    middle = (low + high) / 2
    if high - low <= 2e-4 * abs(middle) or max(abs(low), abs(high)) < 1e-9:
        return words(0.0 if abs(middle) < 1e-9 else middle)
    return f"{words(low)} to {words(high)}"


def _open(atlas: Atlas) -> list[str]:
    """Return what is not proven or was not done, a sentence each."""
    found = atlas.map
    said = []
    if found.status is not Status.OPTIMAL:
        gap = f"another plan may be better by up to {found.gap:.3g}"
        said.append(f"The map is not certified everywhere: for some alphas {gap}, in certainty equivalents.")
    if found.stopped is not None:
        said.append(f"The search for the map was ended before it was done ({found.stopped}).")
    said += [
        f"The frontier of {one.risk} is not complete: plans may be missing between those shown."
        for one in atlas.frontiers
        if one.status is not Status.OPTIMAL
    ]
    if len(atlas.frontiers) < 3:
        said.append("There was no time for every frontier.")
    return said


def _card(atlas: Atlas, number: int, plan: AtlasPlan) -> Card:
    from statehtn.display.atlas.pictures import colour, law_picture
    from statehtn.display.tree import tree_text

    rows = plan.found.plan.decomposition.rows
    tree = tree_text(rows[:MOST_ROWS]) + (f"\n… {len(rows) - MOST_ROWS} more" if len(rows) > MOST_ROWS else "")
    return Card(
        number,
        plan.name,
        colour(number),
        plan.found.length,
        _measures(plan.total),
        _where(atlas, number),
        [(atlas.plans[other].name, _changes(plan, atlas.plans[other])) for other in _neighbours(atlas, number)],
        law_picture(plan, number) if number < MOST_WITH_LAWS else "",
        [str(step.step) for step in plan.found.steps],
        tree,
    )


def _measures(total: CostLaw) -> list[tuple[str, str]]:
    named = [
        ("mean", total.mean),
        ("standard deviation", total.standard_deviation),
        ("least", total.least),
        *((f"{level:.0%} quantile", total.quantile(level)) for level in (0.05, 0.5, 0.95)),
        (f"mean of the worst {1 - LEVEL:.0%}", total.cvar(LEVEL)),
        ("most", total.most),
    ]
    return [(name, f"{value:.6g}" if math.isfinite(value) else "\N{INFINITY}") for name, value in named]


def _where(atlas: Atlas, number: int) -> list[str]:
    """Return for whom a plan is the best."""
    places = [f"alpha from {low} to {high}" for low, high, _, plan, _ in _intervals(atlas) if plan == number]
    shown = [(one.risk, {atlas.number(point.found) for point in one.points}) for one in atlas.frontiers]
    places += [f"the frontier of {risk}" for risk, numbers in shown if number in numbers]
    for what, choices in (("deadline", atlas.deadlines), ("wealth", atlas.wealths)):
        own = [choice.at for choice in choices if choice.plan == number]
        if own:
            places.append(f"{what} {own[0]:g}" + (f" to {own[-1]:g}" if len(own) > 1 else ""))
    return places


def _neighbours(atlas: Atlas, number: int) -> list[int]:
    """Return the plans next to a plan on the map; of one that is not there, the plan of the mildest agent."""
    own = [at for at, plan in enumerate(atlas.of_piece) if plan == number]
    near = {atlas.of_piece[at + step] for at in own for step in (-1, 1) if 0 <= at + step < len(atlas.of_piece)}
    near = near if own else {atlas.mildest}
    return sorted(near - {number})


def _changes(plan: AtlasPlan, other: AtlasPlan) -> list[str]:
    """Return what a plan does instead of what another one does, a line for each place where they part."""
    mine, its = ([str(step.step) for step in one.found.steps] for one in (plan, other))
    lines = []
    for tag, start, end, other_start, other_end in difflib.SequenceMatcher(
        None, its, mine, autojunk=False
    ).get_opcodes():
        if tag != "equal":
            dropped, added = _listed(its[start:end]), _listed(mine[other_start:other_end])
            lines.append(f"{added or 'nothing'} instead of {dropped or 'nothing'}")
    return lines[:MOST_CHANGES] + ([f"and {len(lines) - MOST_CHANGES} more"] if len(lines) > MOST_CHANGES else [])


def _listed(actions: Sequence[str]) -> str:
    if len(actions) > MOST_CHANGES:
        return f"{' '.join(actions[:MOST_CHANGES])} … ({len(actions)} actions)"
    return " ".join(actions)


def _costs(atlas: Atlas) -> list[tuple[str, list[str], list[str]]]:
    """Return for each action its law and measures as text, and how often each plan of the map executes it."""
    plans = [atlas.plans[number] for number in dict.fromkeys(atlas.of_piece)]
    counts = [Counter((step.step, step.law) for step in plan.found.steps) for plan in plans]
    rows = []
    for step in atlas.steps():
        law = step.law
        numbers = [law.mean, law.standard_deviation, law.least, law.most]
        shown = [f"{value:.6g}" if math.isfinite(value) else "\N{INFINITY}" for value in numbers]
        times = [str(count[step.step, law]) if count[step.step, law] else "" for count in counts]
        rows.append((str(step.step), shown, times))
    return rows
