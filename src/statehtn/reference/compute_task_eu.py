"""Algorithms 1 and 2 of the paper, as they are printed: the values of tasks and methods for the plan-based solver.

Slow on purpose, and wrong on cyclic graphs in ways that `docs/paper-map.md` explains. `least_risk_costs` in
`statehtn.decomposition.values` has what is meant, and `tdg_bound` of the compiled core the same.

The numbers in the comments are the lines of the pseudo-code. Values are the paper's (equation 10 with the sign that it
needs, see `paper_value`): not positive, and maximised.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import TYPE_CHECKING

from statehtn.decomposition.graphs import Kind
from statehtn.decomposition.values import least_price
from statehtn.risk import Utility
from statehtn.risk.expected_utility import paper_unit

if TYPE_CHECKING:
    import networkx as nx

Vector = dict[int, float]
"""The expected utilities of a node by `gid`, the number of the root from which they were computed."""


def compute_utilities(
    graph: nx.MultiDiGraph[str], utility: Utility, *, as_printed: bool = True
) -> Mapping[str, Vector]:
    """Return the vector of expected utilities of every task and method (Algorithm 1).

    A value that was not computed for some root is missing, where the paper has plus infinity. A primitive task has its
    value at root 0, and at every root that leads to it.

    Args:
        graph: as `ground_task_decomposition_graph` returns it.
        utility: the agent's.
        as_printed: whether Algorithm 2 goes on after line 6, as it is printed; False: it returns there, which the
            paper's own example of two cycles takes for granted.
    """
    vectors: dict[str, Vector] = {node: {} for node in graph}  # 6, 7, 8
    for task in graph:
        if graph.nodes[task]["kind"] is Kind.PRIMITIVE:  # 1
            vectors[task][0] = -least_price(graph, task, utility) * paper_unit(utility)  # 2 to 5
    compound = [node for node, kind in graph.nodes.data("kind") if kind is Kind.COMPOUND]
    for gid, task in enumerate(compound, 1):  # 9, 10, 11
        vectors[task][gid] = compute_task_eu(task, (), gid, graph, vectors, as_printed=as_printed)  # 12, 13
    return vectors


def compute_task_eu(
    task: str,
    path: tuple[str, ...],
    gid: int,
    graph: nx.MultiDiGraph[str],
    vectors: dict[str, Vector],
    last_method: str = "",
    *,
    as_printed: bool = True,
) -> float:
    """Return the expected utility of a task below the tasks of a decomposition path (Algorithm 2, ComputeTaskEU).

    Args:
        task: the task in question (`groundTsk`).
        path: the tasks on the way from the root (`decompPath`).
        gid: the number of the root.
        graph: the ground graph, which has all methods.
        vectors: of all nodes; filled in on the way.
        last_method: the method by which the path came here (m' of line 6).
        as_printed: see `compute_utilities`.
    """
    if graph.nodes[task]["kind"] is Kind.PRIMITIVE:  # 2
        return vectors[task][0]  # 3
    if task in path:  # 5
        vectors[last_method][gid] = -math.inf  # 6
        if not as_printed:
            return -math.inf
    for method in graph.successors(task):  # 7
        if gid not in vectors[method]:  # 8: plus infinity
            subtasks = [subtask for _, subtask in graph.out_edges(method)]  # with repetitions
            for subtask in subtasks:  # 9
                vectors[subtask][gid] = compute_task_eu(  # 11
                    subtask,
                    (*path, task),
                    gid,
                    graph,
                    vectors,
                    method,
                    as_printed=as_printed,  # 10
                )
            if gid not in vectors[method]:  # 12: no cycle has been found meanwhile
                vectors[method][gid] = math.fsum(vectors[subtask][gid] for subtask in subtasks)  # 13, 14, 15
    return max((vectors[method][gid] for method in graph.successors(task)), default=-math.inf)  # 16, 17
