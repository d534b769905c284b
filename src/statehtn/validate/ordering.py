"""Checks the order of a plan's steps, and that every method precondition holds where it has to.

A method precondition acts as an action without effects before the method's subtasks. It is placed at the earliest
state that follows everything ordered before it and in which it holds. Placing it later would not help anything that
comes after it, so if the earliest places contradict the plan, no places agree with it.
"""

from __future__ import annotations

from dataclasses import dataclass
from graphlib import TopologicalSorter

from statehtn.model.formula import TRUE, And
from statehtn.model.plan import Decomposition, Plan
from statehtn.validate.decomposition import MatchedNetwork, Matching
from statehtn.validate.formulas import is_satisfiable, predicates, text, why_false
from statehtn.validate.world import History, World


@dataclass(frozen=True, slots=True)
class _Bound:
    """The earliest state in which something may start: after so many steps, and after a method precondition if any."""

    time: int
    after: MatchedNetwork | None = None


class _Level:
    """A network on the way down the decomposition: which child comes next, and where the children before it end."""

    def __init__(self, matched: MatchedNetwork, start: _Bound) -> None:
        self.matched = matched
        self.start = start
        self.predecessors: list[list[int]] = [[] for _ in matched.children]
        for before, after in matched.network.ordering:
            self.predecessors[after].append(before)
        self.pending = list(TopologicalSorter(dict(enumerate(self.predecessors))).static_order())[::-1]
        self.ends: list[_Bound] = [start] * len(matched.children)

    def lower_bound(self, child: int) -> _Bound:
        """Return where a child may start; what is ordered before it must have ended."""
        return _latest([self.start, *(self.ends[before] for before in self.predecessors[child])])

    def end(self) -> _Bound:
        """Return where the network ends, once all its children have."""
        return _latest([self.start, *self.ends])


def check_ordering(plan: Plan, matching: Matching, world: World, history: History) -> list[str]:
    """Return what is wrong with the order of the steps and with method preconditions.

    The decomposition must match the methods (`match_networks` found nothing wrong).
    """
    reasons: list[str] = []
    first_steps = _first_steps(plan)
    stack = [_Level(matching.root, _Bound(0))]
    while True:
        level = stack[-1]
        if not level.pending:
            stack.pop()
            if not stack:
                return reasons
            parent = stack[-1]
            index = parent.pending.pop()
            parent.ends[index] = level.end()
            continue
        index = level.pending[-1]
        child, lower = level.matched.children[index], level.lower_bound(index)
        if isinstance(child, Decomposition):
            matched = matching.nodes[id(child)]
            stack.append(_Level(matched, _place(matched, lower, first_steps[id(child)], world, history, reasons)))
        else:
            if child < lower.time:
                reasons.append(_too_early(plan, child, lower))
            level.ends[index] = _Bound(child + 1)
            level.pending.pop()


def _place(
    matched: MatchedNetwork, lower: _Bound, first_step: int | None, world: World, history: History, reasons: list[str]
) -> _Bound:
    """Return the earliest state, from `lower` to the one before `first_step`, in which the precondition holds."""
    until = history.end if first_step is None else first_step
    if matched.precondition == TRUE or lower.time > until:
        # Nothing to wait for, or the steps below come too early anyway, which is said where they stand.
        return lower
    condition = And((matched.network.constraints, matched.precondition))
    for time in (lower.time, *history.change_times(predicates(condition), lower.time, until)):
        if is_satisfiable(condition, matched.unbound, matched.bindings, history.at(time), world):
            return lower if time == lower.time else _Bound(time, matched)
    where = f"after step {lower.time}" if lower.time else "from the initial state on"
    where += "" if first_step is None else f" and before step {first_step + 1}"
    if matched.unbound:
        why = f"no {', '.join(map(str, matched.unbound))} makes {text(condition, matched.bindings)} true"
    else:
        why = why_false(condition, matched.bindings, history.at(until), world)
    reasons.append(f"{matched.title}: its precondition does not hold {where}: {why}")
    return lower


def _too_early(plan: Plan, step: int, lower: _Bound) -> str:
    if isinstance(lower.after, MatchedNetwork):
        waits_for = f"the precondition of {lower.after.title}, which first holds after step {lower.time}"
    else:
        waits_for = f"step {lower.time} {plan.steps[lower.time - 1]}"
    return f"step {step + 1} {plan.steps[step]}: it must come after {waits_for}"


def _first_steps(plan: Plan) -> dict[int, int | None]:
    """Return for every compound node (by `id`) the first step below it, None if there is none."""
    first: dict[int, int | None] = {}
    for node in reversed(list(plan.decompositions())):
        below = [child if isinstance(child, int) else first[id(child)] for child in node.children]
        first[id(node)] = min((step for step in below if step is not None), default=None)
    return first


def _latest(bounds: list[_Bound]) -> _Bound:
    return max(bounds, key=lambda bound: bound.time)
