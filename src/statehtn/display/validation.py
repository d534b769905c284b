"""Verdicts on plans in a terminal and as HTML."""

from __future__ import annotations

from collections.abc import Sequence
from html import escape
from itertools import repeat

from statehtn.counted import likely
from statehtn.display.table import Column, Table
from statehtn.display.terminal import Summary, rendered
from statehtn.display.words import COUNTS_ON, FAILURE, SUCCESS, Labelled, counted_on, number
from statehtn.validation import Validation

COSTS = (Column("cost"), Column("expected", is_number=True))
MOST_REASONS = 20


def validation_html(validation: Validation) -> str:
    """Return the verdict, the reasons, and a table of the costs of the steps that can be executed."""
    parts = [f"<b>{'valid' if validation.valid else 'invalid'}</b>"]
    reasons = validation.reasons
    if reasons:
        shown = [*map(escape, reasons[:MOST_REASONS])]
        if len(reasons) > MOST_REASONS:
            shown.append(f"and {len(reasons) - MOST_REASONS} more")
        parts.append(f"<ul>{''.join(f'<li>{reason}</li>' for reason in shown)}</ul>")
    columns = [Column("", is_number=True), *COSTS]
    rows = [(str(index), *cost) for index, cost in enumerate(_costs(validation), 1)]
    if any(counts := _counts(validation)):
        columns.append(Column(COUNTS_ON))
        rows = [(*row, count) for row, count in zip(rows, counts, strict=True)]
    if rows:
        parts.append(Table(columns, rows).to_html())
    return f"<div>{''.join(parts)}</div>"


def readable_validation(validation: Validation, steps: Sequence[object]) -> str:
    """Return the verdict on a plan, action by action; `costs` has a law for each step that can be executed."""
    states = [("executed", *cost) for cost in _costs(validation)]
    if validation.stopped is None:
        states.append(("fails", "", ""))
    states += [("not reached", "", "")] * (len(steps) - len(states))
    columns = [Column("", is_number=True), Column("action"), Column(""), *COSTS]
    shown = [(str(index), str(step), *state) for index, (step, state) in enumerate(zip(steps, states, strict=False), 1)]
    if any(counts := _counts(validation)):
        columns.append(Column(COUNTS_ON))
        shown = [(*row, count) for row, count in zip(shown, [*counts, *repeat("", len(shown))], strict=False)]
    table = Table(columns, shown)
    summary = Summary(_verdict(validation), SUCCESS if validation.valid else FAILURE)
    return rendered([table, summary] if shown else [summary])


def _verdict(validation: Validation) -> Labelled:
    verdict = "valid" if validation.valid else "invalid" if validation.stopped is None else "not decided"
    rows = [("verdict", verdict)]
    if validation.plan is not None:
        tree = str(validation.plan.decomposition).split("\n")
        rows = [("verdict", "valid: these actions have a decomposition"), ("found", tree[0])]
        rows += [("", line) for line in tree[1:]]
    rows += [("because", reason) for reason in validation.reasons]
    if not validation.valid:
        return rows
    if validation.probability < 1:
        rows.append(("probability", f"{likely(validation.probability)} that each step comes to what is counted on"))
    return [*rows, ("expected cost", number(validation.expected_cost))]


def _counts(validation: Validation) -> list[str]:
    """Return for each step that can be executed which outcome the plan counts on, where actions have several."""
    return [counted_on(outcome) for outcome in validation.outcomes or ()]


def _costs(validation: Validation) -> list[tuple[str, str]]:
    laws = {id(law): law for law in validation.costs}  # long plans repeat them
    texts = {key: (str(law), number(law.mean)) for key, law in laws.items()}
    return [texts[id(law)] for law in validation.costs]
