"""The best plans of a problem as text, in a terminal and as HTML."""

from __future__ import annotations

from collections.abc import Sequence
from html import escape
from itertools import takewhile

from statehtn.counted import counted
from statehtn.display.table import Column, Table
from statehtn.display.terminal import Summary, rendered
from statehtn.display.words import (
    FAILURE,
    NO_CLASS,
    STOPS,
    STYLES,
    UNREAD,
    Labelled,
    agent,
    effort_rows,
    ending,
    gap_of,
    head,
    keep_rows,
    log10_label,
    margin,
    number,
    worth,
)
from statehtn.model.status import Status
from statehtn.top_result import RankedPlan, TopPlans

GAP = "…"
"""Stands for what is told elsewhere."""


def top_plans_text(result: TopPlans) -> str:
    """Return the status and a table of the plans, in lines; actions that all share at their ends are told once."""
    return "\n".join([_head(result), *([_table(result).to_text()] if result.plans else [])])


def top_plans_html(result: TopPlans) -> str:
    """Return what `top_plans_text` does as HTML for a notebook."""
    table = _table(result).to_html() if result.plans else ""
    return f"<div><b>{escape(_head(result))}</b>{table}</div>"


def readable_top_plans(result: TopPlans) -> str:
    """Return the plans' values, their actions where they differ, what was proven, and the effort."""
    problem_class = f"{result.problem_class or NO_CLASS} (solver state, heuristic {result.heuristic})"
    kept = [] if result else keep_rows(result)
    rows = [*_proven_rows(result), *kept, ("problem class", problem_class), *effort_rows(result.statistics)]
    summary = Summary(rows, STYLES.get(result.status, FAILURE))
    return rendered([_values(result), _actions(result.plans), summary] if result.plans else [summary])


def _head(result: TopPlans) -> str:
    count = "all plans" if result.is_all else f"{result.proven} proven"
    return f"{head(result)}, {counted(len(result.plans), 'plan')}, {count}"


def _table(result: TopPlans) -> Table:
    frame, parts = _compact(result.plans)
    has_utility = result.utility is not None
    rows = [
        (
            *(str(plan.rank), number(plan.value), number(plan.expected_cost)),
            *((plan.expected_utility or "",) if has_utility else ()),
            *(str(plan.length), part),
        )
        for plan, part in zip(result.plans, parts, strict=True)
    ]
    heads = ("", worth(result), "expected", *(("expected utility",) if has_utility else ()), "length")
    columns = [*(Column(text, is_number=True) for text in heads), Column("actions")]
    return Table(columns, [(*("" for _ in heads), frame), *rows] if frame else rows)


def _values(result: TopPlans) -> Table:
    """Return a table of what the plans are worth; for a neutral agent three columns would say the same."""
    rows = []
    for plan in result:
        cells = {
            "": str(plan.rank),
            worth(result): number(plan.value),
            "expected cost": number(plan.expected_cost),
            "expected utility": plan.expected_utility or "",
            log10_label(result): number(plan.log10_expected_utility),
            **{f"within {number(one.budget)}": number(one.attained) for one in plan.keep},
            "actions": str(plan.length),
            " ": "" if plan.is_proven else "not proven",
        }
        if result.attitude == "neutral":
            del cells[worth(result)]
        if result.attitude == "neutral" or result.utility is None:
            del cells[log10_label(result)]
        if result.utility is None:
            del cells["expected utility"]
        rows.append(cells)
    columns = [Column(text.strip(), is_number=True) for text in rows[0]]
    return Table(columns, [tuple(cells.values()) for cells in rows], title=f"{_count(result)} {agent(result)}")


def _count(result: TopPlans) -> str:
    number = len(result)
    if result.proven < number:
        return "The best plan so far" if number == 1 else f"The best {number} plans so far"
    if result.is_all:
        return "The only plan" if number == 1 else f"All {number} plans"
    return "The best plan" if number == 1 else f"The {number} best plans"


def _actions(plans: Sequence[RankedPlan]) -> Summary:
    frame, parts = _compact(plans)
    shared = [("all", frame)] if frame else []
    own = [(str(rank), part) for rank, part in enumerate(parts, 1)]
    return Summary([*shared, *own, ("", "")], "dim" if frame else "")


def _compact(plans: Sequence[RankedPlan]) -> tuple[str, list[str]]:
    """Return what all plans share at their beginnings and ends, and of each what lies between, `…` for the other.

    The first is empty where they share nothing.
    """
    sequences = [[str(priced.step) for priced in plan.steps] for plan in plans]
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


def _proven_rows(result: TopPlans) -> Labelled:
    others = f"has a {worth(result)} below {number(result.lower_bound)}"
    up_to_order = "" if result.distinct == "sequence" else ", but for these with their actions in another order"
    if not result.plans:
        if result.unread:
            return [("status", STOPS[result.status]), ("found", f"plans, {UNREAD}")]
        rows = [("status", ending(result))]
        if result.status is Status.UNSOLVABLE or result.lower_bound is None:
            return rows
        return [*rows, ("proven", f"no plan {others}")]
    if result.is_all:
        return [("status", f"optimal: this problem has no other plans{up_to_order}")]
    if result.status is Status.OPTIMAL:
        better = "has a higher expected utility" if result.utility else f"has a lower value of '{result.objective}'"
        rows = [("status", f"optimal: no other plan {better}{margin(result)}{up_to_order}")]
        gap = gap_of(result)
        why = "" if result.settings.needs_labels else " (rounding)"
        return [*rows, ("proven", f"to within {gap:.1g} of the {worth(result)}s{why}")] if gap > 0 else rows
    if result.stopped is None:
        rows = [("status", f"solved: there may be better plans, within the error of the {worth(result)}s")]
    else:
        wanted = "a plan was" if result.k == 1 else f"{result.k} plans were"
        rows = [("status", f"{STOPS[result.stopped]} before {wanted} found and proven to be the best")]
        if result.unread:
            rows.append(("found", f"more plans, {UNREAD}"))
    if result.proven:
        which = "these are" if result.proven == len(result) else f"the first {result.proven} are"
        rows.append(("proven", "the first is the best" if result.proven == 1 else f"{which} the best"))
    if result.lower_bound is not None:
        rows.append(("proven", f"no other plan {others}"))
    return rows
