"""The strongly connected components of a policy: what loops, and in which order values follow from each other."""

from __future__ import annotations

from collections.abc import Callable, Iterable

Successors = Callable[[int], Iterable[int]]


def components(count: int, successors: Successors) -> list[list[int]]:
    """Return the strongly connected components of a graph, each after all that it leads to.

    Tarjan's algorithm (1972) without recursion; networkx would need a gigabyte for the graph of a large policy.

    Args:
        count: nodes are numbered from 0.
        successors: the nodes that one leads to.
    """
    index: list[int] = [-1] * count  # in the order of the search; -1 where it has not been
    low: list[int] = [0] * count
    is_open = bytearray(count)  # on the stack of nodes without a component
    found: list[list[int]] = []
    stack: list[int] = []
    visited = 0
    for root in range(count):
        if index[root] >= 0:
            continue
        pending = [(root, iter(successors(root)))]
        index[root] = low[root] = visited
        visited += 1
        stack.append(root)
        is_open[root] = True
        while pending:
            node, others = pending[-1]
            for other in others:
                if index[other] < 0:
                    index[other] = low[other] = visited
                    visited += 1
                    stack.append(other)
                    is_open[other] = True
                    pending.append((other, iter(successors(other))))
                    break
                if is_open[other]:
                    low[node] = min(low[node], index[other])
            else:
                pending.pop()
                if pending:
                    parent = pending[-1][0]
                    low[parent] = min(low[parent], low[node])
                if low[node] == index[node]:
                    place = len(stack) - 1
                    while stack[place] != node:
                        place -= 1
                    found.append(stack[place:])
                    for member in found[-1]:
                        is_open[member] = False
                    del stack[place:]
    return found
