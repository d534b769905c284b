"""Why there is no plan, or why it is not that plan, in lines."""

from __future__ import annotations

import math
from collections.abc import Iterator

from statehtn.counted import counted
from statehtn.display.comparison import LEAST, TIE, actions_text
from statehtn.display.no_policy import no_policy_lines, policy_lines
from statehtn.display.table import on_the_point
from statehtn.display.tree import tree_text
from statehtn.display.words import ENDINGS, number, value_text, with_unit
from statehtn.explanation.deepest import Deadlock, Exploration, Lack
from statehtn.explanation.explanation import NoPlan
from statehtn.explanation.given_plan import WhyNot
from statehtn.explanation.reason import Addition, Reason
from statehtn.model.decomposition_tree import TreeRow
from statehtn.model.status import Status
from statehtn.risk import ValueUnit

MOST_STEPS = 12
"""Steps of a way that are shown; those before them are counted."""
PRICES = {ValueUnit.LOG_UTILITY: ", with what they count: -ln of probabilities and of utilities"}
"""What the numbers beside parts of plans are, where they are no costs."""


def no_plan_text(answer: NoPlan) -> str:
    """Return why there is no plan."""
    if answer.reason is not None:
        return "\n".join(_unreachable(answer.reason, answer.additions))
    if answer.exploration is not None:
        return "\n".join(_stuck(answer.exploration))
    if answer.policies is not None:
        return "\n".join(policy_lines(answer.policies, answer.chance))
    if answer.chance is not None:
        return "\n".join(no_policy_lines(answer.chance))
    if answer.plan is not None:
        steps = counted(len(answer.plan.steps), "action")
        return f"There is a plan, of {steps}: {actions_text(answer.plan.steps)}\n'statehtn plan' finds the best one."
    return f"It is not known whether there is a plan: {ENDINGS[answer.status]}"


def reason_lines(reason: Reason | None) -> list[str]:
    """Return in two lines why there is no plan, as far as the relaxation tells."""
    if reason is None:
        return [
            "why: each task could be accomplished if nothing were ever deleted; the order or what is deleted forbids it"
        ]
    first = f"why: {reason}, even if nothing were ever deleted"
    root = next(reason.roots(), reason)
    return [first] if root is reason else [first, f"at the root: {root}"]


def _unreachable(reason: Reason, additions: tuple[tuple[Addition, ...], ...]) -> Iterator[str]:
    yield "There is no plan. Even if nothing were ever deleted, and in whatever order, this could not be done:"
    yield ""
    yield tree_text(list(_rows(reason, 0)))
    if additions:
        yield ""
        yield "As far as that goes, it could be done with any one of these additions to the problem:"
        yield from (f"  {' and '.join(map(str, each))}" for each in additions)


def _rows(reason: Reason, depth: int) -> Iterator[TreeRow]:
    yield TreeRow(depth, str(reason))
    for child in reason.children:
        yield from _rows(child, depth + 1)


def _stuck(explored: Exploration) -> Iterator[str]:
    yield "There is no plan, though each task could be accomplished if nothing were ever deleted:"
    yield "the order of the tasks, or what actions delete, forbids it."
    if not explored.deadlocks:
        yield f"No point where nothing goes on was met among the first {counted(explored.nodes, 'node')} of the search."
        return
    which = "all" if explored.is_all else f"the first {explored.nodes}"
    yield f"Of {which} nodes of the search these have come farthest before nothing could go on:"
    for deadlock in explored.deadlocks:
        yield ""
        yield from _deadlock(deadlock)


def _deadlock(deadlock: Deadlock) -> Iterator[str]:
    steps = deadlock.steps
    hidden = max(0, len(steps) - MOST_STEPS)
    before = f"... {hidden} before ... " if hidden else ""
    way = f"after {counted(len(steps), 'action')}: {before}{' '.join(map(str, steps[hidden:]))}"
    yield f"  {way if steps else 'at the beginning'}"
    for lack in deadlock.lacks:
        yield f"    {deadlock.task} needs {_lack(lack, deadlock)}"


def _lack(lack: Lack, deadlock: Deadlock) -> str:
    fact = f"({' '.join(lack.fact)})"
    wanted = fact if lack.wanted else f"(not {fact})"
    if lack.changed_by is None:
        return f"{wanted}, which has {'not been true' if lack.wanted else 'been true'} from the beginning"
    step = f"step {lack.changed_by} {deadlock.steps[lack.changed_by - 1]}"
    return f"{wanted}, but {step} made {fact} {'false' if lack.wanted else 'true'}"


def why_not_text(answer: WhyNot) -> str:
    """Return what a plan violates, or what it costs more than the best one."""
    return "\n".join(_why_not(answer))


def _why_not(answer: WhyNot) -> Iterator[str]:
    if answer.given is None:
        yield "It is no plan of this problem:" if answer.stopped is None else "It is not known whether it is a plan:"
        yield from (f"- {reason}" for reason in answer.reasons or (ENDINGS[answer.status],))
        return
    given, best = answer.given, answer.best
    assert best is not None
    value = f"value {with_unit(given.value, answer.objective.unit)}"
    name, unit = f"by '{answer.objective}'", answer.objective.unit
    if best.value is None:
        yield f"It is a valid plan, of {value} {name}; no other was found: {ENDINGS[best.status]}"
        return
    proven = best.status is Status.OPTIMAL
    if given.value <= best.value or math.isclose(given.value, best.value, rel_tol=TIE, abs_tol=LEAST):
        why = "no plan is better" if proven else "none better was found before the run was ended"
        yield f"It is a valid plan, of {value} {name}: {why}."
        return
    more = number(given.value - best.value)
    which = "the best plan" if proven else "the best plan that was found"
    values = f"{value_text(given.value, unit)}, not {value_text(best.value, unit)}"
    worse = f"costs {more} more than" if unit is ValueUnit.COST else f"its value is {more} ({unit}) above that of"
    yield f"It is a valid plan, and {worse} {which}: {values}, {name}."
    yield f"Where they part{PRICES.get(unit, '')}:"
    parts = answer.differences
    numbers = on_the_point([number(cost) for part in parts for cost in (part.own_cost, part.other_cost)])
    for part, own, others in zip(parts, numbers[::2], numbers[1::2], strict=True):
        yield f"  {own}  {actions_text([priced.step for priced in part.own])}"
        yield f"  {others}  in the best plan: {actions_text([priced.step for priced in part.other])}"
