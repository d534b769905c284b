"""What can be done if nothing is ever deleted: facts, actions and tasks, in levels that look at more of the hierarchy.

Level 0 allows every action at any time. Each further level allows only the actions that the initial network can lead to
by tasks that the level before can accomplish. So each level is a superset of what real plans do; what is missing in one
is part of no plan. The levels end where nothing changes any more, or the initial network cannot be accomplished.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from statehtn.core.grounding import PLAIN, ground
from statehtn.explanation.open_problem import MISS, NETWORK, SEE, UNDO, open_problem
from statehtn.explanation.relation import EMPTY, Relation, Row
from statehtn.limits import Limits, watched
from statehtn.model import GroundAction, GroundProblem, Problem
from statehtn.model.formula import Fact

Literal = tuple[int, bool]
"""A fact of the ground problem, and whether it holds."""


@dataclass(frozen=True)
class Relaxation:
    """What can be done on one level.

    Args:
        problem: the lifted problem.
        true: for every predicate, the facts that can be true.
        gone: for every predicate, the facts of the initial state that can become false.
        able: for every action and task, the arguments with which it can be executed or accomplished.
    """

    problem: Problem
    true: dict[str, Relation]
    gone: dict[str, Relation]
    able: dict[str, Relation]

    @property
    def is_solvable(self) -> bool:
        """Whether the initial network can be accomplished, and the goal reached."""
        return bool(self.able.get(NETWORK, EMPTY).rows)

    def can_be_false(self, fact: Fact) -> bool:
        """Tell whether a fact can be false at some time."""
        return fact not in self.problem.initial_state or fact[1:] in self.gone.get(fact[0], EMPTY)


def relaxations(problem: Problem, limits: Limits = Limits()) -> list[Relaxation]:
    """Return the levels, the strictest last.

    Raises:
        LimitReached: a limit was reached.
        UnsupportedError: a precondition falls into too many cases.
    """
    grounding = ground(open_problem(problem), limits, PLAIN)
    with watched(limits):
        return list(_levels(problem, grounding.to_model()))


def _levels(problem: Problem, model: GroundProblem) -> Iterator[Relaxation]:
    observers = {index for index, action in enumerate(model.actions) if action.name.startswith((SEE, MISS, UNDO))}
    undoing = {index for index in observers if model.actions[index].name.startswith(UNDO)}
    allowed = set(range(len(model.actions))) - observers
    methods = set(range(len(model.methods)))
    while True:
        literals = _literals(model, allowed | undoing)
        executable = {index for index in allowed | observers if _wanted(model.actions[index]) <= literals}
        methods = _usable(model, methods, executable)
        reached = _asked_for(model, methods)
        current = _relaxation(problem, model, executable, methods)
        yield current
        if not current.is_solvable or allowed <= reached:
            return
        allowed &= executable & reached


def _wanted(action: GroundAction) -> set[Literal]:
    """Return the literals of a precondition."""
    return {*((fact, True) for fact in action.precondition), *((fact, False) for fact in action.negative_precondition)}


def _literals(model: GroundProblem, allowed: Iterable[int]) -> set[Literal]:
    """Return the facts that can become true, and those that can become false, by these actions."""
    facts = range(len(model.facts))
    found: set[Literal] = {(fact, fact in model.initial_state) for fact in facts}
    waiting: defaultdict[Literal, list[int]] = defaultdict(list)
    results: list[set[Literal]] = []
    missing: list[int] = []
    pending: list[Literal] = []

    def make(literals: Iterable[Literal]) -> None:
        for literal in literals:
            if literal not in found:
                found.add(literal)
                pending.append(literal)

    for index in allowed:
        action = model.actions[index]
        for effect in action.effects:
            conditions = _wanted(action)
            conditions.update((fact, True) for fact in effect.condition)
            conditions.update((fact, False) for fact in effect.negative_condition)
            conditions -= found
            makes = {*((fact, True) for fact in effect.added), *((fact, False) for fact in effect.deleted)}
            for literal in conditions:
                waiting[literal].append(len(results))
            if not conditions:
                make(makes)
            results.append(makes)
            missing.append(len(conditions))
    while pending:
        for number in waiting[pending.pop()]:
            missing[number] -= 1
            if not missing[number]:
                make(results[number])
    return found


def _usable(model: GroundProblem, methods: Iterable[int], executable: Iterable[int]) -> set[int]:
    """Return the methods whose subtasks can all be accomplished."""
    done = set(executable)
    missing: dict[int, int] = {}
    waiting: defaultdict[int, list[int]] = defaultdict(list)
    usable: set[int] = set()
    pending: list[int] = []
    for method in methods:
        subtasks = set(model.methods[method].subtasks) - done
        missing[method] = len(subtasks)
        for subtask in subtasks:
            waiting[subtask].append(method)
        if not subtasks:
            pending.append(method)
    while pending:
        method = pending.pop()
        usable.add(method)
        task = model.methods[method].task
        if task in done:
            continue
        done.add(task)
        for above in waiting[task]:
            missing[above] -= 1
            if not missing[above]:
                pending.append(above)
    return usable


def _asked_for(model: GroundProblem, methods: Iterable[int]) -> set[int]:
    """Return the tasks and actions that the initial network leads to by these methods."""
    by_task: defaultdict[int, list[int]] = defaultdict(list)
    for method in methods:
        by_task[model.methods[method].task].append(method)
    first = len(model.actions)
    reached = {first + index for index, task in enumerate(model.tasks) if task[0] == NETWORK}
    pending = list(reached)
    while pending:
        for method in by_task[pending.pop()]:
            for subtask in model.methods[method].subtasks:
                if subtask not in reached:
                    reached.add(subtask)
                    pending.append(subtask)
    return reached


def _relaxation(
    problem: Problem, model: GroundProblem, executable: Iterable[int], methods: Iterable[int]
) -> Relaxation:
    rows: defaultdict[str, set[Row]] = defaultdict(set)
    for index in executable:
        action = model.actions[index]
        rows[action.name].add(action.arguments)
    for method in methods:
        name, *arguments = model.tasks[model.methods[method].task - len(model.actions)]
        rows[name].add(tuple(arguments))
    true: defaultdict[str, set[Row]] = defaultdict(set)
    for name, *objects in problem.initial_state:
        true[name].add(tuple(objects))
    gone = {}
    for name, found in rows.items():
        if name.startswith(SEE):
            true[name.removeprefix(SEE)] |= found
        elif name.startswith(MISS):
            gone[name.removeprefix(MISS)] = Relation(found)
    able = {name: Relation(found) for name, found in rows.items() if not name.startswith((SEE, MISS, UNDO))}
    return Relaxation(problem, {name: Relation(found) for name, found in true.items()}, gone, able)
