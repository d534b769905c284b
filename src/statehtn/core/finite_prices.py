"""Several prices of every action, each on a scale of its own, and prices that are mixes of them."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from itertools import chain
from typing import TypeVar

import statehtn._relax as _relax
from statehtn.core.grounding import Grounding
from statehtn.core.pricing import PricedProblem, Prices, RiskCost
from statehtn.core.scale import Scale

WEIGHT_BITS = 20
"""Significant bits of a weight of a mix: with so few, its products with prices are exact."""
LEAST_WEIGHT = 2.0**-100
"""A weight that is less, where the largest is 1, counts as 0."""
COARSER_BITS = 10
"""By so many bits a unit is larger on the next scale, where prices went beyond the cap."""
ROUNDING = 2.0**-50
"""Of a sum of positive products in floating point."""

Value = TypeVar("Value")
Result = TypeVar("Result")


@dataclass(frozen=True, slots=True)
class Mix:
    """Prices that are sums of others, each times its weight.

    Args:
        weights: of the prices, in the units of what they are.
        problem: the mix in those units.
        handle: the mix in whole units of the core: the sum of the prices in their units, each times its own of
            `core_weights`, exact and then rounded down. No plan costs more than follows from its costs at the others.
        core_weights: see there.
        exponent: a unit is `2**-exponent`.
    """

    weights: tuple[float, ...]
    problem: PricedProblem
    handle: _relax.PricedProblem
    core_weights: tuple[float, ...]
    exponent: int


class FinitePrices:
    """Several vectors of prices of one ground problem, each on its own scale.

    Args:
        grounding: the ground problem.
        problems: the same problem at each of them.
    """

    def __init__(self, grounding: Grounding, problems: Sequence[PricedProblem]) -> None:
        self.grounding = grounding
        self.problems = tuple(problems)
        self._set_scales([Scale.first(problem.bounds()) for problem in problems])

    @property
    def exponents(self) -> list[int]:
        """By price: a unit is `2**-exponent`."""
        return [prices.scale.exponent for prices in self.prices]

    def coarsen(self) -> bool:
        """Take larger units where prices are beyond the cap; returns false where none are."""
        capped = [any(units > prices.scale.cap for units in _all(prices)) for prices in self.prices]
        if not any(capped):
            return False
        scales = [prices.scale for prices in self.prices]
        self._set_scales(
            [
                Scale(scale.exponent - COARSER_BITS, scale.cap) if is_capped else scale
                for scale, is_capped in zip(scales, capped, strict=True)
            ]
        )
        return True

    def point(self, trace: _relax.SearchResult) -> list[float]:
        """Return what a plan costs at each of the prices."""
        return [problem.of_plan(trace).cost for problem in self.problems]

    def mix(self, weights: Sequence[float]) -> Mix:
        """Return the mix of the prices with these weights, at least 0 and not all 0, up to a factor and rounding."""
        largest = max(weights)
        weights = tuple(_few_bits(weight / largest) for weight in weights)

        def mixed_price(*row: RiskCost) -> RiskCost:
            return _mixed_price(weights, row)

        mixed = PricedProblem(
            self.grounding,
            _mapped(mixed_price, [problem.actions for problem in self.problems]),
            _mapped(mixed_price, [problem.parts for problem in self.problems]),
        )
        exponent = Scale.first(mixed.bounds()).exponent
        core_weights = tuple(
            math.ldexp(weight, exponent - other) for weight, other in zip(weights, self.exponents, strict=True)
        )
        in_units = _whole_mix(core_weights)
        handle = _relax.PricedProblem(
            self.grounding.handle,
            _mapped(in_units, [prices.actions for prices in self.prices]),
            _mapped(in_units, [prices.parts for prices in self.prices]),
        )
        return Mix(weights, mixed, handle, core_weights, exponent)

    def _set_scales(self, scales: Sequence[Scale]) -> None:
        self.prices: list[Prices] = [problem.on(scale) for problem, scale in zip(self.problems, scales, strict=True)]


def _all(prices: Prices) -> Iterable[int]:
    return chain(prices.actions, prices.parts)


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


def _mapped(function: Callable[..., Result], columns: Sequence[Sequence[Value]]) -> list[Result]:
    """Return a function of each row of columns; equal rows are many."""
    known: dict[tuple[Value, ...], Result] = {}
    results = []
    for row in zip(*columns, strict=True):
        if row not in known:
            known[row] = function(*row)
        results.append(known[row])
    return results
