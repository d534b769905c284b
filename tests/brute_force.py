"""An exhaustive solver for small lifted problems: the judge of the planner, with which it shares no code.

A node is a state and a network of what is still to do; a method's precondition stands in the network as a condition of
its own, ordered before the method's subtasks. Whatever has nothing before it may come next: an action is executed, a
condition tested, a compound task decomposed, in every possible way.
"""

from __future__ import annotations

import heapq
import itertools
import math
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from functools import cached_property

from statehtn.model import TRUE, Decomposition, Formula, Plan, Problem, Step, TaskNetwork
from statehtn.model.formula import free_variables
from statehtn.risk import Utility
from tests.naive_semantics import Bindings, Semantics, State

Path = tuple[
    int, ...
]  # of a task in the decomposition tree: the index of each ancestor among its siblings, then its own
LARGEST_NETWORK = 14
CONDITION = -1  # the last index of the path of a method's precondition


class GaveUp(Exception):
    """The problem is too large for a solver, or its space infinite."""


@dataclass(frozen=True)
class Task:
    path: Path
    name: str
    arguments: tuple[str, ...]
    before: frozenset[Path]  # of what has to end before this may start

    @cached_property
    def label(self) -> str:
        return f"{self.name} {self.arguments}"


@dataclass(frozen=True)
class Condition:
    path: Path
    formula: Formula
    bindings: tuple[tuple[str, str], ...]
    before: frozenset[Path]

    @cached_property
    def label(self) -> str:
        return f"{self.formula} {self.bindings}"


Pending = Task | Condition


@dataclass(frozen=True)
class Event:
    """A step of the plan, the choice of a method, or (without a path) the bindings of the initial network."""

    path: Path
    previous: Event | None
    step: Step | None = None
    decomposition: Decomposition | None = None  # without its children
    size: int = 0  # how many children it has


@dataclass(frozen=True)
class Node:
    state: State
    network: tuple[Pending, ...]
    last: Event


class Space:
    """The search space of a problem."""

    def __init__(self, problem: Problem) -> None:
        self.problem = problem
        self.semantics = Semantics(problem)

    def roots(self) -> Iterator[Node]:
        network = self.problem.network
        for bindings in self.semantics.all_bindings(self.problem.parameters):
            if self.semantics.holds(network.constraints, bindings, self.problem.initial_state):
                values = tuple(bindings[parameter.name] for parameter in self.problem.parameters)
                start = Event((), None, decomposition=Decomposition("", (), "", (), values), size=len(network.subtasks))
                yield Node(self.problem.initial_state, tuple(instantiate(network, TRUE, bindings, ())), start)

    def is_goal(self, node: Node) -> bool:
        return not node.network and self.semantics.holds(self.problem.goal, {}, node.state)

    def successors(self, node: Node, utility: Utility | None) -> Iterator[tuple[float, Node]]:
        """All nodes one step further, each with the risk cost of the step (0 if there is no utility)."""
        for pending in node.network:
            if pending.before:
                continue
            if isinstance(pending, Condition):
                if self.semantics.holds(pending.formula, dict(pending.bindings), node.state):
                    yield 0, replace(node, network=replaced(node.network, pending, []))
            elif pending.name in self.problem.domain.actions:
                state = self.semantics.execute(pending.name, pending.arguments, node.state)
                if state is not None:
                    cost = 0.0
                    if utility is not None:
                        cost = utility.risk_cost(self.semantics.law(pending.name, pending.arguments, node.state))
                    last = Event(pending.path, node.last, step=Step(pending.name, pending.arguments))
                    yield cost, Node(state, replaced(node.network, pending, []), last)
            else:
                yield from ((0, successor) for successor in self.decompositions(node, pending))

    def decompositions(self, node: Node, task: Task) -> Iterator[Node]:
        for method, bindings in self.semantics.instances(task.name, task.arguments):
            parts = list(instantiate(method.network, method.precondition, bindings, task.path))
            values = tuple(bindings[parameter.name] for parameter in method.parameters)
            chosen = Decomposition(task.name, task.arguments, method.name, (), values)
            last = Event(task.path, node.last, decomposition=chosen, size=len(method.network.subtasks))
            yield Node(node.state, replaced(node.network, task, parts), last)


