"""What every ground action costs an agent: its risk cost, and how much of that is certain in spite of rounding."""

from __future__ import annotations

import math
import sys
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import chain
from typing import NamedTuple, Protocol

import statehtn._relax as _relax
from statehtn.core.grounding import Grounding
from statehtn.core.scale import Scale
from statehtn.errors import InputError, UnsupportedError, UsageError
from statehtn.limits import Limits, watched
from statehtn.model import CostLaw
from statehtn.risk import Exponential, Neutral, SuccessUtility

ROUNDING = 2.0**-40
"""By how much of itself the risk cost of an uncertain cost is off at most, computed in floating point.

A mean is a sum of positive terms, good to some units of 2^-53. An exponential mean is the logarithm of such a sum,
`K = ln E[e^x]`, whose exponents have one sign. What matters are the four roundings (of the cost, the difference to the
least cost, the slope, the product) that leave each x off by some units of 2^-53 of itself, and so K by as much of
`W = E[x e^x] / E[e^x]`: all others are relative to K. Relative entropy is not negative, so `|W| <= |K|` where exponents
are negative. Where they are positive, let p be the least probability: `E[x e^x] / E[e^x]` is at most `K (1 + ln 1/p)`,
for K is at least the share of W of terms with `x <= ln 1/p`, divided by that, and at least `x - ln 1/p` for others.
Since `ln 1/p < 709` in floating point, 2^-40 is more than all of it; the worst of 60 000 random laws was off by 2^-44.
"""


LARGEST_PRICE = 1e290
"""Of an action: a plan of a billion billion steps still has a finite sum."""
IMPOSSIBLE = 1e9
"""Times the largest price of an action, or 1: the price of counting on an outcome that cannot come.

No plan with another way does."""


class Pricing(Protocol):
    """What puts a price on an uncertain cost, such that prices of independent costs add up."""

    def risk_cost(self, law: CostLaw) -> float:
        """Return the price.

        Raises:
            InputError: it is infinite, or cannot be computed.
        """
        ...


class RiskCost(NamedTuple):
    """A certainty equivalent in the domain's own unit, and a lower bound of it whatever was lost to rounding.

    A cost that is certain is exact: it is the decimal as floating point has it, off by 2^-53 of itself at most.
    """

    cost: float
    bound: float


@dataclass(frozen=True, slots=True)
class PricedTrace:
    """A plan that the core has found: the actions that it executes, the parts of costs that are due, and its cost."""

    trace: _relax.SearchResult
    actions: list[int]
    parts: list[int]
    cost: float

    @property
    def steps(self) -> int:
        """How many things with a price are in it."""
        return len(self.actions) + len(self.parts)


@dataclass(frozen=True, slots=True)
class Prices:
    """All prices of a ground problem in whole units of a scale."""

    scale: Scale
    actions: list[int]
    parts: list[int]
    has_free: bool
    """Whether a price that is positive is 0 on this scale."""
    handle: _relax.PricedProblem
    """The ground problem at these prices in the core."""

    def of_plan(self, plan: PricedTrace) -> int:
        """Return what a plan costs in units."""
        actions, parts = self.actions, self.parts
        return sum(actions[action] for action in plan.actions) + sum(parts[part] for part in plan.parts)


@dataclass(frozen=True, slots=True)
class PricedProblem:
    """A ground problem, and what its actions and the conditional parts of their costs cost an agent, by number."""

    grounding: Grounding
    actions: list[RiskCost]
    parts: list[RiskCost]

    def bounds(self) -> Iterator[float]:
        """Yield the lower bounds of all prices, of the same object once."""
        return (price.bound for price in self._kinds().values())

    def on(self, scale: Scale) -> Prices:
        """Return all prices on a scale, rounded down from their lower bounds."""
        kinds = self._kinds()
        units = dict(zip(kinds, scale.units(price.bound for price in kinds.values()), strict=True))
        has_free = any(not units[kind] and price.bound for kind, price in kinds.items())
        actions, parts = ([units[id(price)] for price in prices] for prices in (self.actions, self.parts))
        handle = _relax.PricedProblem(self.grounding.handle, actions, parts)
        return Prices(scale, actions, parts, has_free, handle)

    def _kinds(self) -> dict[int, RiskCost]:
        """Return the prices that there are, by identity: thousands of actions often have a few laws."""
        return {id(price): price for price in chain(self.actions, self.parts)}

    def of_plan(self, trace: _relax.SearchResult) -> PricedTrace:
        """Return what a plan costs: the sum of its own prices, rounded once."""
        actions, parts = trace.actions, trace.due_parts
        prices = chain((self.actions[action] for action in actions), (self.parts[part] for part in parts))
        try:
            cost = math.fsum(price.cost for price in prices)
        except OverflowError:
            cost = sys.float_info.max
        return PricedTrace(trace, actions, parts, cost)


