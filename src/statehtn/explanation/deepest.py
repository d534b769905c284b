"""How far one gets where nothing but the order or what is deleted stands in the way."""

from __future__ import annotations

import heapq
from collections.abc import Iterator
from dataclasses import dataclass, replace
from itertools import count

from statehtn.core.grounding import PLAIN, ground
from statehtn.limits import LimitReached, Limits, status_of
from statehtn.model import GroundAction, GroundProblem, Problem
from statehtn.model.formula import Fact
from statehtn.model.plan import Step
from statehtn.model.status import Status
from statehtn.reference.find_plans import successors
from statehtn.reference.search_node import SearchNode, initial_node
from statehtn.risk import Neutral

MOST_NODES = 5000
MOST_SHOWN = 3
NEARLY = 1
"""Points with so many actions less than the deepest ones are told, too."""


@dataclass(frozen=True, slots=True)
class Lack:
    """A fact that a task needs and does not find.

    Args:
        fact: the fact.
        wanted: whether it is to be true, or false.
        changed_by: the number of the step that made it otherwise, from 1; None if it was so from the beginning.
    """

    fact: Fact
    wanted: bool
    changed_by: int | None


@dataclass(frozen=True, slots=True)
class Deadlock:
    """A point from which nothing can go on.

    Args:
        steps: the actions so far.
        task: what would come next: an action, the precondition of a method, or the goal.
        lacks: what it needs and does not find.
    """

    steps: tuple[Step, ...]
    task: str
    lacks: tuple[Lack, ...]

    def to_dict(self) -> dict[str, object]:
        """Return it as JSON has it."""
        lacks = [
            {"fact": f"({' '.join(each.fact)})", "wanted": each.wanted, "changed_by": each.changed_by}
            for each in self.lacks
        ]
        return {"steps": [str(step) for step in self.steps], "task": self.task, "lacks": lacks}


@dataclass(frozen=True, slots=True)
class Exploration:
    """Where the search for a plan gets stuck.

    Args:
        deadlocks: the points with the most actions executed, at most one for each task and what it lacks.
        nodes: how many nodes were looked at.
        is_all: whether these are all there are.
        stopped: what ended it before its time: Ctrl-C, or too little memory.
    """

    deadlocks: tuple[Deadlock, ...]
    nodes: int
    is_all: bool
    stopped: Status | None = None


def explore(problem: Problem, limits: Limits = Limits()) -> Exploration:
    """Look at nodes, those with few open tasks first, and return where nothing goes on.

    Args:
        problem: one that has no plan, or no policy that is ever done.
        limits: where they are reached, what has been found so far is returned.
    """
    model = _with_the_best_outcomes(ground(problem, limits, PLAIN).to_model())
    number = count()
    first = initial_node(model)
    queue = [(0, next(number), first)]
    known = {(first.state, first.network.key())}
    found: dict[tuple[str, tuple[Lack, ...]], Deadlock] = {}
    nodes = 0
    stopped: Status | None = None
    try:
        while queue and nodes < MOST_NODES:
            limits.check()
            _, _, node = heapq.heappop(queue)
            nodes += 1
            following = list(successors(node, model, Neutral()))
            for deadlock in _deadlocks(node, model) if not following else ():
                key = deadlock.task, tuple(Lack(lack.fact, lack.wanted, None) for lack in deadlock.lacks)
                if key not in found or len(deadlock.steps) > len(found[key].steps):
                    found[key] = deadlock
            for each in following:
                mark = each.state, each.network.key()
                if mark not in known:
                    known.add(mark)
                    heapq.heappush(queue, (len(each.network.tasks), next(number), each))
    except LimitReached:
        pass
    except (KeyboardInterrupt, MemoryError) as ending:
        stopped = status_of(ending)
    most = max((len(deadlock.steps) for deadlock in found.values()), default=0)
    deepest = sorted(found.values(), key=lambda deadlock: -len(deadlock.steps))
    shown = (deadlock for deadlock in deepest[:MOST_SHOWN] if len(deadlock.steps) >= most - NEARLY)
    return Exploration(tuple(shown), nodes, not queue and stopped is None, stopped)


def _with_the_best_outcomes(model: GroundProblem) -> GroundProblem:
    """Return the problem in which the agent chooses what comes of actions, of all that may come."""
    if not model.chance_tasks:
        return model
    methods = (
        method
        for method in model.methods
        if method.task not in model.chance_tasks or all(model.actions[each].probability for each in method.subtasks)
    )
    return replace(model, methods=tuple(methods), chance_tasks=frozenset())


def _deadlocks(node: SearchNode, model: GroundProblem) -> Iterator[Deadlock]:
    """Yield the tasks that would come next at a node, with what each lacks."""
    own = [execution.action for execution in node.plan]
    steps = tuple(
        Step(action.name, action.arguments) for index in own if not (action := model.actions[index]).is_precondition
    )
    for identifier in node.network.unconstrained():
        task = node.network.tasks[identifier]
        if model.is_primitive(task):
            action = model.actions[task]
            wanted = [
                *((fact, True) for fact in sorted(action.precondition - node.state)),
                *((fact, False) for fact in sorted(action.negative_precondition & node.state)),
            ]
            changes = _last_changes(own, model)
            lacks = tuple(Lack(model.facts[fact], value, changes.get((fact, not value))) for fact, value in wanted)
            yield Deadlock(steps, _name(action), lacks)


def _name(action: GroundAction) -> str:
    words = f"({' '.join((action.name, *action.arguments))})"
    if not action.is_precondition:
        return words
    return f"the {action.name.replace('precondition of ', 'precondition of method ')}"


def _last_changes(executed: list[int], model: GroundProblem) -> dict[tuple[int, bool], int]:
    """Return the numbers of the steps that last made facts true or false."""
    found: dict[tuple[int, bool], int] = {}
    state = model.initial_state
    step = 0
    for index in executed:
        action = model.actions[index]
        if action.is_precondition:
            continue
        step += 1
        after = action.apply(state)
        found.update(((fact, True), step) for fact in after - state)
        found.update(((fact, False), step) for fact in state - after)
        state = after
    return found
