"""Cycles in hierarchies and orderings."""

from __future__ import annotations

from collections.abc import Hashable, Mapping, Sequence
from typing import TypeVar

T = TypeVar("T", bound=Hashable)


def find_cycle(successors: Mapping[T, Sequence[T]]) -> list[T]:
    """Return nodes that each have the next one as a successor, the last being the first again; empty without a cycle.

    Depth-first search with its own stack, in time linear in the size of the graph.
    """
    done: set[T] = set()
    for root in successors:
        path: dict[T, None] = {}
        stack = [] if root in done else [(root, iter(successors[root]))]
        while stack:
            node, remaining = stack[-1]
            path[node] = None
            for following in remaining:
                if following in path:
                    nodes = list(path)
                    return [*nodes[nodes.index(following) :], following]
                if following not in done:
                    stack.append((following, iter(successors.get(following, ()))))
                    break
            else:
                stack.pop()
                del path[node]
                done.add(node)
    return []
