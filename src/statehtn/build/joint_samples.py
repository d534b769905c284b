"""Costs that were observed together: a column for each action instance, a row for each day."""

from __future__ import annotations

import csv
import io
import math
import os
from collections.abc import Iterator, Sequence
from pathlib import Path

from statehtn.build.cost_table import ANY, CostEntry, CostTable, Days
from statehtn.counted import counted
from statehtn.errors import InputError, UnsupportedError
from statehtn.expected import file_name
from statehtn.limits import Limits
from statehtn.model.chance import MOST_SCENARIOS
from statehtn.model.cost.distribution import CostDistribution
from statehtn.read_file import read_whole

DAY = "day"
"""The heading of a first column that names the days."""


def read_joint_samples(file: str | os.PathLike[str], limits: Limits = Limits()) -> CostTable:
    """Read costs that were observed together from a CSV file; `CostTable.apply` gives them to a problem.

    The first line names action instances as steps of a plan are spelt, such as `drive home shop`; each further line is
    a day and has what each of them cost on it. A first column `day` may name the days. Each day is a scenario of the
    same probability, in which these costs are certain: whatever hangs together in the data does so in plans.

    Args:
        file: its name.
        limits: for reading it.

    Raises:
        InputError: the file cannot be read, has no row, a hole, a negative cost, or two columns for one instance; the
            message names line and column. Names are only checked by `CostTable.apply`.
        UnsupportedError: it has more than 256 rows.
        LimitReached: a limit was reached.
    """
    path = Path(file_name(file, "the joint samples"))
    return CostTable((), (str(path),), read_days(path, limits))


def read_days(path: Path, limits: Limits) -> Days:
    """Return what a file of joint samples says; see `read_joint_samples`."""
    rows = _rows(path, limits)
    number, headings = next(rows, (1, []))
    has_names = bool(headings) and headings[0].lower() == DAY
    titles = headings[has_names:]
    if not titles:
        raise InputError(f"{path}: expected a first line with an action instance for each column, found none")
    places = [f"{path}: column '{title}'" for title in titles]
    instances = [_instance(place, title) for place, title in zip(places, titles, strict=True)]
    _refuse_repeated(instances, places)
    names: list[str] = []
    days: list[list[CostDistribution]] = []
    laws: dict[float, CostDistribution] = {}
    for number, row in rows:
        if len(row) != len(headings):
            raise InputError(f"{path}, line {number}: expected {counted(len(headings), 'column')}, found {len(row)}")
        costs = [_cost(path, number, title, text) for title, text in zip(titles, row[has_names:], strict=True)]
        days.append([laws.setdefault(cost, CostDistribution.certain(cost)) for cost in costs])
        name = row[0] if has_names and row[0] else f"{DAY} {len(days)}"
        names.append(f"{name} (line {number})" if name in names else name)
    if not days:
        raise InputError(f"{path}: expected a line of costs for each observed day, found none")
    if len(days) > MOST_SCENARIOS:
        raise UnsupportedError(f"{path}: found {len(days)} days, and at most {MOST_SCENARIOS} are supported")
    columns = zip(places, instances, zip(*days, strict=True), strict=True)
    entries = (CostEntry(place, action, tuple(arguments), by_day=laws) for place, (action, *arguments), laws in columns)
    return Days(str(path), tuple(names), tuple(entries))


def _rows(path: Path, limits: Limits) -> Iterator[tuple[int, list[str]]]:
    """Yield the lines that are not blank, with their numbers."""
    try:
        text = read_whole(path, limits).decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise InputError(f"{path}: this is no CSV: byte {error.start} is not UTF-8") from None
    reader = csv.reader(io.StringIO(text), strict=True)
    try:
        for row in reader:
            limits.check()
            cells = [cell.strip() for cell in row]
            if any(cells):
                yield reader.line_num, cells
    except csv.Error as error:
        raise InputError(f"{path}, line {reader.line_num}: this is no CSV: {error}") from None


def _instance(place: str, title: str) -> list[str]:
    """Return the action and the objects that the heading of a column names."""
    words = title.removeprefix("(").removesuffix(")").split()
    if not words or ANY in words:
        raise InputError(f"{place}: expected an action with its objects, such as 'drive home shop'")
    return words


def _refuse_repeated(instances: Sequence[Sequence[str]], places: Sequence[str]) -> None:
    seen: set[tuple[str, ...]] = set()
    for words, place in zip(instances, places, strict=True):
        key = tuple(word.lower() for word in words)
        if key in seen:
            raise InputError(f"{place}: this is the second column for ({' '.join(words)})")
        seen.add(key)


def _cost(path: Path, line: int, title: str, text: str) -> float:
    where = f"{path}, line {line}, column '{title}'"
    if not text:
        raise InputError(f"{where}: expected a cost, found nothing; leave out days that are not known whole")
    try:
        cost = float(text)
    except ValueError:
        raise InputError(f"{where}: expected a cost, found '{text}'") from None
    if not (math.isfinite(cost) and cost >= 0):
        raise InputError(f"{where}: a cost must be a finite number and at least 0, found {text}")
    return cost
