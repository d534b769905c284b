"""The least and the largest cost that a run of a policy may have, without a list of all."""

from __future__ import annotations

import heapq
import math

from statehtn.model.cost.by_law import by_law
from statehtn.model.policy_graph import End
from statehtn.policies.chain import Chain


def least_cost(chain: Chain, failure: float) -> float:
    """Return the least cost of a run that ends, by Dijkstra's algorithm (1959); infinite where none does.

    Args:
        failure: what a run pays that fails, on top of what it has spent; may be infinite.
    """
    flat = chain.flat
    steps = by_law(flat.laws, lambda law: law.least)
    known = [math.inf] * len(flat)
    known[0], found, queue = 0.0, math.inf, [(0.0, 0)]
    while queue and queue[0][0] < found:
        spent, node = heapq.heappop(queue)
        if spent > known[node]:
            continue
        if flat.ends[node] is not None or chain.stuck[node]:
            found = min(found, spent if flat.ends[node] is End.DONE else spent + failure)
        for branch in flat.branches(node):
            other = flat.successors[branch]
            if spent + steps[branch] < known[other]:
                known[other] = spent + steps[branch]
                heapq.heappush(queue, (known[other], other))
    return found


def largest_cost(chain: Chain, failure: float) -> float:
    """Return the largest cost of a run; infinite where a loop may cost something again and again.

    Args:
        failure: as above.
    """
    flat = chain.flat
    steps = by_law(flat.laws, lambda law: law.most)
    values = [0.0] * len(flat)
    for component in chain.order:
        inside = set(component)
        node = component[0]
        if flat.ends[node] is not None:
            values[node] = 0.0 if flat.ends[node] is End.DONE else failure
            continue
        branches = [branch for node in component for branch in flat.branches(node)]
        is_paid = any(steps[branch] > 0 for branch in branches if flat.successors[branch] in inside)
        leaving = [steps[b] + values[other] for b in branches if (other := flat.successors[b]) not in inside]
        largest = math.inf if is_paid else max(leaving, default=0.0)
        if chain.endless[node]:
            largest = max(largest, failure)
        for member in component:
            values[member] = largest
    return values[0]