def price(grounding: Grounding, objective: Pricing, limits: Limits = Limits()) -> PricedProblem:
    """Price actions by their risk cost (line 6 of the paper's Algorithm 5, in the additive form of its equation 10).

    Parts of a cost are independent, so that their risk costs add up, too: each has a price of its own.

    Raises:
        InputError: a cost has no finite price for this agent; the message names the action.
        UnsupportedError: costs hang together, so that only their means add up.
        LimitReached: a limit was reached.
    """
    if grounding.has_scenarios and not isinstance(objective, Neutral):
        raise UnsupportedError(
            f"costs that depend on hidden facts hang together, and prices for '{objective}' do not add up along a plan"
        )
    known: dict[int, RiskCost] = {}

    def priced(laws: Sequence[CostLaw], name_of: Callable[[int], str]) -> list[RiskCost]:
        found: list[RiskCost] = []
        for law in laws:
            price = known.get(id(law))
            if price is None:
                try:
                    price = known[id(law)] = risk_cost(law, objective)
                except InputError as error:
                    raise InputError(f"the cost of {name_of(len(found))}: {error.message}") from None
            found.append(price)
        return found

    with watched(limits):
        actions = priced(grounding.laws, grounding.action_text)
        if isinstance(objective, SuccessUtility) and grounding.handle.has_outcomes:
            actions = _counting_on_outcomes(actions, grounding.probabilities, objective)
        parts = priced(grounding.part_laws, grounding.cost_part_text)
    return PricedProblem(grounding, actions, parts)


def _counting_on_outcomes(
    prices: Sequence[RiskCost], probabilities: Sequence[Fraction], objective: SuccessUtility
) -> list[RiskCost]:
    """Return the prices of actions each of which is an outcome that a plan counts on."""
    known: dict[tuple[int, Fraction], RiskCost] = {}
    found: list[RiskCost] = []
    impossible = IMPOSSIBLE * max([1.0, *(price.cost for price in prices)])
    for price, probability in zip(prices, probabilities, strict=True):
        if probability == 1:
            found.append(price)
            continue
        key = id(price), probability
        if key not in known:
            more = objective.outcome_price(float(probability)) if probability else impossible
            known[key] = RiskCost(price.cost + more, price.bound + more - ROUNDING * more)
        found.append(known[key])
    return found


def check_exponent(objective: object, slope: float, largest: float) -> None:
    """Check that alpha, or a slope, times each cost can be added up.

    Args:
        objective: whose slope it is.
        slope: per unit of cost.
        largest: of the costs.

    Raises:
        UsageError: it is too large.
    """
    if not abs(slope) * largest <= LARGEST_PRICE:
        raise UsageError(
            f"the search by '{objective}' adds up alpha times each cost, which is {abs(slope) * largest:g} for the "
            f"largest, and numbers above {LARGEST_PRICE:g} become too large; take a smaller alpha"
        )


def risk_cost(law: CostLaw, objective: Pricing) -> RiskCost:
    """Return the price of a cost to an agent.

    Raises:
        InputError: it is infinite, too large, or cannot be computed.
    """
    cost = objective.risk_cost(law)
    if not cost <= LARGEST_PRICE:
        raise InputError(
            f"{law}: its price for '{objective}' is {cost:g}, and numbers above {LARGEST_PRICE:g} become too large "
            f"when the prices of a plan are added up; state costs in a larger unit, or take a smaller parameter"
        )
    if law.least == law.most:
        return RiskCost(cost, cost)
    return RiskCost(cost, max(0.0, cost - ROUNDING * cost - _error(law, objective)))


def _error(law: CostLaw, objective: Pricing) -> float:
    """Return by how much a price may be off beyond `ROUNDING`."""
    match objective:
        case Exponential():
            return law.exponential_mean_error(objective.slope)
        case SuccessUtility():
            return objective.price_error(law)
    return 0.0