def optimal_risk_cost(problem: Problem, utility: Utility, most_nodes: int = 2000) -> float | None:
    """The least risk cost of any plan; None if there is no plan.

    Uniform-cost search, except that the part of an action's cost that is due in every state counts as soon as the
    action is in the network: otherwise recursion could put actions into it for ever, free of charge.

    Raises:
        GaveUp: more than so many different nodes were generated, or a network has more than LARGEST_NETWORK tasks.
    """
    space, canonical = Space(problem), Canonical()
    due = Due(space, utility)
    generated = itertools.count()
    queue: list[tuple[float, int, int, float, Node]] = []
    cheapest: dict[object, float] = {}

    def add(node: Node, cost: float) -> None:
        key = (node.state, canonical(node.network))
        if cost < cheapest.get(key, math.inf):
            cheapest[key] = cost
            size = len(node.network)
            heapq.heappush(queue, (cost + sum(map(due, node.network)), size, next(generated), cost, node))

    for root in space.roots():
        add(root, 0)
    while queue:
        _, size, _, cost, node = heapq.heappop(queue)
        if space.is_goal(node):
            return cost
        if len(cheapest) > most_nodes or size > LARGEST_NETWORK:
            raise GaveUp
        if cost == cheapest[node.state, canonical(node.network)]:
            for step, successor in space.successors(node, utility):
                add(successor, cost + step)
    return None


class Due:
    """The part of a pending action's cost that is due in every state; nothing for other tasks and conditions."""

    def __init__(self, space: Space, utility: Utility) -> None:
        self.space = space
        self.utility = utility
        self.certain: dict[str, float] = {}

    def __call__(self, pending: Pending) -> float:
        if pending.label not in self.certain:
            self.certain[pending.label] = 0
            actions = self.space.problem.domain.actions
            if isinstance(pending, Task) and pending.name in actions:
                semantics = self.space.semantics
                if semantics.bind(actions[pending.name], pending.arguments) is not None:
                    law = semantics.law(pending.name, pending.arguments, None)
                    self.certain[pending.label] = self.utility.risk_cost(law)
        return self.certain[pending.label]


def best_risk_costs(problem: Problem, utility: Utility, k: int, distinct: str, most_nodes: int = 2000) -> list[float]:
    """The risk costs of the k best plans, which differ as sequences or as multisets of actions; all if there are fewer.

    Uniform-cost search as for the optimum, but every list of actions that leads to a state and a network is a node of
    its own.

    Raises:
        GaveUp: as `optimal_risk_cost`.
    """
    space, canonical = Space(problem), Canonical()
    due = Due(space, utility)
    generated = itertools.count()
    queue: list[tuple[float, int, int, float, Node, tuple[str, ...]]] = []
    cheapest: dict[object, float] = {}
    found: dict[tuple[str, ...], float] = {}

    def add(node: Node, steps: tuple[str, ...], cost: float) -> None:
        key = (node.state, canonical(node.network), steps)
        if cost < cheapest.get(key, math.inf):
            cheapest[key] = cost
            size = len(node.network)
            heapq.heappush(queue, (cost + sum(map(due, node.network)), size, next(generated), cost, node, steps))

    for root in space.roots():
        add(root, (), 0)
    while queue and len(found) < k:
        _, size, _, cost, node, steps = heapq.heappop(queue)
        if space.is_goal(node):
            found.setdefault(steps, cost)
        if len(cheapest) > most_nodes or size > LARGEST_NETWORK:
            raise GaveUp
        for step, successor in space.successors(node, utility):
            executed = successor.last.step if successor.last is not node.last else None
            after = steps if executed is None else (*steps, str(executed))
            add(successor, after if distinct == "sequence" else tuple(sorted(after)), cost + step)
    return list(found.values())


