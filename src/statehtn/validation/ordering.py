"""Checks the order of a plan's steps, and that every method precondition holds where it has to.

A method precondition acts as an action without effects before the method's subtasks. It is placed at the earliest
state that follows everything ordered before it and in which it holds. Placing it later would not help anything that
comes after it, so if the earliest places contradict the plan, no places agree with it.
"""

from __future__ import annotations

from dataclasses import dataclass

from statehtn.model.formula import predicates
from statehtn.model.plan import Plan
from statehtn.semantics.formulas import text
from statehtn.semantics.history import History
from statehtn.semantics.world import World
from statehtn.validation.decomposition import MatchedNetwork, Matching
from statehtn.validation.tree import PlanTree


@dataclass(frozen=True, slots=True)
class _Bound:
    """The earliest state in which something may start: after so many steps, and after a method precondition if any."""

    time: int
    after: MatchedNetwork | None = None


class _Level:
    """A network on the way down the decomposition: which child comes next, and where the children before it end."""

    __slots__ = ("at", "children", "ends", "lifted", "start")

    def __init__(self, matched: MatchedNetwork, children: list[int], start: _Bound) -> None:
        self.lifted = matched.lifted
        self.children = children
        self.start = start
        self.at = 0  # in the lifted network's order
        self.ends = [start] * len(children)

    def lower_bound(self, child: int) -> _Bound:
        """Return where a child may start; what is ordered before it must have ended."""
        bound = self.start
        for before in self.lifted.predecessors[child]:
            if self.ends[before].time > bound.time:
                bound = self.ends[before]
        return bound

    def end(self) -> _Bound:
        """Return where the network ends, once all its children have."""
        bound = self.start
        for end in self.ends:
            if end.time > bound.time:
                bound = end
        return bound


def check_ordering(tree: PlanTree, matching: Matching, world: World, history: History) -> list[str]:
    """Return what is wrong with the order of the steps and with method preconditions.

    The decomposition must match the methods (`match_networks` found nothing wrong).
    """
    reasons: list[str] = []
    first_steps = tree.first_steps()

    def enter(number: int, lower: _Bound) -> None:
        matched = matching.networks[number]
        assert matched is not None
        start = lower
        if matched.lifted.precondition is not None:
            start = _place(matched, lower, first_steps[number], world, history, reasons)
        stack.append(_Level(matched, tree.children[number], start))

    stack: list[_Level] = []
    enter(0, _Bound(0))
    while True:
        world.work()
        level = stack[-1]
        order = level.lifted.order
        while level.at < len(order):
            index = order[level.at]
            child, lower = level.children[index], level.lower_bound(index)
            if child < 0:
                enter(~child, lower)
                break
            if child < lower.time:
                reasons.append(_too_early(tree.plan, child, lower))
            level.ends[index] = _Bound(child + 1)
            level.at += 1
        else:
            stack.pop()
            if not stack:
                return reasons
            parent = stack[-1]
            parent.ends[parent.lifted.order[parent.at]] = level.end()
            parent.at += 1


def _place(
    matched: MatchedNetwork, lower: _Bound, first_step: int | None, world: World, history: History, reasons: list[str]
) -> _Bound:
    """Return the earliest state, from `lower` to the one before `first_step`, in which the precondition holds."""
    until = history.end if first_step is None else first_step
    if lower.time > until:
        return lower  # the steps below come too early anyway, which is said where they stand
    time = _first_time(matched, lower.time, until, world, history)
    if time is not None:
        return lower if time == lower.time else _Bound(time, matched)
    where = f"after step {lower.time}" if lower.time else "from the initial state on"
    where += "" if first_step is None else f" and before step {first_step + 1}"
    if matched.precondition is not None:
        why = matched.precondition.why_false(history.at(until))
    else:
        assert matched.lifted.precondition is not None
        condition = text(matched.lifted.precondition.formula, matched.bindings)
        why = f"no {', '.join(map(str, matched.unbound))} makes {condition} true"
    reasons.append(f"{matched.title}: its precondition does not hold {where}: {why}")
    return lower


def _first_time(matched: MatchedNetwork, after: int, until: int, world: World, history: History) -> int | None:
    """Return the first time of `after <= time <= until` at which the precondition of a network holds."""
    if matched.precondition is not None:
        return matched.precondition.first_time(history, after, until)
    condition = matched.lifted.precondition
    assert condition is not None
    if condition.is_satisfiable(matched.unbound, matched.bindings, history.at(after)):
        return after
    for time in history.change_times(set(predicates(condition.formula)), after, until):
        world.work()
        if condition.is_satisfiable(matched.unbound, matched.bindings, history.at(time)):
            return time
    return None


def _too_early(plan: Plan, step: int, lower: _Bound) -> str:
    if isinstance(lower.after, MatchedNetwork):
        waits_for = f"the precondition of {lower.after.title}, which first holds after step {lower.time}"
    else:
        waits_for = f"step {lower.time} {plan.steps[lower.time - 1]}"
    return f"step {step + 1} {plan.steps[step]}: it must come after {waits_for}"
