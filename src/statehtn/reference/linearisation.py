"""Executable task networks (the paper's Definition 4.2): an order of primitive tasks in which all can be executed."""

from __future__ import annotations

import heapq
import itertools

from statehtn.model.ground import GroundProblem
from statehtn.reference.search_node import SearchNode, apply
from statehtn.risk import Utility


def cheapest_execution(node: SearchNode, problem: GroundProblem, utility: Utility) -> SearchNode | None:
    """Return the node after its network has been executed in the cheapest order; None if there is no such order.

    Uniform-cost search over states and rests of the network. The question is NP-complete.

    Args:
        node: a node whose tasks are all primitive.
        problem: the ground problem.
        utility: the agent's.
    """
    counter = itertools.count()
    fringe = [(node.cost, next(counter), node)]
    closed = set()
    while fringe:
        _, _, node = heapq.heappop(fringe)
        if not node.network.tasks:
            return node
        key = (node.state, frozenset(node.network.tasks))
        if key in closed:
            continue
        closed.add(key)
        for identifier in node.network.unconstrained():
            if problem.actions[node.network.tasks[identifier]].is_applicable(node.state):
                successor = apply(node, identifier, problem, utility)
                heapq.heappush(fringe, (successor.cost, next(counter), successor))
    return None
