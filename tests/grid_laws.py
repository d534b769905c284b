"""Laws on a grid as fractions, and random ones: the judge of the core's laws."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from fractions import Fraction

from hypothesis import strategies as st

import statehtn._relax as _relax
from tests.strategies import pick

Law = dict[int, Fraction]
FREE: Law = {0: Fraction(1)}
WEIGHTS = (1, 1, 2, 3, 7, 90, 899)


def summed(*laws: Law) -> Law:
    """The law of a sum of independent costs."""
    total = FREE
    for law in laws:
        found: Law = {}
        for cost, p in total.items():
            for other, q in law.items():
                found[cost + other] = found.get(cost + other, Fraction(0)) + p * q
        total = found
    return total


def shifted(law: Law, more: int) -> Law:
    return {cost + more: p for cost, p in law.items()}


def mean(law: Law) -> Fraction:
    return sum((cost * p for cost, p in law.items()), Fraction(0))


def above(law: Law, cost: Fraction | int) -> Fraction:
    return sum((p for at, p in law.items() if at > cost), Fraction(0))


def excess(law: Law, cost: Fraction | int) -> Fraction:
    return sum((p * (at - cost) for at, p in law.items() if at > cost), Fraction(0))


def quantile(law: Law, level: Fraction) -> int:
    """To 1e-12 of the level."""
    return next(cost for cost in sorted(law) if above(law, cost) <= 1 - level + Fraction(1, 10**12))


def cvar(law: Law, level: Fraction) -> Fraction:
    return min(cost + excess(law, cost) / (1 - level) for cost in law)


def add(table: _relax.LawTable, law: Law) -> int:
    """Put a law into a table of the core."""
    at = sorted(law)
    return table.add([float(cost) for cost in at], [float(law[cost]) for cost in at])


@st.composite
def laws(draw: st.DrawFn, most: int = 12, outcomes: int = 4) -> Law:
    """A law of few outcomes; certain ones are the simplest."""
    costs = draw(st.lists(st.integers(0, most), min_size=1, max_size=outcomes, unique=True))
    weights = [pick(draw, WEIGHTS) for _ in costs]
    return {cost: Fraction(weight, sum(weights)) for cost, weight in zip(costs, weights, strict=True)}


def mixtures(laws_: Sequence[Law], weights: Iterable[Fraction]) -> Law:
    """The law of a cost that has one of these laws, by chance."""
    found: Law = {}
    for law, weight in zip(laws_, weights, strict=True):
        for cost, p in law.items():
            found[cost] = found.get(cost, Fraction(0)) + weight * p
    return found
