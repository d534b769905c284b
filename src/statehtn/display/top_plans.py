# ruff: noqa: D102 (the protocols repeat what the docstrings of `RankedPlan` and `TopPlans` say)
"""The best plans of a problem as text and as HTML."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from html import escape
from itertools import takewhile
from typing import Protocol

from statehtn.counted import counted
from statehtn.display.table import Column, Table

COLUMNS = (
    Column("", is_number=True),
    Column("certainty equivalent", is_number=True),
    Column("expected", is_number=True),
    Column("expected utility", is_number=True),
    Column("length", is_number=True),
    Column("actions"),
)
GAP = "…"
"""Stands for what is told elsewhere."""


class ShownStep(Protocol):
    """What is shown of an action of a plan: `step`, as it prints."""

    @property
    def step(self) -> object: ...


class ShownPlan(Protocol):
    """What is shown of a plan."""

    @property
    def rank(self) -> int: ...
    @property
    def is_proven(self) -> bool: ...
    @property
    def steps(self) -> Sequence[ShownStep]: ...
    @property
    def length(self) -> int: ...
    @property
    def expected_cost(self) -> float: ...
    @property
    def risk_cost(self) -> float: ...
    @property
    def expected_utility(self) -> str: ...


class ShownPlans(Protocol):
    """What is shown of a search for several plans; see `statehtn.TopPlans`."""

    @property
    def status(self) -> object: ...
    @property
    def attitude(self) -> str: ...
    @property
    def alpha(self) -> float | None: ...
    @property
    def plans(self) -> Sequence[ShownPlan]: ...
    @property
    def proven(self) -> int: ...
    @property
    def is_all(self) -> bool: ...


def top_plans_text(result: ShownPlans) -> str:
    """Return the status and a table of the plans, in lines; actions that all share at their ends are told once."""
    lines = [_head(result)]
    if result.plans:
        lines.append(_table(result).to_text())
    return "\n".join(lines)


def top_plans_html(result: ShownPlans) -> str:
    """Return what `top_plans_text` does as HTML for a notebook."""
    table = _table(result).to_html() if result.plans else ""
    return f"<div><b>{escape(_head(result))}</b>{table}</div>"


def compact_actions(plans: Sequence[ShownPlan]) -> tuple[str, list[str]]:
    """Return what all plans share at their beginnings and ends, and of each what lies between, `…` for the other.

    The first is empty where they share nothing.
    """
    sequences = [[str(step.step) for step in plan.steps] for plan in plans]
    begin = _shared(sequences) if len(sequences) > 1 else 0
    rest = [sequence[begin:][::-1] for sequence in sequences]
    end = _shared(rest) if len(sequences) > 1 else 0
    if begin + end == 0:
        return "", [" ".join(sequence) for sequence in sequences]
    first = sequences[0]
    frame = " ".join([*first[:begin], GAP, *first[len(first) - end :]])
    return frame, [" ".join(sequence[begin : len(sequence) - end]) or "(nothing)" for sequence in sequences]


def _shared(sequences: Sequence[Sequence[str]]) -> int:
    """Return how many of their first elements all sequences share."""
    return sum(1 for _ in takewhile(lambda column: len(set(column)) == 1, zip(*sequences, strict=False)))


def _head(result: ShownPlans) -> str:
    agent = result.attitude if result.alpha is None else f"{result.attitude}, alpha {result.alpha:g}"
    count = "all plans" if result.is_all else f"{result.proven} proven"
    return f"status: {result.status} (risk-{agent}), {counted(len(result.plans), 'plan')}, {count}"


def _table(result: ShownPlans) -> Table:
    frame, parts = compact_actions(result.plans)
    rows = list(_rows(result.plans, parts))
    if frame:
        rows.insert(0, ("", "", "", "", "", frame))
    return Table(COLUMNS, rows)


def _rows(plans: Sequence[ShownPlan], parts: Sequence[str]) -> Iterator[tuple[str, ...]]:
    for plan, part in zip(plans, parts, strict=True):
        costs = (f"{plan.risk_cost:.10g}", f"{plan.expected_cost:.10g}", plan.expected_utility)
        yield (f"{plan.rank}", *costs, f"{plan.length}", part)
