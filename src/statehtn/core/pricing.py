"""Fixed-point prices: what every ground action, and every part of its cost, costs this agent, in whole units."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from dataclasses import dataclass

import statehtn._relax as _relax
from statehtn.core.grounding import Grounding
from statehtn.errors import InputError
from statehtn.model import CostLaw
from statehtn.risk import Utility

COST_BITS = 40


@dataclass(frozen=True, slots=True)
class Prices:
    """Risk costs of actions and of the conditional parts of their costs, rounded down to whole units.

    The unit is a power of two, such that the largest cost takes about 40 bits: sums are exact, and a sum of rounded
    costs is at most the exact one, by less than a unit for each action and each part that is due.
    `units * 2**-exponent` is a cost in the domain's own unit.
    """

    units: _relax.Prices
    exponent: int

    def cost(self, units: int) -> float:
        """Return an amount of units as a cost in the domain's own unit."""
        return math.ldexp(units, -self.exponent)


def price(grounding: Grounding, utility: Utility) -> Prices:
    """Price actions by their risk cost (line 6 of the paper's Algorithm 5, in the additive form of its equation 10).

    Parts of a cost are independent, so that their risk costs add up, too: each has a price of its own.

    Raises:
        InputError: a cost has no finite price for this agent; the message names the action.
    """
    known: dict[int, float] = {}

    def risk_costs(laws: Iterable[CostLaw], name_of: Callable[[int], str]) -> list[float]:
        found: list[float] = []
        for law in laws:
            cost = known.get(id(law))
            if cost is None:
                try:
                    cost = known[id(law)] = utility.risk_cost(law)
                except InputError as error:
                    raise InputError(f"the cost of {name_of(len(found))}: {error.message}") from None
            found.append(cost)
        return found

    actions = risk_costs(grounding.laws, grounding.action_text)
    parts = risk_costs(grounding.part_laws, grounding.cost_part_text)
    largest = max((*actions, *parts), default=0.0)
    exponent = COST_BITS - math.frexp(largest)[1] if largest > 0 else 0

    def units(costs: list[float]) -> list[int]:
        return [math.floor(math.ldexp(cost, exponent)) for cost in costs]

    return Prices(_relax.Prices(units(actions), units(parts)), exponent)
