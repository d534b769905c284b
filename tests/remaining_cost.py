"""The true remaining cost of the nodes of a ground problem's search space: what heuristics are judged by.

The space is explored as far as a limit allows, and the costs are found backwards from its solutions. Where the space
goes on beyond the limit they are upper bounds of the true ones: every statement `h <= h*` must hold for them, too.
"""

from __future__ import annotations

import heapq
import itertools
import math
from dataclasses import dataclass, field

from statehtn.model import GroundProblem
from statehtn.risk import Utility

Ordering = frozenset[tuple[int, int]]
Key = tuple[frozenset[int], tuple[int, ...], Ordering]


@dataclass(eq=False)
class SpaceNode:
    """A state and a network: tasks, and pairs of positions in `tasks`, transitively closed."""

    state: frozenset[int]
    tasks: tuple[int, ...]
    ordering: Ordering
    steps: list[tuple[float, SpaceNode]] = field(default_factory=list)  # cost and successor
    remaining_cost: float = math.inf


def explore(problem: GroundProblem, utility: Utility, most_nodes: int = 150) -> list[SpaceNode]:
    """Nodes of the search space, those nearest to the initial node and with the smallest networks first."""
    nodes: dict[Key, SpaceNode] = {}
    counter = itertools.count()
    queue: list[tuple[int, int, int, SpaceNode]] = []

    def add(state: frozenset[int], tasks: tuple[int, ...], ordering: Ordering, depth: int) -> SpaceNode:
        key = (state, *canonical(tasks, ordering))
        if key not in nodes:
            nodes[key] = SpaceNode(*key)
            heapq.heappush(queue, (depth + 3 * len(tasks), depth, next(counter), nodes[key]))
        return nodes[key]

    add(problem.initial_state, (problem.initial_task,), frozenset(), 0)
    while queue and len(nodes) <= most_nodes:
        _, depth, _, node = heapq.heappop(queue)
        for position, task in enumerate(node.tasks):
            if any(second == position for _, second in node.ordering):
                continue
            if problem.is_primitive(task):
                action = problem.actions[task]
                if action.is_applicable(node.state):
                    network = replace(node.tasks, node.ordering, position, (), ())
                    cost = sum(map(utility.risk_cost, action.costs_in(node.state)))
                    node.steps.append((cost, add(action.apply(node.state), *network, depth + 1)))
            else:
                for method in (problem.methods[number] for number in problem.methods_of.get(task, ())):
                    network = replace(node.tasks, node.ordering, position, method.subtasks, method.ordering)
                    node.steps.append((0.0, add(node.state, *network, depth + 1)))
    find_remaining_costs(list(nodes.values()))
    return list(nodes.values())


def replace(
    tasks: tuple[int, ...],
    ordering: Ordering,
    position: int,
    subtasks: tuple[int, ...],
    inner: tuple[tuple[int, int], ...],
) -> tuple[tuple[int, ...], Ordering]:
    """Put subtasks in the place of an unconstrained task."""
    offset = len(tasks)
    pairs = {pair for pair in ordering if position not in pair}
    pairs |= {(offset + i, offset + j) for i, j in inner}
    pairs |= {(offset + i, second) for first, second in ordering if first == position for i in range(len(subtasks))}
    closure = set(pairs)
    while more := {(i, k) for i, j in closure for first, k in closure if first == j} - closure:
        closure |= more
    kept = [index for index in range(offset + len(subtasks)) if index != position]
    number = {old: new for new, old in enumerate(kept)}
    everything = tasks + subtasks
    return tuple(everything[old] for old in kept), frozenset((number[i], number[j]) for i, j in closure)


def canonical(tasks: tuple[int, ...], ordering: Ordering) -> tuple[tuple[int, ...], Ordering]:
    """The same network in an order that depends little on its history; tasks stand behind those before them."""
    neighbours = [
        (sorted(tasks[i] for i, j in ordering if j == k), sorted(tasks[j] for i, j in ordering if i == k))
        for k in range(len(tasks))
    ]
    order = sorted(range(len(tasks)), key=lambda k: (len(neighbours[k][0]), tasks[k], neighbours[k]))
    number = {old: new for new, old in enumerate(order)}
    return tuple(tasks[old] for old in order), frozenset((number[i], number[j]) for i, j in ordering)


def find_remaining_costs(nodes: list[SpaceNode]) -> None:
    """Dijkstra's algorithm, backwards from the nodes with nothing left to do."""
    arrivals: dict[SpaceNode, list[tuple[float, SpaceNode]]] = {node: [] for node in nodes}
    for node in nodes:
        for cost, successor in node.steps:
            arrivals[successor].append((cost, node))
    counter = itertools.count()
    queue = [(0.0, next(counter), node) for node in nodes if not node.tasks]
    while queue:
        cost, _, node = heapq.heappop(queue)
        if cost < node.remaining_cost:
            node.remaining_cost = cost
            for step, before in arrivals[node]:
                heapq.heappush(queue, (cost + step, next(counter), before))
