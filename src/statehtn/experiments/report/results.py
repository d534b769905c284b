"""What a comparison has recorded, read back from its two files; another comparison may still be writing them."""

from __future__ import annotations

import csv
import json
import math
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from statehtn.errors import InputError, StateHtnError
from statehtn.experiments.records import COLUMNS, KEY_COLUMNS, Row
from statehtn.model.cost.blocks import CostDistribution

Key = tuple[str, ...]
Agent = str
"""An agent by its objective and the budgets that it keeps, in text: `averse 0.9`, `neutral keep 25.0 0.95`."""
PHASES = ("parse_seconds", "ground_seconds", "search_seconds")
REPLACEMENT = "\N{REPLACEMENT CHARACTER}"


@dataclass(frozen=True, slots=True)
class Outcome:
    """What has come of one run; what is not known is None. Costs are positive, in the domain's unit.

    Args:
        domain: the name that the results have for it.
        problem: likewise.
        agent: who plans: the objective, and the budgets to keep.
        settings: solver and heuristic, such as `state auto`.
        status: as in the table of results.
        value: what the plan is worth by the objective; for neutral, averse and seeking agents the certain cost that
            they find exactly as bad.
        lower_bound: no plan has a lower value.
        expected_cost: of the plan.
        log10_expected_utility: with the paper's sign.
        length: of the plan, in actions.
        expanded: nodes of the search.
        seconds: for reading, grounding and search; of the phases that were begun.
        peak_memory_mb: of the process.
        expected_utility: a decimal string.
        laws: the distribution of the cost of every action of the plan.
        limits: seconds and MB that the run was given.
        machine: where it ran.
        version: of statehtn.
    """

    domain: str
    problem: str
    agent: Agent
    settings: str
    status: str
    value: float | None
    lower_bound: float | None
    expected_cost: float | None
    log10_expected_utility: float | None
    length: float | None
    expanded: float | None
    seconds: float | None
    peak_memory_mb: float | None
    expected_utility: str | None
    laws: tuple[CostDistribution, ...] | None
    limits: tuple[float | None, float | None]
    machine: str
    version: str


def read_outcomes(name: str) -> list[Outcome]:
    """Read the outcomes of all runs in a table of results, and of nothing else, in the order of the table.

    Args:
        name: the CSV file; the file of JSON Lines beside it has `.jsonl` for its suffix.

    Raises:
        InputError: a file cannot be read, is no comparison's, or does not fit the other one; or there is no run in it.
    """
    rows = _read_rows(name)
    if not rows:
        raise InputError(f"there is no run in '{name}' yet")
    json_name = str(Path(name).with_suffix(".jsonl"))
    records = _read_records(json_name, wanted=rows.keys())
    outcomes = []
    for key, (number, row) in rows.items():
        if key not in records:
            raise InputError(
                f"'{json_name}' has no record of the run in line {number} of '{name}' ({' '.join(filter(None, key))}); "
                "the two files belong together: keep or copy both"
            )
        outcomes.append(_outcome(row, records[key], f"line {number} of '{name}'"))
    return outcomes


def _lines(name: str) -> list[str]:
    """Return the lines of a file, without a last one that has no end: it is being written.

    Raises:
        InputError: the file cannot be read.
    """
    try:
        content = Path(name).read_bytes()
    except OSError as error:
        raise InputError(f"cannot read '{name}': {error.strerror}") from None
    return content[: content.rfind(b"\n") + 1].decode(errors="surrogateescape").split("\n")[:-1]


def _read_rows(name: str) -> dict[Key, tuple[int, Row]]:
    """Return the rows of the table by key, each with the number of its line."""
    expected = "expected the results of 'statehtn compare --output FILE.csv'"
    rows: dict[Key, tuple[int, Row]] = {}
    lines = csv.reader(_lines(name))
    try:
        if tuple(next(lines, ())) != COLUMNS:
            raise InputError(f"'{name}' is no table of a comparison's results; {expected}")
        for values in lines:
            if len(values) != len(COLUMNS):
                raise InputError(
                    f"line {lines.line_num} of '{name}' has {len(values)} columns, expected {len(COLUMNS)}; {expected}"
                )
            rows[tuple(values[: len(KEY_COLUMNS)])] = (lines.line_num, dict(zip(COLUMNS, values, strict=True)))
    except csv.Error as error:
        raise InputError(f"line {lines.line_num} of '{name}' is no CSV: {error}; {expected}") from None
    return rows


@dataclass(frozen=True, slots=True)
class _Extra:
    """What the file of JSON Lines has about a run, and the table has not."""

    expected_utility: str | None
    laws: tuple[CostDistribution, ...] | None
    limits: tuple[float | None, float | None]
    machine: str
    version: str


def _read_records(name: str, wanted: Any) -> dict[Key, _Extra]:
    """Return what is there about the wanted runs; where a run has two lines, the last one counts."""
    records: dict[Key, _Extra] = {}
    for number, line in enumerate(_lines(name), 1):
        try:
            record = json.loads(line)
            key = tuple(record["key"])
            if key in wanted:
                records[key] = _extra(record)
        except (ValueError, KeyError, TypeError, AttributeError, StateHtnError):
            raise InputError(
                f"line {number} of '{name}' is no record of a run; expected the file that 'statehtn compare' writes "
                "beside its table"
            ) from None
    return records


def _extra(record: dict[str, Any]) -> _Extra:
    result = record["result"] or {}
    plan, utility = result.get("plan"), result.get("expected_utility")
    return _Extra(
        None if utility is None else str(utility),
        _laws(plan),
        (record["run"]["time_limit"], record["run"]["memory_limit"]),
        printable(str(record.get("machine", ""))),
        printable(str(record.get("version", ""))),
    )


def _laws(plan: list[dict[str, Any]] | None) -> tuple[CostDistribution, ...] | None:
    """Return the laws of the costs of a plan's actions; None without a plan, or where one is no list of outcomes."""
    if plan is None or any(step["outcomes"] is None for step in plan):
        return None
    return tuple(CostDistribution.of((p, c) for p, c in step["outcomes"]) for step in plan)


def _outcome(row: Row, extra: _Extra, place: str) -> Outcome:
    """Return the outcome that a row and the rest of its record tell.

    Raises:
        InputError: the row has something else where a number is expected.
    """

    def number(column: str) -> float | None:
        try:
            value = float(row[column]) if row[column] else None
        except ValueError:
            value = math.nan
        if value is not None and not math.isfinite(value):
            raise InputError(f"{place}: '{column}': expected a number, found '{row[column]}'")
        return value

    seconds = [value for value in map(number, PHASES) if value is not None]
    return Outcome(
        domain=printable(row["domain"]),
        problem=printable(row["problem"]),
        agent=printable(" keep ".join(filter(None, (row["objective"], row["keep"])))),
        settings=printable(f"{row['solver']} {row['heuristic']}".strip()),
        status=printable(row["status"]),
        value=number("value"),
        lower_bound=number("lower_bound"),
        expected_cost=number("expected_cost"),
        log10_expected_utility=number("log10_expected_utility"),
        length=number("length"),
        expanded=number("expanded"),
        seconds=sum(seconds) if seconds else None,
        peak_memory_mb=number("peak_memory_mb"),
        expected_utility=extra.expected_utility,
        laws=extra.laws,
        limits=extra.limits,
        machine=extra.machine,
        version=extra.version,
    )


def printable(text: str) -> str:
    """Replace what no page can show: control characters, and bytes that were no text."""
    return "".join(character if character.isprintable() else REPLACEMENT for character in text)
