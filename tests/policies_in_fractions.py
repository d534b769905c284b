"""Decision graphs given as a whole, and their best policies by enumeration, in fractions.

What a step multiplies e^(alpha cost) by is a fraction, too: e^alpha is one, and costs are whole numbers.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction

import statehtn._relax as _relax

TERMS = ("line", "rising", "falling")
SHIFT = Fraction(1, 3)
Outcomes = tuple[tuple[int, Fraction, int], ...]
"""Of a decision: successor, probability, cost."""


@dataclass(frozen=True)
class Graph:
    """Nodes of which each is done or has decisions; node 0 is the root."""

    done: tuple[bool, ...]
    decisions: tuple[tuple[Outcomes, ...], ...]


@dataclass(frozen=True)
class Agent:
    """How costs are valued: by their mean, by the mean of base^cost or base^-cost, or by that of a term of a sum.

    A term is SHIFT + base^cost - 1 (`rising`), SHIFT + 1 - base^-cost (`falling`), or SHIFT + cost (`line`): what is
    carried over of a cost and what follows is neither a sum nor a product.
    """

    kind: str
    base: Fraction = Fraction(2)

    @property
    def is_exponential(self) -> bool:
        return self.kind in ("averse", "seeking", *TERMS)

    def factor(self, cost: int) -> Fraction:
        """Return what a cost multiplies the exponential by."""
        if self.kind == "line":
            return Fraction(1)
        return self.base**cost if self.kind in ("averse", "rising") else self.base**-cost

    def grown(self, cost: int) -> Fraction:
        """Return a term of a cost, without SHIFT."""
        return Fraction(cost) if self.kind == "line" else abs(self.factor(cost) - 1)

    def carried(self, cost: int) -> Fraction:
        """Return what is carried over of a certain cost."""
        if self.kind in TERMS:
            return SHIFT + self.grown(cost)
        return self.factor(cost) if self.is_exponential else Fraction(cost)

    def added(self, cost: int) -> Fraction:
        """Return what a step of this cost adds: of `SHIFT + g(c + x) = added + factor (SHIFT + g(x))`."""
        if self.kind in TERMS:
            return self.carried(cost) - self.factor(cost) * SHIFT
        return Fraction(0) if self.is_exponential or self.kind == "success" else Fraction(cost)

    def worth(self, carried: Fraction | None) -> float:
        """Return the worth that the core minimises; infinite for none."""
        if carried is None:
            return math.inf
        if not self.is_exponential:
            return float(carried)
        logarithm = math.log(carried.numerator) - math.log(carried.denominator)
        return -logarithm if self.kind == "seeking" else logarithm

    def is_better(self, one: Fraction | None, other: Fraction | None) -> bool:
        """Tell whether one is better than the other; None is the worst."""
        if one is None or other is None:
            return other is None and one is not None
        return one > other if self.kind == "seeking" else one < other


Policy = Sequence[int | None]
"""By node: the index of a decision, or None to stop."""


def policies(graph: Graph) -> Iterator[Policy]:
    """Yield all policies."""
    return itertools.product(*([None, *range(len(choices))] for choices in graph.decisions))


def evaluate(graph: Graph, policy: Policy, agent: Agent, stop: int | None) -> list[Fraction | None]:
    """Return what a policy carries over from every node; None where it is not proper, or not finite.

    Args:
        stop: what it costs to stop where nothing is done; None where that is not allowed.
    """
    size = len(graph.done)
    chosen: list[Outcomes | None] = [
        None if graph.done[node] or choice is None else graph.decisions[node][choice]
        for node, choice in enumerate(policy)
    ]
    ends = {node for node in range(size) if chosen[node] is None and (graph.done[node] or stop is not None)}
    reaching = _before(chosen, ends)
    failing = _before(chosen, set(range(size)) - reaching)
    found: list[Fraction | None] = [None] * size
    for node in ends:
        found[node] = agent.carried(0) if graph.done[node] else agent.carried(stop or 0)
    for component in _components(chosen):
        if any(node in failing or node in ends for node in component):
            continue
        values = _solve(component, chosen, agent, found)
        for node in component:
            found[node] = None if values is None else values[node]
    return found


def best(graph: Graph, agent: Agent, stop: int | None) -> list[Fraction | None]:
    """Return what the best policies carry over from every node."""
    found: list[Fraction | None] = [None] * len(graph.done)
    for policy in policies(graph):
        for node, value in enumerate(evaluate(graph, policy, agent, stop)):
            if agent.is_better(value, found[node]):
                found[node] = value
    return found


def _before(chosen: Sequence[Outcomes | None], ends: set[int]) -> set[int]:
    """Return the nodes from which some of these can be reached."""
    found = set(ends)
    while True:
        more = {
            node
            for node, outcomes in enumerate(chosen)
            if node not in found and outcomes is not None and any(to in found for to, _, _ in outcomes)
        }
        if not more:
            return found
        found |= more


def _components(chosen: Sequence[Outcomes | None]) -> list[list[int]]:
    """Return the strongly connected components, each after those that it leads to."""
    reached = [{to for to in range(len(chosen)) if node in _before(chosen, {to})} for node in range(len(chosen))]
    together: dict[int, list[int]] = {}
    for node in range(len(chosen)):
        together.setdefault(min(other for other in reached[node] if node in reached[other]), []).append(node)
    return sorted(together.values(), key=lambda component: len(reached[component[0]]))


def _solve(
    component: Sequence[int], chosen: Sequence[Outcomes | None], agent: Agent, known: Sequence[Fraction | None]
) -> Mapping[int, Fraction] | None:
    """Solve the equations of a component; None where what leaves it is not finite, or the radius is at least 1."""
    rows: dict[int, dict[int, Fraction]] = {}
    rest: dict[int, Fraction] = {}
    for node in component:
        row = {to: Fraction(0) for to in component}
        constant = Fraction(0)
        for to, probability, cost in chosen[node] or ():
            weight = probability * (agent.factor(cost) if agent.is_exponential else 1)
            constant += probability * agent.added(cost)
            value = known[to]
            if to in row:
                row[to] += weight
            elif value is None:
                return None
            else:
                constant += weight * value
        rows[node], rest[node] = row, constant
    return _eliminate(component, rows, rest)


def _eliminate(
    order: Sequence[int], rows: dict[int, dict[int, Fraction]], rest: dict[int, Fraction]
) -> Mapping[int, Fraction] | None:
    """Solve x = M x + b; None where the sum of the powers of M has no end: a pivot is not positive."""
    for index, node in enumerate(order):
        pivot = 1 - rows[node][node]
        if pivot <= 0:
            return None
        for later in order[index + 1 :]:
            factor = rows[later][node] / pivot
            for to in order[index + 1 :]:
                rows[later][to] += factor * rows[node][to]
            rest[later] += factor * rest[node]
    found: dict[int, Fraction] = {}
    for index in reversed(range(len(order))):
        node = order[index]
        total = rest[node] + sum((rows[node][to] * found[to] for to in order[index + 1 :]), Fraction(0))
        found[node] = total / (1 - rows[node][node])
    return found


RECURSIONS = {
    "neutral": _relax.Recursion.Expected,
    "success": _relax.Recursion.Expected,
    "averse": _relax.Recursion.Averse,
    "seeking": _relax.Recursion.Seeking,
    **dict.fromkeys(TERMS, _relax.Recursion.LogExpected),
}


def core_nodes(
    graph: Graph, agent: Agent, stop: int | None, lower: Sequence[float]
) -> list[tuple[bool, float, float, float, list[tuple[float, float, list[tuple[int, float]]]]]]:
    """Return the graph as `_relax.solve_decision_graph` takes it.

    Args:
        lower: by node, what it is worth at least.
    """
    nodes = []
    for node, is_done in enumerate(graph.done):
        decisions = []
        for outcomes in graph.decisions[node]:
            mean = float(sum((p * cost for _, p, cost in outcomes), Fraction(0)))
            added = sum((p * agent.added(cost) for _, p, cost in outcomes), Fraction(0))
            constant = float(added) if agent.kind not in TERMS else math.log(added) if added else -math.inf
            weights = [
                (to, math.log(p) + math.log(agent.factor(cost)) if agent.is_exponential else float(p))
                for to, p, cost in outcomes
            ]
            decisions.append((constant, mean, weights))
        done = agent.worth(agent.carried(0))
        worth = done if is_done else math.inf if stop is None else agent.worth(agent.carried(stop))
        nodes.append((is_done, done, lower[node], worth, decisions))
    return nodes
