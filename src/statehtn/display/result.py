"""Results of planning runs as text, in a terminal and as HTML."""

from __future__ import annotations

import math
from collections.abc import Sequence
from html import escape
from typing import TextIO

from statehtn.correlation import Correlation
from statehtn.counted import counted, likely
from statehtn.display.table import Column, Table
from statehtn.display.terminal import Summary, rendered
from statehtn.display.words import (
    COUNTS_ON,
    FAILURE,
    NO_CLASS,
    STOPS,
    STYLES,
    UNREAD,
    Labelled,
    agent,
    counted_on,
    effort_rows,
    ending,
    head,
    keep_rows,
    log10_label,
    number,
    with_unit,
    worth,
)
from statehtn.found_plan import PricedStep
from statehtn.model.cost.law import CostLaw
from statehtn.model.cost.scenario_cost import sum_of
from statehtn.model.status import Status
from statehtn.result import Result
from statehtn.risk import ValueUnit, adds_up

COLUMNS = (
    Column("", is_number=True),
    Column("action"),
    Column("cost"),
    Column("expected", is_number=True),
)
ROUNDING = 1e-9
"""Of values; smaller differences are none."""
MOST_SCENARIOS = 8
"""Of more of them only the best and the worst are shown."""
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
    has_prices = any(priced.risk_cost is not None for priced in steps) or not steps
    return Table(_columns(steps, "certainty equivalent" if has_prices else None), _rows(steps, has_prices)).to_html()


def readable_result(result: Result, stream: TextIO) -> str:
    """Return the plan with its price, what was proven, and the effort, in the form for a stream."""
    summary = Summary(_summary_rows(result), STYLES.get(result.status, FAILURE))
    if result.plan is None:
        return rendered([summary], stream=stream)
    laws = _range([priced.law for priced in result.steps])
    return rendered([_table(result, laws, f"Plan {agent(result)}"), summary], stream=stream)


def _table(result: Result, laws: str = "", title: str = "") -> Table:
    has_prices = adds_up(result.objective, [priced.law for priced in result.steps])
    totals = ["", "in all", laws, number(result.expected_cost), *([number(result.value)] if has_prices else [])]
    columns, rows = _columns(result.steps, worth(result) if has_prices else None), _rows(result.steps, has_prices)
    return Table(columns, rows, [*totals, *[""] * (len(columns) - len(totals))], title)


def _columns(steps: Sequence[PricedStep], price: str | None) -> tuple[Column, ...]:
    """Return the columns of a plan; with what the price of an action is called, where it has one."""
    prices = () if price is None else (Column(price, is_number=True),)
    return (*COLUMNS, *prices, Column(COUNTS_ON)) if _counts(steps) else (*COLUMNS, *prices)


def _counts(steps: Sequence[PricedStep]) -> bool:
    """Tell whether a plan counts on outcomes."""
    return any(priced.outcome is not None and priced.outcome.probability < 1 for priced in steps)


def _rows(steps: Sequence[PricedStep], has_prices: bool) -> list[tuple[str, ...]]:
    texts: dict[int, tuple[str, ...]] = {}  # of priced steps, which long plans repeat
    rows, counts = [], _counts(steps)
    for index, priced in enumerate(steps, 1):
        if id(priced) not in texts:
            more = [number(priced.risk_cost)] if has_prices else []
            more += [counted_on(priced.outcome)] if counts else []
            texts[id(priced)] = (str(priced.step), str(priced.law), number(priced.expected_cost), *more)
        rows.append((str(index), *texts[id(priced)]))
    return rows


def _range(laws: Sequence[CostLaw]) -> str:
    total = sum_of(laws)
    least, most = total.least, total.most
    if math.isinf(most):
        return f"at least {number(least)}"
    return number(least) if least == most else f"{number(least)} to {number(most)}"


