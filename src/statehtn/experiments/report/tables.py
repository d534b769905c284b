"""The tables of the report as data; the page's template draws them."""

from __future__ import annotations

import re
import statistics
from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from itertools import groupby

from statehtn.experiments.report.cases import Case, agent_order
from statehtn.experiments.summary import LIMITS, NO_PLAN, SOLVED
from statehtn.model.status import Status

NOTHING = "\N{EN DASH}"
MINUS = "\N{MINUS SIGN}"


@dataclass(frozen=True, slots=True)
class Column:
    """A column; those of one group that are side by side share a heading. Text is sorted as text."""

    label: str
    group: str = ""
    is_text: bool = False


@dataclass(frozen=True, slots=True)
class Cell:
    """A cell of a table.

    Args:
        text: what it shows.
        key: what it is sorted by, if that is another thing.
        mark: a class of the page's style.
        tip: why it is marked.
        share: the length of a bar below it, from 0 to 1.
        also: of a row's heading: what else tells rows apart, for narrow screens, which hide the cell with it.
    """

    text: str
    key: float | None = None
    mark: str = ""
    tip: str = ""
    share: float | None = None
    also: str = ""


@dataclass(frozen=True, slots=True)
class Table:
    """A table; the first cell of a row is its heading."""

    label: str
    columns: Sequence[Column]
    rows: Sequence[Sequence[Cell]]
    footer: Sequence[Cell] = field(default=())

    @property
    def groups(self) -> list[tuple[str, int]]:
        """The headings above the columns' own, with the number of columns below; empty if no column has one."""
        if not any(column.group for column in self.columns):
            return []
        return [(group, len(list(columns))) for group, columns in groupby(self.columns, lambda column: column.group)]

    @property
    def is_long(self) -> bool:
        """Whether it is better looked at in a box of its own."""
        return len(self.rows) > 30


def number(value: float | None, digits: int = 6) -> Cell:
    """Return a cell with a number."""
    return Cell(NOTHING) if value is None else Cell(figure(value, digits))


def seconds(value: float | None) -> Cell:
    """Return a cell with a time, to the millisecond below 10 s."""
    return Cell(NOTHING) if value is None else Cell(f"{value:.3f}" if value < 10 else f"{value:.1f}")


def figure(value: float, digits: int = 6) -> str:
    """Return a number with so many digits at most."""
    return typeset(f"{value:.{digits}g}")


def typeset(number: str) -> str:
    """Return a number as Python or the paper prints it, with a minus that looks like one and a plain exponent."""
    return re.sub(r"[eE]([+-]?)0*(?=\d)", lambda match: "e" + match[1].strip("+"), number).replace("-", MINUS)


def coverage(cases: Sequence[Case], settings: Sequence[str]) -> Table:
    """Return how many problems each settings have solved, by domain."""
    columns = [Column("domain", is_text=True), *(Column(name) for name in settings)]
    domains = list(dict.fromkeys(case.domain for case in cases))
    rows = [
        [Cell(domain), *(_solved([c for c in cases if (c.domain, c.settings) == (domain, name)]) for name in settings)]
        for domain in domains
    ]
    footer = [Cell("all"), *(_solved([case for case in cases if case.settings == name]) for name in settings)]
    return Table("coverage by domain", columns, rows, footer if len(domains) > 1 else ())


def _solved(cases: Sequence[Case]) -> Cell:
    if not cases:
        return Cell(NOTHING)
    count = sum(case.is_answered for case in cases)
    return Cell(f"{count} of {len(cases)}", count, share=count / len(cases))


def effort(cases: Sequence[Case], settings: Sequence[str]) -> Table:
    """Return what has come of the problems under each settings, and what it took."""
    labels = ("asked", "optimal", "solved, not proven", "no plan", "limit", "error")
    columns = [
        Column("settings", is_text=True),
        *(Column(label) for label in labels),
        *(Column(label, "median of the solved") for label in ("seconds", "expanded", "MB")),
        *(Column(label, "in all") for label in ("seconds", "expanded")),
    ]
    rows = []
    for name in settings:
        own = [case for case in cases if case.settings == name]
        solved = [case for case in own if case.is_answered]
        rows.append(
            [
                Cell(name),
                *(Cell(str(count)) for count in _counts(own)),
                seconds(_median(case.seconds for case in solved)),
                _count(_median(case.expanded for case in solved)),
                number(_median(case.memory for case in solved), 3),
                seconds(_sum(case.seconds for case in own)),
                _count(_sum(case.expanded for case in own)),
            ]
        )
    return Table("what has come of the problems, and what it took", columns, rows)


def _counts(cases: Sequence[Case]) -> tuple[int, ...]:
    """Return how many there are, how many ended optimal, with another plan, without a plan, at a limit, or in error."""
    statuses = Counter(case.status for case in cases)
    plans, none, limits = (sum(statuses[status] for status in kind) for kind in (SOLVED, NO_PLAN, LIMITS))
    optimal = statuses[Status.OPTIMAL]
    return len(cases), optimal, plans - optimal, none, limits, len(cases) - plans - none - limits


def all_cases(cases: Sequence[Case]) -> Table:
    """Return every problem with every agent and settings."""
    columns = [
        *(Column(label, is_text=True) for label in ("problem", "domain", "agent", "settings", "status")),
        *(Column(label) for label in ("value", "lower bound", "expected cost", "length")),
        *(Column(label) for label in ("expanded", "seconds", "MB")),
    ]
    rows = [
        [
            Cell(case.problem, also=f"{case.agent}, {case.settings}"),
            Cell(case.domain),
            Cell(case.agent, agent_order(case.agent)[0]),
            *(Cell(text) for text in (case.settings, case.status)),
            number(case.best.value),
            number(_largest(outcome.lower_bound for outcome in case.outcomes)),
            number(case.best.expected_cost),
            _count(case.best.length),
            _count(case.expanded),
            seconds(case.seconds),
            number(case.memory, 3),
        ]
        for case in cases
    ]
    return Table("all problems, agents and settings", columns, rows)


def _count(value: float | None) -> Cell:
    return Cell(NOTHING) if value is None else Cell(f"{value:,.0f}".replace(",", "\N{NARROW NO-BREAK SPACE}"))


def _known(values: Iterable[float | None]) -> list[float]:
    return [value for value in values if value is not None]


def _median(values: Iterable[float | None]) -> float | None:
    known = _known(values)
    return statistics.median(known) if known else None


def _sum(values: Iterable[float | None]) -> float | None:
    known = _known(values)
    return sum(known) if known else None


def _largest(values: Iterable[float | None]) -> float | None:
    return max(_known(values), default=None)
