"""Which nodes of a policy are alike: the same actions follow from them, on the same conditions."""

from __future__ import annotations

import itertools
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from statehtn.display.policy_words import Changes
from statehtn.model.policy_graph import Branch, PolicyGraph
from statehtn.policies.components import components

MOST_IN_LOOPS = 200
"""Classes of nodes that lead to each other; larger loops are not compared with others."""


@dataclass(frozen=True, slots=True)
class Way:
    """A branch of an action, the next action or end after it, and what is spent then, where that matters."""

    branch: Branch
    target: int
    spent: float | None


Ways = Mapping[int, Sequence[Way]]
"""For each node at which an action is executed, or a run ends, its branches."""


def classes_of(graph: PolicyGraph, ways: Ways, by_cost: bool) -> dict[int, int]:
    """Return a number for each node, the same for nodes that are alike.

    Nodes that lead to each other are told apart until nothing changes; others follow from what they lead to.

    Args:
        graph: the policy.
        ways: its branches.
        by_cost: whether what a branch costs is a part of its condition.
    """
    nodes = list(ways)
    index = {node: place for place, node in enumerate(nodes)}
    found: dict[int, int] = {}
    numbers: dict[object, int] = {}
    first = [0, *itertools.accumulate(len(ways[node]) for node in nodes)]
    order = components(first, [index[way.target] for node in nodes for way in ways[node]])
    for component in order:
        group = [nodes[place] for place in component]
        keys = _told_apart(graph, ways, group, found, by_cost)
        is_loop = len(group) > 1 or any(way.target == group[0] for way in ways[group[0]])
        if is_loop:
            keys = _keys_of_loop(graph, ways, group, found, by_cost)
        for node, key in keys.items():
            found[node] = numbers.setdefault(key, len(numbers))
        for node in group if is_loop else ():  # what leads into the loop may be as one of its nodes is
            numbers.setdefault(_key(graph, ways, node, found, by_cost), found[node])
    return found


def _told_apart(
    graph: PolicyGraph, ways: Ways, group: Sequence[int], classes: dict[int, int], by_cost: bool
) -> dict[int, object]:
    """Return what tells the nodes of a group apart; their classes are numbered below 0 meanwhile."""
    classes.update(dict.fromkeys(group, -1))
    count = 0
    while True:
        keys = {node: _key(graph, ways, node, classes, by_cost) for node in group}
        if len(set(keys.values())) == count or len(group) == 1:
            return keys
        count = len(set(keys.values()))
        local = {key: -1 - place for place, key in enumerate(dict.fromkeys(keys.values()))}
        classes.update({node: local[key] for node, key in keys.items()})


def _keys_of_loop(
    graph: PolicyGraph, ways: Ways, group: Sequence[int], classes: dict[int, int], by_cost: bool
) -> dict[int, object]:
    """Return keys of nodes that lead to each other in which their classes have no numbers of their own.

    A key lists the classes of the group in the order in which a search in breadth from the node comes to them, so that
    equal loops have equal keys wherever they stand.
    """
    members = {classes[node]: node for node in group}
    if len(members) > MOST_IN_LOOPS:
        return {node: (group[0], classes[node]) for node in group}
    by_class = {name: _listed(graph, ways, name, members, classes, by_cost) for name in members}
    return {node: by_class[classes[node]] for node in group}


def _listed(
    graph: PolicyGraph, ways: Ways, start: int, members: dict[int, int], classes: dict[int, int], by_cost: bool
) -> object:
    order, queue = {start: 0}, [start]
    rows: list[object] = []
    for name in queue:
        node = members[name]
        targets: list[object] = []
        for way in sorted(ways[node], key=_in_order):
            other = classes[way.target]
            if other in members and other not in order:
                order[other] = len(order)
                queue.append(other)
            mark = _mark(way, by_cost)
            targets.append((mark, "inside", order[other]) if other in members else (mark, "outside", other))
        rows.append((_static(graph, ways, node), tuple(targets)))
    return tuple(rows)


def _in_order(way: Way) -> tuple[list[object], list[object], float]:
    return sorted(way.branch.added), sorted(way.branch.deleted), way.spent or 0.0  # type: ignore[return-value]


def _mark(way: Way, by_cost: bool) -> object:
    return way.branch.added, way.branch.deleted, str(way.branch.law) if by_cost else ""


def _key(graph: PolicyGraph, ways: Ways, node: int, classes: dict[int, int], by_cost: bool) -> object:
    """Return what tells a node from others, as far as classes of its successors are known."""
    leads = frozenset((_mark(way, by_cost), classes[way.target]) for way in ways[node])
    return _static(graph, ways, node), leads


def _static(graph: PolicyGraph, ways: Ways, node: int) -> object:
    """Return what a node says by itself: its action, and how likely and how costly each outcome is."""
    here = graph.nodes[node]
    step = None if here.decision is None else here.decision.action
    outcomes: dict[Changes, list[tuple[float, float]]] = {}
    for way in ways[node]:
        pair = way.branch.probability, way.branch.probability * way.branch.law.mean
        outcomes.setdefault((way.branch.added, way.branch.deleted), []).append(pair)
    sums = ((changes, *(math.fsum(parts) for parts in zip(*pairs, strict=True))) for changes, pairs in outcomes.items())
    return step, here.end, frozenset((changes, f"{p:.9g}", f"{cost:.9g}") for changes, p, cost in sums)
