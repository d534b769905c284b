"""The paper's Algorithms 1 and 2 as they are printed: the preprocessing of the plan-based solver.

Slow on purpose, and wrong on cyclic graphs in ways that `docs/paper-map.md` explains: the core computes what they are
after by other means (`values.least_risk_costs` does so readably). Line numbers are the paper's.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import TYPE_CHECKING

from statehtn.decomposition.graphs import Kind
from statehtn.decomposition.values import least_price, paper_unit
from statehtn.risk import Utility

if TYPE_CHECKING:
    import networkx as nx

Vector = dict[int, float]
"""The expected utilities of a node by `gid`, the number of the root from which they were computed."""


def compute_utilities(
    graph: nx.MultiDiGraph[str], utility: Utility, *, as_printed: bool = True
) -> Mapping[str, Vector]:
    """Return the vector of expected utilities of every task and method (Algorithm 1).

    Values are the paper's (equation 10, as `paper_value` has it): not positive, and the greater, the better. A value
    that was not computed for some root is missing, where the paper has plus infinity. Primitive tasks have theirs at
    root 0.

    Args:
        graph: as `ground_task_decomposition_graph` returns it.
        utility: the agent's.
        as_printed: whether Algorithm 2 goes on after line 5, as it is printed; False: it returns there, which the
            paper's own example of two cycles takes for granted.
    """
    vectors: dict[str, Vector] = {node: {} for node in graph}
    for node in graph:
        if "law" in graph.nodes[node]:
            vectors[node][0] = -least_price(graph, node, utility) * paper_unit(utility)  # lines 1 to 5
    compound = [node for node, kind in graph.nodes.data("kind") if kind is Kind.COMPOUND]
    for gid, task in enumerate(compound, 1):  # lines 9 to 13
        vectors[task][gid] = _compute_task_eu(graph, vectors, task, [], None, gid, as_printed)
    return vectors


def _compute_task_eu(
    graph: nx.MultiDiGraph[str],
    vectors: dict[str, Vector],
    task: str,
    path: list[str],
    last_method: str | None,
    gid: int,
    as_printed: bool,
) -> float:
    """Return the expected utility of a task below the tasks of a decomposition path (`ComputeTaskEU`, Algorithm 2).

    Args:
        graph: the ground graph.
        vectors: of all nodes; filled in on the way.
        task: the task in question.
        path: the tasks on the way from the root.
        last_method: the method by which the path came here.
        gid: the number of the root.
        as_printed: see `compute_utilities`.
    """
    if graph.nodes[task]["kind"] is Kind.PRIMITIVE:
        return vectors[task][0]  # lines 2 and 3
    if task in path:
        assert last_method is not None
        vectors[last_method][gid] = -math.inf  # lines 4 and 5
        if not as_printed:
            return -math.inf
    for method in graph.successors(task):  # line 6
        if gid in vectors[method]:  # line 7: not plus infinity any more
            continue
        subtasks = [subtask for _, subtask in graph.out_edges(method)]  # with repetitions
        for subtask in subtasks:  # lines 8 to 11
            value = _compute_task_eu(graph, vectors, subtask, [*path, task], method, gid, as_printed)
            if graph.nodes[subtask]["kind"] is Kind.COMPOUND:
                vectors[subtask][gid] = value
        if gid not in vectors[method]:  # line 12: no cycle has been found meanwhile
            vectors[method][gid] = math.fsum(_value_at(graph, vectors, subtask, gid) for subtask in subtasks)
    return max((vectors[method][gid] for method in graph.successors(task)), default=-math.inf)  # lines 16 and 17


def _value_at(graph: nx.MultiDiGraph[str], vectors: dict[str, Vector], task: str, gid: int) -> float:
    return vectors[task][0 if graph.nodes[task]["kind"] is Kind.PRIMITIVE else gid]
