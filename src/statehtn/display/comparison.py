"""Plans of several agents side by side, as text and as HTML. Knows nothing of planning."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from html import escape

from statehtn.display.table import Column, Table

TIE = 1e-9
"""Plans whose prices for an agent differ by no more than this part of them are equally good for it."""
EDGE = 3
"""So many actions at each end of a long stretch are shown; those between them are counted."""
NOTES = (
    "for ...: the certainty equivalent, a certain cost that such an agent finds exactly as bad",
    "* proven: no plan has a lower one for this agent",
)


@dataclass(frozen=True, slots=True)
class ComparedPlan:
    """What is shown of an agent's plan; costs are None where it has none.

    Args:
        agent: its name.
        status: how its planning ended.
        least: the least total cost that is possible.
        expected: the expected total cost.
        most: the largest total cost that is possible.
        prices: what the plan costs each agent.
    """

    agent: str
    status: str
    least: float | None
    expected: float | None
    most: float | None
    prices: Sequence[float | None]


@dataclass(frozen=True, slots=True)
class Reason:
    """Why an agent does not do what another one does.

    Args:
        agent: its name.
        other: the other's.
        cost: what its own plan costs it.
        other_cost: what the other's plan would cost it.
        parts: for each place where the plans part: its own actions and what they cost it, the other's and what they
            would cost it.
    """

    agent: str
    other: str
    cost: float
    other_cost: float
    parts: Sequence[tuple[Sequence[str], float, Sequence[str], float]]


def comparison_text(
    plans: Sequence[ComparedPlan],
    heads: Sequence[str],
    rows: Sequence[tuple[bool, Sequence[str]]],
    reasons: Sequence[Reason],
) -> str:
    """Return the plans side by side, a table of their costs to every agent, and the reasons, in lines.

    Args:
        plans: one for each agent.
        heads: the agents of each plan that differs from the others.
        rows: whether all these plans are the same in the row, and a cell for each.
    """
    blocks = [_side_by_side(heads, rows).to_text()] if rows else []
    blocks.append("\n".join((_costs(plans).to_text(), *NOTES)))
    blocks += ["\n".join(_reason_lines(reason)) for reason in reasons]
    return "\n\n".join(blocks)


def comparison_html(
    plans: Sequence[ComparedPlan],
    heads: Sequence[str],
    rows: Sequence[tuple[bool, Sequence[str]]],
    reasons: Sequence[Reason],
) -> str:
    """Return what `comparison_text` does as HTML for a notebook, with the reasons folded."""
    parts = [_side_by_side(heads, rows).to_html()] if rows else []
    parts += [_costs(plans).to_html(), *(f"<div>{escape(note)}</div>" for note in NOTES)]
    if reasons:
        text = escape("\n\n".join("\n".join(_reason_lines(reason)) for reason in reasons))
        parts.append(f'<details><summary>why</summary><pre style="line-height: 1.25">{text}</pre></details>')
    return f"<div>{''.join(parts)}</div>"


def _side_by_side(heads: Sequence[str], rows: Sequence[tuple[bool, Sequence[str]]]) -> Table:
    columns = (Column(""), *(Column(head) for head in heads))
    return Table(columns, list(_shortened(rows, len(heads))))


def _shortened(rows: Sequence[tuple[bool, Sequence[str]]], width: int) -> Iterator[Sequence[str]]:
    """Yield the rows with a mark where plans part; the middle of a long stretch that they share is one row."""
    start = 0
    while start < len(rows):
        is_shared = rows[start][0]
        end = next((i for i in range(start, len(rows)) if rows[i][0] != is_shared), len(rows))
        hidden = end - start - 2 * EDGE if is_shared and end - start > 2 * EDGE + 1 else 0
        for index in range(start, end):
            if hidden and index == start + EDGE:
                yield ("", f"... {hidden} more that all share", *("" for _ in range(width - 1)))
            if not (hidden and start + EDGE <= index < end - EDGE):
                yield ("" if is_shared else "|", *rows[index][1])
        start = end


def _costs(plans: Sequence[ComparedPlan]) -> Table:
    heads = ("least", "expected", "most", *(f"for {plan.agent}" for plan in plans))
    rows = []
    own = [plan.prices[index] if plan.status == "optimal" else None for index, plan in enumerate(plans)]
    for plan in plans:
        if plan.expected is None:
            rows.append((f"of the {plan.agent}", *("" for _ in heads[:-1]), plan.status))
            continue
        prices = [
            f"{_number(price)}{'*' if _are_equal(price, best) else ' '}"
            for price, best in zip(plan.prices, own, strict=True)
        ]
        rows.append((f"of the {plan.agent}", _number(plan.least), _number(plan.expected), _number(plan.most), *prices))
    return Table((Column("cost of the plan"), *(Column(head, is_number=True) for head in heads)), rows)


def _reason_lines(reason: Reason) -> Iterator[str]:
    if _are_equal(reason.cost, reason.other_cost):
        same = f"the plan of {reason.other} is as good as its own, {_number(reason.cost)}, by its own measure"
        yield f"{reason.agent}: {same}"
        return
    price, other_price = _apart(reason.cost, reason.other_cost)
    yield f"{reason.agent} instead of {reason.other}: {price}, not {other_price}, by its own measure"
    for own, cost, other, other_cost in reason.parts:
        yield f"  {_number(cost):>8}  {_actions(own)}"
        yield f"  {_number(other_cost):>8}  instead of {_actions(other)}"


def _are_equal(price: float | None, other: float | None) -> bool:
    return price is not None and other is not None and math.isclose(price, other, rel_tol=TIE)


def _actions(actions: Sequence[str]) -> str:
    if not actions:
        return "nothing"
    hidden = len(actions) - 2 * EDGE
    if hidden < 2:
        return " ".join(actions)
    return " ".join((*actions[:EDGE], f"... {hidden} more ...", *actions[-EDGE:]))


def _apart(cost: float, other: float) -> tuple[str, str]:
    """Return two different prices with as many digits as it takes to tell them apart."""
    texts = ((_number(cost, digits), _number(other, digits)) for digits in range(4, 18))
    return next(pair for pair in texts if pair[0] != pair[1])


def _number(value: float | None, digits: int = 4) -> str:
    return "" if value is None else "unbounded" if math.isinf(value) else f"{value:.{digits}g}"
