"""The strongly connected components of a policy: what loops, and in which order values follow from each other."""

from __future__ import annotations

from collections.abc import Sequence


def components(first: Sequence[int], successors: Sequence[int]) -> list[list[int]]:
    """Return the strongly connected components of a graph, each after all that it leads to.

    Tarjan's algorithm (1972) without recursion; networkx would need a gigabyte for the graph of a large policy.

    Args:
        first: for each node the index of its first successor, and at the end the number of all.
        successors: of all nodes, one node's after the other's.
    """
    count = len(first) - 1
    index = [-1] * count  # in the order of the search; -1 where it has not been
    low = [0] * count
    is_open = bytearray(count)  # on the stack of nodes without a component
    place = list(first[:count])  # of the next successor to look at
    found: list[list[int]] = []
    stack: list[int] = []
    visited = 0
    for root in range(count):
        if index[root] >= 0:
            continue
        path = [root]
        index[root] = low[root] = visited
        visited += 1
        stack.append(root)
        is_open[root] = True
        while path:
            node = path[-1]
            at, end = place[node], first[node + 1]
            while at < end:
                other = successors[at]
                at += 1
                if index[other] < 0:
                    place[node] = at
                    index[other] = low[other] = visited
                    visited += 1
                    stack.append(other)
                    is_open[other] = True
                    path.append(other)
                    break
                if is_open[other] and index[other] < low[node]:
                    low[node] = index[other]
            else:
                path.pop()
                if path and low[node] < low[path[-1]]:
                    low[path[-1]] = low[node]
                if low[node] == index[node]:
                    found.append(_taken_off(stack, node))
                    for member in found[-1]:
                        is_open[member] = False
    return found


def _taken_off(stack: list[int], node: int) -> list[int]:
    """Take the stack's end from a node on off it."""
    if stack[-1] == node:
        return [stack.pop()]
    place = len(stack) - 1
    while stack[place] != node:
        place -= 1
    taken = stack[place:]
    del stack[place:]
    return taken