def _notes(result: Result) -> list[str]:
    if result.plan is None:
        return [] if result.lower_bound is None else [_at_least(result, result.lower_bound)]
    utility = result.expected_utility
    notes = [
        f"value {with_unit(result.value, result.objective.unit)}" if utility is None else f"expected utility {utility}"
    ]
    notes += [f"{label}: {text}" for label, text in (*keep_rows(result), *_scenario_rows(result))]
    if result.status is not Status.OPTIMAL and result.lower_bound is not None:
        notes.append(f"no plan has a {worth(result)} below {number(result.lower_bound)}")
    return notes


def _at_least(result: Result, bound: float) -> str:
    return f"every plan has a {worth(result)} of at least {number(bound)}"


def _summary_rows(result: Result) -> Labelled:
    found = result.plan is not None
    why = f" ({STOPS[result.stopped]})" if found and result.stopped is not None else ""
    rows = [("status", (STOPS[result.status] if result.unread and not found else ending(result)) + why)]
    if result.unread:
        rows.append(("found", f"a {'better ' if found else ''}plan, {UNREAD}"))
    if found and not result.validated:
        rows.append(("validated", NOT_VALIDATED))
    if found:
        rows += [("expected cost", number(result.expected_cost)), *_worth_rows(result)]
    rows += [*keep_rows(result), *_scenario_rows(result), *_bound_row(result)]
    problem_class = result.problem_class or NO_CLASS
    rows.append(("problem class", f"{problem_class} (solver {result.solver}, heuristic {result.heuristic})"))
    return rows + effort_rows(result.statistics)


def _scenario_rows(result: Result) -> Labelled:
    """Return what the plan costs in the most likely scenarios and in the worst, and what correlation was worth."""
    given = result.scenarios
    shown = sorted(given, key=lambda one: -one.scenario.probability)[:MOST_SCENARIOS]
    if len(given) > MOST_SCENARIOS:
        shown = [min(given, key=lambda one: one.law.mean), max(given, key=lambda one: one.law.mean)]
    rows = [
        (f"given {one.scenario}", f"{one.law} (probability {likely(one.scenario.probability, digits=4)})")
        for one in shown
    ]
    if len(given) > len(shown):
        rows.append(("given others", f"{counted(len(given) - len(shown), 'scenario')} between these two"))
    if (correlation := result.correlation) is not None:
        rows.append(("correlation", _worth_of(correlation)))
    return rows


def _worth_of(correlation: Correlation) -> str:
    """Return what it is worth to know that costs hang together, in words."""
    seems = f"(and would seem to be worth {number(correlation.believed)})"
    if correlation.difference <= ROUNDING * max(1.0, abs(correlation.plan.value)):
        return f"makes no difference: the plan chosen as if costs were independent is as good {seems}"
    chosen = f"the plan chosen as if costs were independent is worth {number(correlation.plan.value)}"
    return f"knowing of it is worth {number(correlation.difference)}: {chosen} {seems}"


def _worth_rows(result: Result) -> Labelled:
    """Return what a plan is worth: to an agent of the paper, or by another objective."""
    if result.expected_utility is None:
        rows = [("value", f"{with_unit(result.value, result.objective.unit)} of '{result.objective}'")]
        if result.risk_cost is not None and result.objective.unit is not ValueUnit.COST:
            rows.append(("certainty equivalent", number(result.risk_cost)))
        return rows
    rows = [
        ("certainty equivalent", f"{number(result.risk_cost)} (this agent would as soon pay that for certain)"),
        ("expected utility", result.expected_utility),
    ]
    if result.log10_expected_utility is not None:
        rows.append((log10_label(result), number(result.log10_expected_utility)))
    return rows


def _bound_row(result: Result) -> Labelled:
    bound, gap = result.lower_bound, result.gap
    if bound is None:
        return []
    if gap is None:
        return [("proven", _at_least(result, bound))]
    if result.status is not Status.OPTIMAL:
        return [("proven", f"{_at_least(result, bound)} (gap {gap:.4g})")]
    if gap <= 0:
        return []
    why = "" if result.settings.needs_labels else " (rounding)"
    return [("proven", f"to within {gap:.1g} of the {worth(result)}{why}")]
