"""What the tasks and methods of a ground decomposition graph are worth to an agent."""

from __future__ import annotations

import heapq
import math
from typing import TYPE_CHECKING

from statehtn.decomposition.graphs import Kind
from statehtn.risk import Utility
from statehtn.risk.cost_shifting import shifted_prices

if TYPE_CHECKING:
    import networkx as nx


def least_price(graph: nx.MultiDiGraph[str], node: str, utility: Utility) -> float:
    """Return a lower bound of the risk cost of a primitive task in any state, exact where it costs the same in all."""
    attributes = graph.nodes[node]
    return shifted_prices(attributes["law"], attributes.get("cost_parts", ()), utility)[0]


def least_risk_costs(graph: nx.MultiDiGraph[str], utility: Utility) -> dict[str, float]:
    """Return for every task and method the least risk cost of its decompositions, states ignored; infinite for none.

    The maximum that the paper's Algorithms 1 and 2 are after, as a cost: the least fixed point, by Knuth's
    generalisation of Dijkstra's algorithm (1977). A task's cost is final when it is the cheapest one that is open.

    Args:
        graph: as `ground_task_decomposition_graph` returns it.
        utility: the agent's.
    """
    costs = dict.fromkeys(graph, math.inf)
    missing = {node: graph.out_degree(node) for node, kind in graph.nodes.data("kind") if kind is Kind.METHOD}
    queue = [(least_price(graph, node, utility), node) for node in graph if "law" in graph.nodes[node]]
    queue += [(0.0, method) for method, count in missing.items() if count == 0]
    heapq.heapify(queue)
    while queue:
        cost, node = heapq.heappop(queue)
        if cost >= costs[node]:
            continue
        costs[node] = cost
        for above in graph.predecessors(node):  # each once, however often the method has the task
            if node in missing:
                heapq.heappush(queue, (cost, above))
                continue
            missing[above] -= graph.number_of_edges(above, node)
            if missing[above] == 0:
                total = math.fsum(costs[subtask] for _, subtask in graph.out_edges(above))
                heapq.heappush(queue, (total, above))
    return costs


def with_values(graph: nx.MultiDiGraph[str], utility: Utility) -> nx.MultiDiGraph[str]:
    """Return a copy of a ground graph whose nodes have the attribute `risk_cost`, see `least_risk_costs`."""
    import networkx as nx

    result = graph.copy()
    nx.set_node_attributes(result, least_risk_costs(graph, utility), "risk_cost")
    return result
