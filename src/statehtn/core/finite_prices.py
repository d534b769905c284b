"""Several prices of every action, each on a scale of its own, and prices that are mixes of them."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import statehtn._relax as _relax
from statehtn.core.grounding import Grounding
from statehtn.core.pricing import PricedProblem, RiskCost
from statehtn.core.scale import BITS, MOST_BITS, MOST_UNITS, Scale

WEIGHT_BITS = 20
"""Significant bits of a weight of a mix: with so few, its products with prices are exact."""
LEAST_WEIGHT = 2.0**-100
"""A weight that is less, where the largest is 1, counts as 0."""
MOST_EXPONENT = 1000
"""Of a unit: the core has it as a float."""
ROUNDING = 2.0**-50
"""Of a sum of positive products in floating point."""


@dataclass(frozen=True, slots=True)
class Mix:
    """Prices that are sums of others, each times its weight.

    Args:
        weights: of the prices, in the units of what they are.
        problem: the mix in those units.
        core_weights: of the prices in whole units, for the mix in whole units: the sum is exact, and then rounded down.
            No plan costs more at the mix than follows from its costs at the others.
        exponent: a unit of the mix is `2**-exponent`.
    """

    weights: tuple[float, ...]
    problem: PricedProblem
    core_weights: tuple[float, ...]
    exponent: int


class FinitePrices:
    """Several vectors of prices of one ground problem, each on its own scale.

    What is made of them is made once for each row of prices that there is: thousands of actions often have a few.

    Args:
        grounding: the ground problem.
        problems: the same problem at each of the prices.
    """

    def __init__(self, grounding: Grounding, problems: Sequence[PricedProblem]) -> None:
        self.grounding = grounding
        self.problems = tuple(problems)
        self.scales = [_moderate(Scale.first(problem.bounds())) for problem in problems]
        numbers: dict[tuple[int, ...], int] = {}
        self._rows: list[tuple[RiskCost, ...]] = []

        def row_of(row: tuple[RiskCost, ...]) -> int:
            number = numbers.setdefault(tuple(map(id, row)), len(self._rows))
            if number == len(self._rows):
                self._rows.append(row)
            return number

        self._actions, self._parts = (
            [row_of(row) for row in zip(*columns, strict=True)]
            for columns in ([problem.actions for problem in problems], [problem.parts for problem in problems])
        )

    @property
    def exponents(self) -> list[int]:
        """By price: a unit is `2**-exponent`."""
        return [scale.exponent for scale in self.scales]

    def handles(self) -> tuple[_relax.PricedProblem, ...]:
        """Return the ground problem at each of the prices, in whole units."""
        return tuple(self._in_core(column) for column in self._units())

    def handle_of(self, mix: Mix) -> _relax.PricedProblem:
        """Return the ground problem at a mix, in whole units."""
        whole_mix = _whole_mix(mix.core_weights)
        return self._in_core([min(whole_mix(*row), MOST_UNITS) for row in zip(*self._units(), strict=True)])

    def fit(self, sums: Sequence[float]) -> bool:
        """Take the scales on which sums of this size have `BITS` bits; returns false if these are the present ones."""
        fitting = [
            Scale(min(BITS - math.frexp(size)[1], MOST_EXPONENT), 1 << MOST_BITS) if size > 0 else scale
            for size, scale in zip(sums, self.scales, strict=True)
        ]
        is_other = fitting != self.scales
        self.scales = fitting
        return is_other

    def units(self, price: int, cost: float) -> int:
        """Return a cost at one of the prices in whole units, rounded down; at most what the core can hold."""
        return in_units(cost, self.scales[price].exponent)

    def point(self, trace: _relax.SearchResult) -> list[float]:
        """Return what a plan costs at each of the prices."""
        return [problem.of_plan(trace).cost for problem in self.problems]

    def mix(self, weights: Sequence[float]) -> Mix:
        """Return the mix of the prices with these weights, at least 0 and not all 0, up to a factor and rounding."""
        largest = max(weights)
        weights = tuple(_few_bits(weight / largest) for weight in weights)
        mixed = [_mixed_price(weights, row) for row in self._rows]
        problem = PricedProblem(
            self.grounding, [mixed[number] for number in self._actions], [mixed[number] for number in self._parts]
        )
        exponent = _moderate(Scale.first(price.bound for price in mixed)).exponent
        core_weights = tuple(
            math.ldexp(weight, exponent - other) for weight, other in zip(weights, self.exponents, strict=True)
        )
        return Mix(weights, problem, core_weights, exponent)

    def _units(self) -> list[list[int]]:
        """Return the prices of each row in whole units, by price."""
        columns = zip(*self._rows, strict=True) if self._rows else [()] * len(self.scales)
        return [
            scale.units(price.bound for price in column) for scale, column in zip(self.scales, columns, strict=True)
        ]

    def _in_core(self, units: Sequence[int]) -> _relax.PricedProblem:
        actions, parts = ([units[number] for number in numbers] for numbers in (self._actions, self._parts))
        return _relax.PricedProblem(self.grounding.handle, actions, parts)


def in_units(cost: float, exponent: int) -> int:
    """Return a cost in whole units of `2**-exponent`, rounded down; at most what the core can hold."""
    return math.floor(min(math.ldexp(cost, min(exponent, 1000 - math.frexp(cost)[1])), float(MOST_UNITS // 2)))


def _moderate(scale: Scale) -> Scale:
    return Scale(min(scale.exponent, MOST_EXPONENT), scale.cap)


def _few_bits(weight: float) -> float:
    """Return a weight of at most 1 with few significant bits."""
    mantissa, exponent = math.frexp(weight)
    return (
        0.0 if weight < LEAST_WEIGHT else math.ldexp(round(math.ldexp(mantissa, WEIGHT_BITS)), exponent - WEIGHT_BITS)
    )


def _mixed_price(weights: Sequence[float], row: Sequence[RiskCost]) -> RiskCost:
    cost = math.fsum(weight * price.cost for weight, price in zip(weights, row, strict=True))
    bound = math.fsum(weight * price.bound for weight, price in zip(weights, row, strict=True))
    return RiskCost(cost, bound - ROUNDING * bound)


def _whole_mix(weights: Sequence[float]) -> Callable[..., int]:
    """Return what adds up whole numbers, each times its weight, and rounds the exact sum down."""
    ratios = [weight.as_integer_ratio() for weight in weights]
    denominator = max(down for _, down in ratios)  # powers of two, of which the largest is a multiple of all
    factors = [up * (denominator // down) for up, down in ratios]
    return lambda *row: sum(factor * units for factor, units in zip(factors, row, strict=True)) // denominator
