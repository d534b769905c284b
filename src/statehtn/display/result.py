"""Results of planning runs as text, in a terminal and as HTML."""

from __future__ import annotations

import math
from collections.abc import Sequence
from html import escape
from typing import TextIO

from statehtn.display.table import Column, Table
from statehtn.display.terminal import Summary, rendered
from statehtn.display.words import (
    ENDINGS,
    FAILURE,
    STOPS,
    STYLES,
    UNREAD,
    Labelled,
    agent,
    effort_rows,
    head,
    log10_label,
    number,
)
from statehtn.found_plan import PricedStep
from statehtn.model.cost.law import CostLaw
from statehtn.model.status import Status
from statehtn.result import Result

COLUMNS = (
    Column("", is_number=True),
    Column("action"),
    Column("cost"),
    Column("expected", is_number=True),
    Column("certainty equivalent", is_number=True),
)
NOT_VALIDATED = "no: the run ended before the plan was checked; 'statehtn validate' checks a plan file (--output)"


def result_text(result: Result) -> str:
    """Return the status, a table of the actions with their costs, and the plan's price, in lines."""
    lines = [head(result)]
    if result.plan is not None:
        lines.append(_table(result).to_text())
    return "\n".join([*lines, *_notes(result)])


def result_html(result: Result) -> str:
    """Return what `result_text` does as HTML for a notebook, and the decomposition, folded."""
    parts = [f"<b>{escape(head(result))}</b>"]
    if result.plan is not None:
        parts.append(_table(result).to_html())
    parts += [f"<div>{escape(note)}</div>" for note in _notes(result)]
    if result.plan is not None:
        tree = escape(str(result.plan.decomposition))
        parts.append(f'<details><summary>decomposition</summary><pre style="line-height: 1.25">{tree}</pre></details>')
    return f"<div>{''.join(parts)}</div>"


def steps_html(steps: Sequence[PricedStep]) -> str:
    """Return a table of steps with their costs as HTML for a notebook."""
    return Table(COLUMNS, _rows(steps)).to_html()


def readable_result(result: Result, stream: TextIO) -> str:
    """Return the plan with its price, what was proven, and the effort, in the form for a stream."""
    summary = Summary(_summary_rows(result), STYLES.get(result.status, FAILURE))
    if result.plan is None:
        return rendered([summary], stream=stream)
    laws = _range([priced.law for priced in result.steps])
    return rendered([_table(result, laws, f"Plan for {agent(result)}"), summary], stream=stream)


def _table(result: Result, laws: str = "", title: str = "") -> Table:
    totals = ("", "in all", laws, number(result.expected_cost), number(result.risk_cost))
    return Table(COLUMNS, _rows(result.steps), totals, title)


def _rows(steps: Sequence[PricedStep]) -> list[tuple[str, ...]]:
    texts: dict[int, tuple[str, ...]] = {}  # of priced steps, which long plans repeat
    rows = []
    for index, priced in enumerate(steps, 1):
        if id(priced) not in texts:
            prices = number(priced.expected_cost), number(priced.risk_cost)
            texts[id(priced)] = (str(priced.step), str(priced.law), *prices)
        rows.append((str(index), *texts[id(priced)]))
    return rows


def _range(laws: Sequence[CostLaw]) -> str:
    least = sum(law.least for law in laws)
    most = sum(law.most for law in laws)
    if math.isinf(most):
        return f"at least {number(least)}"
    return number(least) if least == most else f"{number(least)} to {number(most)}"


def _notes(result: Result) -> list[str]:
    if result.plan is None:
        return [] if result.lower_bound is None else [_at_least(result.lower_bound)]
    notes = [f"expected utility {result.expected_utility}"]
    if result.status is not Status.OPTIMAL and result.lower_bound is not None:
        notes.append(f"no plan has a certainty equivalent below {number(result.lower_bound)}")
    return notes


def _at_least(bound: float) -> str:
    return f"every plan has a certainty equivalent of at least {number(bound)}"


def _summary_rows(result: Result) -> Labelled:
    found = result.plan is not None
    why = f" ({STOPS[result.stopped]})" if found and result.stopped is not None else ""
    rows = [("status", (STOPS if result.unread and not found else ENDINGS)[result.status] + why)]
    if result.unread:
        rows.append(("found", f"a {'better ' if found else ''}plan, {UNREAD}"))
    if found and not result.validated:
        rows.append(("validated", NOT_VALIDATED))
    if found:
        rows.append(("expected cost", number(result.expected_cost)))
        worth = f"{number(result.risk_cost)} (this agent would as soon pay that for certain)"
        rows.append(("certainty equivalent", worth))
        rows.append(("expected utility", result.expected_utility or ""))
    if result.log10_expected_utility is not None:
        rows.append((log10_label(result), number(result.log10_expected_utility)))
    rows += _bound_row(result)
    rows.append(("problem class", f"{result.problem_class} (solver {result.solver}, heuristic {result.heuristic})"))
    return rows + effort_rows(result.statistics)


def _bound_row(result: Result) -> Labelled:
    bound, cost = result.lower_bound, result.risk_cost
    if bound is None:
        return []
    if cost is None:
        return [("proven", _at_least(bound))]
    gap = cost - bound
    if result.status is Status.OPTIMAL:
        return [("proven", f"to within {gap:.1g} of the certainty equivalent (rounding)")] if gap > 0 else []
    return [("proven", f"{_at_least(bound)} (gap {gap:.4g})")]
