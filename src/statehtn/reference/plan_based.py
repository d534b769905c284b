"""Algorithm 3 of the paper, the plan-based solver: A* over task networks, without a state. Slow, and meant to be read.

The numbers in the comments are the lines of the pseudo-code. Costs are positive and minimised here (the paper's are
negative and maximised), so the fringe is ordered by rising f. Where it differs from the paper, and why:

- Lines 5 and 18: the values of Algorithm 2 as printed can be too pessimistic where tasks lead back to themselves.
  `least_risk_costs` is what is meant.
- Lines 10 and 11: the value of a primitive network is a lower bound where costs depend on the state. It goes back into
  the fringe with what its cheapest executable order costs, and is returned when it comes first again.
- Line 20: networks that no finite decomposition completes are left out.
"""

from __future__ import annotations

import heapq
import itertools
import math
from collections.abc import Iterator

from statehtn.decomposition import ground_task_decomposition_graph, least_risk_costs
from statehtn.model.ground import GroundProblem
from statehtn.model.status import Status
from statehtn.reference.linearisation import cheapest_execution
from statehtn.reference.read_plan import read_plan
from statehtn.reference.search_node import SearchNode, Solution, decompose, initial_node
from statehtn.reference.task_network import TaskNetwork
from statehtn.risk import Utility


def plan_based(problem: GroundProblem, utility: Utility, *, most_expansions: int | None = None) -> Solution:
    """Find a plan of least risk cost, that is, of maximum expected utility.

    Args:
        problem: a ground problem, totally or partially ordered.
        utility: the agent's.
        most_expansions: give up after so many networks were decomposed or executed; None: never. Recursion can make
            the space infinite.

    Raises:
        ValueError: the problem is not plain, so that no decomposition could be read from it.
    """
    node = initial_node(problem)
    values = least_risk_costs(ground_task_decomposition_graph(problem), utility)

    def f(network: TaskNetwork) -> float:
        g = h = 0.0
        for task in network.tasks.values():  # 1; 14
            value = values.get(f"t{task}", 0.0)  # precondition actions are not in the graph
            if problem.is_primitive(task):  # 2; 15
                g += value  # 3; 16
            else:  # 4; 17
                h += value  # 5; 18
        return g + h  # 6; 19

    counter = itertools.count()
    fringe = [(f(node.network), next(counter), node)]  # 7
    closed = {node.network.key()}  # 7: V
    expanded = 0
    while fringe:  # 8
        cost, _, node = heapq.heappop(fringe)  # 9
        if not node.network.tasks:  # its cheapest order has been found
            return Solution(Status.OPTIMAL, read_plan(problem, node.plan, node.choices), cost, expanded)  # 11
        if expanded == most_expansions:
            return Solution(Status.GAVE_UP, expanded=expanded)
        expanded += 1
        if all(map(problem.is_primitive, node.network.tasks.values())):  # 10
            executed = cheapest_execution(node, problem, utility)  # 10
            if executed is not None:
                heapq.heappush(fringe, (executed.cost, next(counter), executed))
        for successor in decompositions(node, problem):  # 12, 13
            key, cost = successor.network.key(), f(successor.network)
            if key not in closed and cost < math.inf:  # 20
                heapq.heappush(fringe, (cost, next(counter), successor))  # 20, 21
                closed.add(key)  # 22
    return Solution(Status.UNSOLVABLE, expanded=expanded)  # 23


def decompositions(node: SearchNode, problem: GroundProblem) -> Iterator[SearchNode]:
    """Yield all networks one decomposition further (line 12), whichever task is decomposed."""
    for identifier, task in node.network.tasks.items():
        for method in problem.methods_of.get(task, ()):
            yield decompose(node, identifier, method, problem)
