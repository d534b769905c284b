"""Verdicts on plans in a terminal and as HTML."""

from __future__ import annotations

from collections.abc import Sequence
from html import escape

from statehtn.counted import likely
from statehtn.display.table import Column, Table
from statehtn.display.terminal import Summary, rendered
from statehtn.display.words import COUNTS_ON, FAILURE, SUCCESS, Labelled, counted_on, number
from statehtn.model.cost.by_law import by_law
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
    rows = [(str(index), *cost) for index, cost in enumerate(_costs(validation), 1)]
    if rows:
        parts.append(_table((Column("", is_number=True), *COSTS), rows, validation).to_html())
    return f"<div>{''.join(parts)}</div>"


def readable_validation(validation: Validation, steps: Sequence[object]) -> str:
    """Return the verdict on a plan, action by action; `costs` has a law for each step that can be executed."""
    states = [("executed", *cost) for cost in _costs(validation)]
    if validation.stopped is None:
        states.append(("fails", "", ""))
    states += [("not reached", "", "")] * (len(steps) - len(states))
    shown = [(str(index), str(step), *state) for index, (step, state) in enumerate(zip(steps, states, strict=False), 1)]
    table = _table((Column("", is_number=True), Column("action"), Column(""), *COSTS), shown, validation)
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


def _table(columns: Sequence[Column], rows: Sequence[Sequence[str]], validation: Validation) -> Table:
    """Return a table of steps; with the outcomes that the plan counts on, where it does."""
    counts = [counted_on(outcome) for outcome in validation.outcomes or ()]
    if not any(counts):
        return Table(columns, rows)
    counts += [""] * (len(rows) - len(counts))
    return Table((*columns, Column(COUNTS_ON)), [(*row, count) for row, count in zip(rows, counts, strict=True)])


def _costs(validation: Validation) -> list[tuple[str, str]]:
    return by_law(validation.costs, lambda law: (str(law), number(law.mean)))  # long plans repeat them
