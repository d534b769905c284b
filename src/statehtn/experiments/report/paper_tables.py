"""The tables of results that the paper prints, and the same rows from a comparison beside them.

Source: "Risk Awareness in HTN Planning", section "Experimental Evaluation"; `paper/*.csv` are its two tables.
"""

from __future__ import annotations

import csv
import statistics
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from decimal import Decimal, InvalidOperation
from functools import cache
from pathlib import Path

from statehtn.experiments.report.cases import Case, best_of, by_question
from statehtn.experiments.report.results import Agent, Outcome
from statehtn.experiments.report.tables import NOTHING, Cell, Column, Table, seconds, typeset
from statehtn.model.status import Status
from statehtn.risk import objective

FOLDER = Path(__file__).parent / "paper"
ABBREVIATIONS = {"seeking": "RS", "averse": "RA", "neutral": "RN"}
PrintedRow = Mapping[str, str]


@dataclass(frozen=True, slots=True)
class PaperTable:
    """A table of the paper.

    Args:
        name: of its file.
        domain: the name of the domain here.
        title: what it is about.
        heading: what it calls its first column.
        ours: instances whose problem is not the paper's, which has not published it, but one of the same size.
        note: what one must know to compare.
    """

    name: str
    domain: str
    title: str
    heading: str
    ours: frozenset[str]
    note: str


PAPER_TABLES = (
    PaperTable(
        "av_results",
        "av",
        "Autonomous vehicles",
        "#P",
        frozenset({"P2", "P3", "P4", "P5"}),
        "The paper gives the sizes of P2 to P5 but not their maps. Ours are other maps of the same sizes: only times "
        "and sizes compare. P1 is that of the paper, where for RN plans of 8 and of 9 actions tie.",
    ),
    PaperTable(
        "satellite_results",
        "satellite",
        "Satellites",
        "problem",
        frozenset(),
        "Costs and instances were recovered from the results that the paper prints.",
    ),
)


@dataclass(frozen=True, slots=True)
class Comparison:
    """A table of the paper beside the same rows of a comparison.

    Args:
        paper: the paper's table.
        table: both, side by side.
        rows: the paper's rows that the comparison has run.
        compared: the printed numbers of the paper's own problems that a proven plan of ours is there for; no times.
        equal: those of them that ours is, to the last printed digit.
    """

    paper: PaperTable
    table: Table
    rows: int
    compared: int
    equal: int


@cache
def printed_rows(name: str) -> tuple[PrintedRow, ...]:
    """Return the lines of a table as they are printed."""
    with (FOLDER / f"{name}.csv").open(newline="", encoding="utf-8") as file:
        return tuple(csv.DictReader(file))


def agrees(value: object, printed: str) -> bool:
    """Tell whether a value rounds to a printed number: it is off by half a unit of the last printed digit at most."""
    expected = Decimal(printed)
    exponent = expected.as_tuple().exponent
    assert isinstance(exponent, int)
    half_a_digit = Decimal(1).scaleb(exponent) / 2
    noise = abs(expected) * Decimal("1e-12")
    return abs(Decimal(str(value)) - expected) <= half_a_digit + noise


def compare_with_paper(cases: Sequence[Case], settings: Sequence[str]) -> list[Comparison]:
    """Return the paper's tables beside the rows of a comparison; those of which it has none are left out.

    Our numbers are those of the best plan that any settings have found; each settings have a column of times.
    """
    found = []
    questions = by_question(cases)
    for paper in PAPER_TABLES:
        rows = []
        for printed in printed_rows(paper.name):
            problem = printed["instance"].lower() if paper.domain == "av" else printed["instance"]
            group = questions.get((paper.domain, problem, _agent(printed)), [])
            if group:
                rows.append((printed, group))
        if rows:
            found.append(_comparison(paper, rows, settings))
    return found


