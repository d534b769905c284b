"""Laws of costs in exact arithmetic: costs and probabilities are fractions, sums are convolutions.

Nothing here is shared with the planner: this is the judge of its laws.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from fractions import Fraction
from functools import cached_property

UNIT = 10**6
"""Costs are whole multiples of 1/UNIT."""
Weights = tuple[tuple[int, int], ...]


class Law:
    """The law of a cost. `Laws` makes each one once, so equal ones are identical.

    It is kept in whole numbers, which is faster than fractions: costs in units, in rising order, each with the
    multiple of `1 / whole` that is its probability, which is not 0.
    """

    def __init__(self, number: int, weights: Weights, whole: int) -> None:
        self.number = number
        self.weights = weights
        self.whole = whole
        self.least = Fraction(weights[0][0], UNIT)
        self.most = Fraction(weights[-1][0], UNIT)
        self.mean = Fraction(sum(cost * weight for cost, weight in weights), whole * UNIT)

    def __repr__(self) -> str:
        return "{" + ", ".join(f"{cost}: {probability}" for cost, probability in self.outcomes) + "}"

    @cached_property
    def outcomes(self) -> list[tuple[Fraction, Fraction]]:
        """Costs in rising order, each with its probability."""
        return [(Fraction(cost, UNIT), Fraction(weight, self.whole)) for cost, weight in self.weights]

    @cached_property
    def in_floats(self) -> list[tuple[float, float]]:
        """The outcomes, nearly."""
        return [(cost / UNIT, weight / self.whole) for cost, weight in self.weights]

    def at_most(self, budget: Fraction) -> Fraction:
        """The probability of paying at most this."""
        return Fraction(sum(weight for cost, weight in self.weights if cost <= budget * UNIT), self.whole)


class Laws:
    """The laws of one problem, and their sums, each kept once."""

    def __init__(self) -> None:
        self.known: dict[tuple[Weights, int], Law] = {}
        self.sums: dict[tuple[int, int], Law] = {}
        self.zero = self.of({Fraction(0): Fraction(1)})

    def of(self, probabilities: Mapping[Fraction, Fraction]) -> Law:
        """The law with these probabilities of costs, which add up to 1."""
        assert sum(probabilities.values()) == 1, probabilities
        assert all((cost * UNIT).denominator == 1 for cost in probabilities), probabilities
        whole = math.lcm(*(p.denominator for p in probabilities.values()))
        return self.kept({int(cost * UNIT): int(p * whole) for cost, p in probabilities.items()}, whole)

    def sum(self, one: Law, other: Law) -> Law:
        """The law of the sum of two independent costs."""
        key = (min(one.number, other.number), max(one.number, other.number))
        if key not in self.sums:
            total: dict[int, int] = {}
            for cost, weight in one.weights:
                for more, factor in other.weights:
                    total[cost + more] = total.get(cost + more, 0) + weight * factor
            self.sums[key] = self.kept(total, one.whole * other.whole)
        return self.sums[key]

    def kept(self, weights: Mapping[int, int], whole: int) -> Law:
        divisor = math.gcd(whole, *weights.values())
        reduced = tuple(sorted((cost, weight // divisor) for cost, weight in weights.items() if weight))
        key = (reduced, whole // divisor)
        if key not in self.known:
            self.known[key] = Law(len(self.known), *key)
        return self.known[key]
