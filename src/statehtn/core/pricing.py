"""Fixed-point prices: what every ground action costs this agent, in whole units."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from dataclasses import dataclass

from statehtn.errors import InputError
from statehtn.model import CostLaw
from statehtn.risk import Utility

COST_BITS = 40


@dataclass(frozen=True, slots=True)
class Prices:
    """Risk costs by action, rounded down to whole units.

    The unit is a power of two, such that the largest cost takes about 40 bits: sums are exact, and a sum of rounded
    costs is at most the exact one, by less than a unit for each action. `units * 2**-exponent` is a cost in the
    domain's own unit.
    """

    units: list[int]
    exponent: int

    def cost(self, units: int) -> float:
        """Return an amount of units as a cost in the domain's own unit."""
        return math.ldexp(units, -self.exponent)


def price(laws: Iterable[CostLaw], utility: Utility, name_of: Callable[[int], str] = str) -> Prices:
    """Price actions by their risk cost (line 6 of the paper's Algorithm 5, in the additive form of its equation 10).

    Args:
        laws: the cost distribution of each action; equal objects are priced once.
        utility: the agent's.
        name_of: the name of each action, for messages.

    Raises:
        InputError: a cost has no finite price for this agent; the message names the action.
    """
    known: dict[int, float] = {}
    risk_costs: list[float] = []
    for law in laws:
        cost = known.get(id(law))
        if cost is None:
            try:
                cost = known[id(law)] = utility.risk_cost(law)
            except InputError as error:
                raise InputError(f"the cost of {name_of(len(risk_costs))}: {error.message}") from None
        risk_costs.append(cost)
    largest = max(risk_costs, default=0.0)
    exponent = COST_BITS - math.frexp(largest)[1] if largest > 0 else 0
    return Prices([math.floor(math.ldexp(cost, exponent)) for cost in risk_costs], exponent)
