"""Plans of several agents side by side, as text and as HTML."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from html import escape

from statehtn.attitudes import AttitudeComparison, Difference, tokens
from statehtn.display.table import Column, Table, on_the_point
from statehtn.display.words import ending, keep_rows
from statehtn.found_plan import PricedStep
from statehtn.model.plan import Step
from statehtn.model.status import Status

TIE = 1e-9
"""Plans whose prices for an agent differ by no more than this part of them are equally good for it."""
LEAST = 1e-12
"""Nor do probabilities that differ by no more."""
EDGE = 3
"""So many actions at each end of a long stretch are shown; those between them are counted."""
NOTES = (
    "for ...: the certainty equivalent, a certain cost that such an agent finds exactly as bad",
    "* proven: no plan has a lower one for this agent",
)
NOTES_ON_VALUES = (
    "by ...: the value of the plan; to neutral, averse and seeking agents a certain cost that they find as bad",
    "* proven: no plan has a lower one by this objective",
)


def comparison_text(comparison: AttitudeComparison) -> str:
    """Return the plans side by side, a table of their costs to every agent, and the reasons, in lines."""
    table = _side_by_side(comparison)
    blocks = [] if table is None else [table.to_text()]
    blocks.append("\n".join((_costs(comparison).to_text(), *_legend(comparison))))
    return "\n\n".join((*blocks, *_reasons(comparison), *_unkept(comparison)))


def comparison_html(comparison: AttitudeComparison) -> str:
    """Return what `comparison_text` does as HTML for a notebook, with the reasons folded."""
    table = _side_by_side(comparison)
    parts = [] if table is None else [table.to_html()]
    parts += [_costs(comparison).to_html(), *(f"<div>{escape(note)}</div>" for note in _legend(comparison))]
    parts += [f"<div>{escape(line)}</div>" for block in _unkept(comparison) for line in block.split("\n")]
    if reasons := list(_reasons(comparison)):
        text = escape("\n\n".join(reasons))
        parts.append(f'<details><summary>why</summary><pre style="line-height: 1.25">{text}</pre></details>')
    return f"<div>{''.join(parts)}</div>"


def _legend(comparison: AttitudeComparison) -> tuple[str, ...]:
    if not any(comparison.results):
        return ()
    return NOTES if _are_agents(comparison) else NOTES_ON_VALUES


def _are_agents(comparison: AttitudeComparison) -> bool:
    """Tell whether all are neutral, averse or seeking agents, whose values are certainty equivalents."""
    return all(result.utility is not None for result in comparison.results)


def _side_by_side(comparison: AttitudeComparison) -> Table | None:
    """Return the plans that differ from each other, with all their agents as heads; None where there is no plan."""
    groups: dict[tuple[object, ...], list[int]] = {}
    for index, result in enumerate(comparison.results):
        if result:
            groups.setdefault(tuple(tokens(result.steps)), []).append(index)
    heads = [", ".join(comparison.agents[index] for index in group) for group in groups.values()]
    rows: list[tuple[bool, list[str]]] = []
    for row in comparison.rows:
        cells = [row[group[0]] for group in groups.values()]
        texts = ["" if priced is None else str(priced.step) for priced in cells]
        rows.append((len(set(tokens(cells))) == 1, texts))
    if not rows:
        return None
    return Table((Column(""), *map(Column, heads)), list(_shortened(rows, len(heads))))


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


def _costs(comparison: AttitudeComparison) -> Table:
    word = "for" if _are_agents(comparison) else "by"
    heads = ("least", "expected", "most", *(f"{word} {agent}" for agent in comparison.agents))
    prices, results = comparison.values, comparison.results
    if not any(results):
        endings = [(agent, str(result.status)) for agent, result in zip(comparison.agents, results, strict=True)]
        return Table((Column("agent"), Column("plan")), endings)
    proven = [prices[i][i] if result.status is Status.OPTIMAL else None for i, result in enumerate(results)]
    rows = []
    for agent, result, row in zip(comparison.agents, results, prices, strict=True):
        cells = ["", "", "", *("" for _ in proven[1:]), str(result.status)]
        if result:
            laws = [priced.law for priced in result.steps]
            ends = math.fsum(law.least for law in laws), result.expected_cost, math.fsum(law.most for law in laws)
            marks = ("*" if _are_equal(price, best) else " " for price, best in zip(row, proven, strict=True))
            cells = [*map(_number, ends), *map("".join, zip(map(_number, row), marks, strict=True))]
        rows.append((f"of the {agent}", *cells))
    return Table((Column("cost of the plan"), *(Column(head, is_number=True) for head in heads)), rows)


def _unkept(comparison: AttitudeComparison) -> Iterator[str]:
    """Say that no plan keeps the budgets, which is the same for all agents, and how well each can be kept, in lines."""
    for result in comparison.results:
        if result.largest:
            yield "\n".join([ending(result), *(f"{label}: {what}" for label, what in keep_rows(result))])
            return


def _reasons(comparison: AttitudeComparison) -> Iterator[str]:
    """Say for each agent why it does not do what its neighbours do, in lines."""
    last = len(comparison.results) - 1
    for agent in range(last + 1):
        for other in (agent - 1, agent + 1):
            if 0 <= other <= last and (parts := comparison.differences(agent, other)):
                yield "\n".join(_reason_lines(comparison, agent, other, parts))


def _reason_lines(comparison: AttitudeComparison, agent: int, other: int, parts: Sequence[Difference]) -> Iterator[str]:
    names, prices = comparison.agents, comparison.values
    cost, other_cost = prices[agent][agent], prices[other][agent]
    assert cost is not None
    assert other_cost is not None
    if _are_equal(cost, other_cost):
        same = f"the plan of {names[other]} is as good as its own, {_number(cost)}, by its own measure"
        yield f"{names[agent]}: {same}"
        return
    price, other_price = _apart(cost, other_cost)
    yield f"{names[agent]} instead of {names[other]}: {price}, not {other_price}, by its own measure"
    # Without prices where those of parts of a plan do not add up.
    numbers = on_the_point([_number(cost) for part in parts for cost in (part.own_cost, part.other_cost)])
    for part, own, others in zip(parts, numbers[::2], numbers[1::2], strict=True):
        yield f"  {own}  {_actions(part.own)}"
        yield f"  {others}  instead of {_actions(part.other)}"


def _are_equal(price: float | None, other: float | None) -> bool:
    return price is not None and other is not None and math.isclose(price, other, rel_tol=TIE, abs_tol=LEAST)


def _actions(steps: Sequence[PricedStep]) -> str:
    return actions_text([priced.step for priced in steps])


def actions_text(steps: Sequence[Step]) -> str:
    """Return actions in one line; of many those at the ends."""
    if not steps:
        return "nothing"
    actions = [str(step) for step in steps]
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