def all_plans(problem: Problem, most: int = 100_000, largest_network: float = math.inf) -> list[Plan]:
    """All plans, one for each sequence of actions, by exhaustive decomposition; for problems whose space is finite.

    Raises:
        GaveUp: more than `most` nodes were expanded, or a network has more than `largest_network` tasks.
    """
    space, canonical = Space(problem), Canonical()
    pending = [(root, ()) for root in space.roots()]
    seen = set()
    plans: dict[tuple[Step, ...], Plan] = {}
    while pending:
        node, steps = pending.pop()
        key = (node.state, canonical(node.network), steps)
        if key in seen:
            continue
        seen.add(key)
        if len(seen) > most or len(node.network) > largest_network:
            raise GaveUp
        if space.is_goal(node):
            plans.setdefault(steps, read_plan(node))
        for _, successor in space.successors(node, None):
            executed = successor.last.step if successor.last is not node.last else None
            pending.append((successor, steps if executed is None else (*steps, executed)))
    return list(plans.values())


def read_plan(node: Node) -> Plan:
    """The plan that led to a node with nothing left to do."""
    events: list[Event] = []
    event: Event | None = node.last
    while event is not None:
        events.append(event)
        event = event.previous
    steps = [event for event in reversed(events) if event.step is not None]
    place: dict[Path, int] = {event.path: index for index, event in enumerate(steps)}
    chosen = {event.path: event for event in events if event.decomposition is not None}

    def read(path: Path) -> int | Decomposition:
        if path in place:
            return place[path]
        decomposition = chosen[path].decomposition
        assert decomposition is not None
        return replace(decomposition, children=tuple(read((*path, i)) for i in range(chosen[path].size)))

    root = read(())
    assert isinstance(root, Decomposition)
    return Plan(tuple(event.step for event in steps if event.step is not None), root.children, root.bindings)


def instantiate(network: TaskNetwork, precondition: Formula, bindings: Bindings, path: Path) -> Iterator[Pending]:
    """What a decomposition puts into the network: the method's precondition and, after it, its subtasks."""
    first: frozenset[Path] = frozenset()
    if precondition != TRUE:
        needed = sorted(set(free_variables(precondition)))
        first = frozenset({(*path, CONDITION)})
        yield Condition((*path, CONDITION), precondition, tuple((name, bindings[name]) for name in needed), frozenset())
    for index, subtask in enumerate(network.subtasks):
        before = {(*path, i) for i, j in network.ordering if j == index}
        arguments = tuple(bindings.get(term, term) for term in subtask.arguments)
        yield Task((*path, index), subtask.task, arguments, first | before)


def replaced(network: Iterable[Pending], old: Pending, parts: list[Pending]) -> tuple[Pending, ...]:
    """Put the parts in the place of something that nothing is before: what came after it comes after all of them."""
    paths = {part.path for part in parts}
    rest = [
        replace(other, before=(other.before - {old.path}) | paths) if old.path in other.before else other
        for other in network
        if other.path != old.path
    ]
    return (*rest, *parts)


class Canonical:
    """Networks without their paths: equal values mean equal networks; the reverse holds nearly always."""

    def __init__(self) -> None:
        self.numbers: dict[object, int] = {}  # of labels and of histories, so that histories stay short

    def __call__(self, network: tuple[Pending, ...]) -> tuple[object, ...]:
        by_path = {pending.path: pending for pending in network}
        known: dict[Path, int] = {}

        def history(path: Path) -> int:
            if path not in known:
                known[path] = self.number((by_path[path].label, *sorted(map(history, by_path[path].before))))
            return known[path]

        future: dict[Path, list[int]] = {path: [] for path in by_path}
        for pending in network:
            for path in pending.before:
                future[path].append(history(pending.path))
        ordered = sorted(network, key=lambda pending: (history(pending.path), sorted(future[pending.path])))
        position = {pending.path: index for index, pending in enumerate(ordered)}
        return tuple(
            (self.number(pending.label), frozenset(position[path] for path in pending.before)) for pending in ordered
        )

    def number(self, value: object) -> int:
        return self.numbers.setdefault(value, len(self.numbers))