def _comparison(
    paper: PaperTable, rows: Sequence[tuple[PrintedRow, list[Case]]], settings: Sequence[str]
) -> Comparison:
    asked = {case.settings for _, group in rows for case in group}
    shown = [name for name in settings if name in asked]
    columns = [
        Column(paper.heading, is_text=True),
        Column("attitude", is_text=True),
        *(Column(who, what) for what in ("EU", "log₁₀ EU", "EC", "|π|") for who in ("paper", "ours")),
        *(Column(who, "PT (s)") for who in ("paper", *shown)),
        Column("remark on the print", is_text=True),
    ]
    table_rows, verdicts = [], []
    for printed, group in rows:
        pairs = _pairs(printed, best_of(group), is_the_same=printed["instance"] not in paper.ours)
        verdicts += [verdict for _, _, verdict in pairs if verdict is not None]
        times = {case.settings: _planning_time(case) for case in group}
        table_rows.append(
            [
                Cell(printed["instance"], also=_attitude(printed)),
                Cell(_attitude(printed)),
                *(cell for theirs, ours, _ in pairs for cell in (theirs, ours)),
                Cell(printed["planning_seconds_printed"]),
                *(times.get(name, Cell(NOTHING)) for name in shown),
                Cell(printed["remark"]),
            ]
        )
    label = f"{paper.title}: the paper's results beside ours"
    return Comparison(paper, Table(label, columns, table_rows), len(rows), len(verdicts), sum(verdicts))


def _agent(printed: PrintedRow) -> Agent:
    return str(objective(f"{printed['attitude']} {printed['alpha']}".strip()))


def _attitude(printed: PrintedRow) -> str:
    name = ABBREVIATIONS[printed["attitude"]]
    return f"{name} ({printed['alpha']})" if printed["alpha"] else name


def _pairs(printed: PrintedRow, outcome: Outcome | None, *, is_the_same: bool) -> list[tuple[Cell, Cell, bool | None]]:
    """Return for EU, log10 EU, EC and length: the paper's cell, ours, and whether they agree (None: not to be told).

    The paper writes costs as negative numbers.
    """
    values = (
        (printed["expected_utility_printed"], _decimal(outcome and outcome.expected_utility)),
        (printed["log10_eu_printed"], _decimal(outcome and outcome.log10_expected_utility)),
        (f"-{printed['expected_cost_printed']}", _decimal(outcome and outcome.expected_cost, negative=True)),
        (printed["length"], _decimal(outcome and outcome.length)),
    )
    is_proven = outcome is not None and outcome.status == Status.OPTIMAL
    pairs = []
    for theirs, ours in values:
        verdict = agrees(ours, theirs) if is_the_same and is_proven and theirs and ours is not None else None
        cell = Cell(NOTHING if ours is None or not theirs else typeset(_like(ours, theirs)))
        if not is_proven and ours is not None:
            cell = Cell(cell.text, mark="unproven", tip="not proven optimal")
        elif verdict is False:
            cell = Cell(cell.text, mark="differs", tip=f"the paper prints {theirs}")
        pairs.append((Cell(typeset(theirs) or NOTHING), cell, verdict))
    return pairs


def _like(value: Decimal, printed: str) -> str:
    """Return a number in the form, and with the decimals, of a printed one; with an exponent if that would hide it."""
    mantissa, _, exponent = printed.partition("E")
    decimals = len(mantissa.partition(".")[2])
    is_hidden = value != 0 and not Decimal(10) ** -decimals <= abs(value) < Decimal(10) ** 9
    return f"{value:.{max(decimals, 3)}e}" if exponent or (is_hidden and decimals) else f"{value:.{decimals}f}"


def _decimal(value: object, *, negative: bool = False) -> Decimal | None:
    if value is None:
        return None
    try:
        found = Decimal(str(value))
    except InvalidOperation:
        return None
    return -found if negative else found


def _planning_time(case: Case) -> Cell:
    """Return the mean over the repeats, as the paper has it; for a case that was not always solved its status."""
    known = [outcome.seconds for outcome in case.outcomes if outcome.seconds is not None]
    return seconds(statistics.fmean(known)) if case.is_answered and known else Cell(case.status)
