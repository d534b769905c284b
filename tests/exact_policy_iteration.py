"""Policy iteration in exact arithmetic, for values that are compared in order: the first, then the second.

A node's value under a choice is, in each of its two parts, a constant plus the weighted values of its successors. The
least values are wanted, the first part before the second. The agent's choices must begin with one that leads nowhere
(giving up), so that there is a policy to start with: choices change only where that is strictly better, and then no
policy runs in a circle for ever, unless the first one does (see `best`).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from decimal import Decimal
from fractions import Fraction
from typing import TypeVar

import networkx

from tests.brute_force import GaveUp

Exact = Fraction | Decimal
Pair = tuple[Exact, Exact]
LARGEST_CIRCLE = 60  # nodes that all lead to each other: fractions grow as equations are solved
EQUAL = Decimal("1e-35")  # decimals that differ by less, relatively, are rounded versions of one number

Number = TypeVar("Number", Fraction, Decimal)


class InfiniteCircle(Exception):
    """The nodes of a circle, as the policy goes through it, are worth infinitely much: its radius is 1 or more.

    Of all policies the best one is never like that, since giving up is one of them; a policy that is given may be.
    """


@dataclass(frozen=True)
class Choice:
    """A constant pair, and the successors with the weights of both parts of their values."""

    constant: Pair
    weights: tuple[tuple[int, Exact, Exact], ...] = ()

    def value(self, values: Sequence[Pair | None]) -> Pair:
        first, second = self.constant
        for successor, one, two in self.weights:
            known = values[successor]
            assert known is not None
            first += one * known[0]  # type: ignore[operator]
            second += two * known[1]  # type: ignore[operator]
        return first, second

    def successors(self) -> list[int]:
        return [successor for successor, one, two in self.weights if one or two]


def circles_of(choices: Sequence[Sequence[Choice]]) -> list[list[int]]:
    """The nodes that lead to each other, together; those that they lead to before them."""
    graph = networkx.DiGraph()
    graph.add_nodes_from(range(len(choices)))
    graph.add_edges_from((i, j) for i, node in enumerate(choices) for choice in node for j in choice.successors())
    return [sorted(circle) for circle in networkx.strongly_connected_components(graph)]  # in the order of leaving them


def best(
    choices: Sequence[Sequence[Choice]], circles: Sequence[Sequence[int]] | None = None
) -> tuple[list[Pair], list[int]]:
    """The least values, and the choice that each node takes.

    `circles` are those of `circles_of`, where they are known.

    Every node's choice 0 has no weights. Why this ends at the least values: take the policy in hand, whose values v
    are finite, and switch some nodes to choices that are strictly better at v. Were there a closed circle of nodes in
    the new policy whose weights have spectral radius 1, then v would be the same there before and after a step on
    average, so that no node of it has switched: the old policy would have had the circle, too. So all policies in
    turn have finite values, each less than the one before, and there are finitely many. In the end v is what every
    node's best choice makes of v, so that no policy is better.

    Nodes that lead to each other are worked on together, those that they lead to before them.
    """
    values: list[Pair | None] = [None] * len(choices)
    policy = [0] * len(choices)
    for circle in circles_of(choices) if circles is None else circles:
        if len(circle) == 1 and all(circle[0] not in choice.successors() for choice in choices[circle[0]]):
            take_least(choices[circle[0]], policy, values, circle[0])
        else:
            improve(choices, policy, values, circle)
    return [value for value in values if value is not None], policy


def take_least(choices: Sequence[Choice], policy: list[int], values: list[Pair | None], node: int) -> None:
    """Decide in a node that does not lead back to itself."""
    least = choices[0].value(values)
    for number, choice in enumerate(choices[1:], 1):
        value = choice.value(values)
        if is_less(value, least):
            policy[node], least = number, value
    values[node] = least


def improve(
    choices: Sequence[Sequence[Choice]], policy: list[int], values: list[Pair | None], nodes: Sequence[int]
) -> None:
    while True:
        evaluate(choices, policy, values, nodes)
        changed = False
        for node in nodes:
            least = values[node]
            assert least is not None
            for number, choice in enumerate(choices[node]):
                value = choice.value(values)
                if is_less(value, least):
                    policy[node], least, changed = number, value, True
        if not changed:
            return


def evaluate(
    choices: Sequence[Sequence[Choice]], policy: Sequence[int], values: list[Pair | None], nodes: Sequence[int]
) -> None:
    """Find the values of nodes under a policy, where those of all other nodes that it leads to are known."""
    graph = networkx.DiGraph()
    graph.add_nodes_from(nodes)
    inside = set(nodes)
    for node in nodes:
        values[node] = None
    taken = {node: choices[node][policy[node]] for node in nodes}
    graph.add_edges_from((node, j) for node in nodes for j in taken[node].successors() if j in inside)
    for circle in networkx.strongly_connected_components(graph):
        if len(circle) > LARGEST_CIRCLE:
            raise GaveUp
        ordered = sorted(circle)
        parts = []
        for part in (0, 1):
            rows = [equation(taken[node], part, values, circle) for node in ordered]
            parts.append(solved([constant for constant, _ in rows], [row for _, row in rows], ordered))
        for node, first, second in zip(ordered, *parts, strict=True):
            values[node] = (first, second)


def equation(
    choice: Choice, part: int, values: Sequence[Pair | None], circle: set[int]
) -> tuple[Exact, dict[int, Exact]]:
    """A constant and the weights of the unknowns."""
    constant = choice.constant[part]
    row: dict[int, Exact] = {}
    for successor, *weights in choice.weights:
        if successor in circle:
            row[successor] = row.get(successor, type(constant)(0)) + weights[part]  # type: ignore[operator]
        elif weights[0] or weights[1]:
            known = values[successor]
            assert known is not None
            constant += weights[part] * known[part]  # type: ignore[operator]
    return constant, row


def solved(constants: list[Number], rows: list[dict[int, Number]], unknowns: list[int]) -> list[Number]:
    """Solve x = constant + row x by elimination; I - rows is an M-matrix, for which any order of pivots is stable."""
    constants, rows = list(constants), [dict(row) for row in rows]
    place = {unknown: number for number, unknown in enumerate(unknowns)}
    for number, unknown in enumerate(unknowns):
        own = 1 - rows[number].pop(unknown, type(constants[number])(0))
        if own <= 0:
            raise InfiniteCircle
        constants[number] /= own
        rows[number] = {other: weight / own for other, weight in rows[number].items()}
        for other_number in range(number + 1, len(unknowns)):
            weight = rows[other_number].pop(unknown, None)
            if weight:
                constants[other_number] += weight * constants[number]
                for other, more in rows[number].items():
                    rows[other_number][other] = rows[other_number].get(other, type(more)(0)) + weight * more
    for number in reversed(range(len(unknowns))):
        constants[number] += sum(
            (weight * constants[place[other]] for other, weight in rows[number].items()), type(constants[number])(0)
        )
    return constants


def is_less(one: Pair, other: Pair) -> bool:
    """Compare two pairs, the first parts first."""
    for left, right in zip(one, other, strict=True):
        if isinstance(left, Fraction):
            if left != right:
                return left < right
        elif abs(left - right) > EQUAL * max(abs(left), abs(right)):  # type: ignore[operator]
            return left < right
    return False
