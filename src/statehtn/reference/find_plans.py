"""Algorithm 4 of the paper, FindPlans: A* over states and task networks. Slow, and meant to be read.

The numbers in the comments are the lines of the pseudo-code. Costs are positive and minimised here (the paper's are
negative and maximised), so the fringe is ordered by rising f. Where it differs from the paper, and why:

- Line 7: a node is a solution when its network is *empty*. The paper stops as soon as only primitive tasks are left,
  which would drop them from the plan.
- Line 16: the preconditions of methods are actions of the ground problem (precondition actions), ordered before the
  method's subtasks, and so is the goal, after everything else; they are tested by line 11.
- There is a closed list: a state and network that were reached before at no higher cost are not put into the fringe
  again.
"""

from __future__ import annotations

import heapq
import itertools
import math
from collections.abc import Callable, Iterator

from statehtn.model.ground import GroundProblem
from statehtn.model.status import Status
from statehtn.reference.compute_rc_ad_heur import Heuristic, compute_rc_ad_heur
from statehtn.reference.read_plan import read_plan
from statehtn.reference.search_node import SearchNode, Solution, apply, decompose, initial_node
from statehtn.risk import Utility


def find_plans(
    problem: GroundProblem,
    utility: Utility,
    heuristic: Heuristic,
    *,
    most_expansions: int | None = None,
    visit: Callable[[SearchNode, float], None] | None = None,
) -> Solution:
    """Find a plan of least risk cost, that is, of maximum expected utility.

    Args:
        problem: a ground problem, totally or partially ordered.
        utility: the agent's.
        heuristic: an admissible classical heuristic, called on the relaxed model of every node.
        most_expansions: give up after so many; None: never. Recursion can make the
            space infinite.
        visit: is called with every node that is expanded and the heuristic's value there.

    Raises:
        ValueError: the problem is not plain, so that no decomposition could be read from it.
    """
    counter = itertools.count()
    fringe: list[tuple[float, int, int, float, SearchNode]] = []
    cheapest: dict[tuple[object, ...], float] = {}
    expanded = 0

    def add_and_order(node: SearchNode) -> None:  # 2, 13, 14; 18, 19
        key = (node.state, *node.network.key())
        if node.cost >= cheapest.get(key, math.inf):
            return
        h = compute_rc_ad_heur(node.state, node.network.tasks.values(), problem, utility, heuristic)
        if h < math.inf:
            cheapest[key] = node.cost
            heapq.heappush(fringe, (node.cost + h, len(node.network.tasks), next(counter), h, node))

    add_and_order(initial_node(problem))  # 1, 3
    while fringe:  # 5
        _, _, _, h, node = heapq.heappop(fringe)  # 6
        if node.cost > cheapest[(node.state, *node.network.key())]:
            continue  # a cheaper way to the same was found after this one
        if not node.network.tasks:  # 7
            plan = read_plan(problem, node.plan, node.choices)
            return Solution(Status.OPTIMAL, plan, node.cost, expanded)  # 8
        if expanded == most_expansions:
            return Solution(Status.GAVE_UP, expanded=expanded)
        expanded += 1
        if visit is not None:
            visit(node, h)
        for successor in successors(node, problem, utility):
            add_and_order(successor)
    return Solution(Status.UNSOLVABLE, expanded=expanded)  # 20


def successors(node: SearchNode, problem: GroundProblem, utility: Utility) -> Iterator[SearchNode]:
    """Yield all nodes one step further (lines 9 to 19): every unconstrained task is executed or decomposed."""
    for identifier in node.network.unconstrained():  # 9, 10
        task = node.network.tasks[identifier]
        if problem.is_primitive(task):
            if problem.actions[task].is_applicable(node.state):  # 11
                yield apply(node, identifier, problem, utility)  # 12
        else:
            for method in problem.methods_of.get(task, ()):  # 16
                yield decompose(node, identifier, method, problem)  # 17
