"""The one-switch utility: an agent that is careful when little is left, and less so the more it has."""

from __future__ import annotations

import math
from dataclasses import dataclass
from decimal import Context, Decimal
from functools import lru_cache

from statehtn.errors import UsageError
from statehtn.model.cost.law import CostLaw
from statehtn.model.expect import expect_law
from statehtn.risk.checks import finite, positive, text_of
from statehtn.risk.disutility import Term, certainty_equivalent
from statehtn.risk.objective import ValueUnit
from statehtn.risk.total_utility import TotalUtility

_MANY_DIGITS = Context(prec=60)


@dataclass(frozen=True, slots=True)
class OneSwitch(TotalUtility):
    """The certain cost as bad as a law to an agent of the utility `u(x) = x - (D/A) e^(-A x)` of what is left.

    What is left is the wealth minus the total cost, `x = W - C`, and may be negative; the value `ce` solves
    `u(W - ce) = E u(W - C)`. The agent is always averse to risk. As `D e^(-A W)` goes to 0 it becomes neutral, as
    that grows it becomes the exponential agent of `alpha`; between any two laws its preference switches at most once
    as the wealth grows. The unit is that of costs.

    Source: equation 2 of the paper (with `+ c` in its first term, which it lacks); Bell, *One-switch utility functions
    and a measure of risk*, 1988.

    Args:
        alpha: `A`, positive, per unit of cost.
        tradeoff: `D`, positive: how much the exponential weighs against the linear term.
        wealth: `W`, the paper's resource: what the agent has before it starts, in the unit of costs.

    Raises:
        UsageError: a parameter is out of its range.
    """

    alpha: float
    tradeoff: float
    wealth: float

    unit = ValueUnit.COST
    monotone = True
    concave = True
    is_dynamic = True

    def __post_init__(self) -> None:
        object.__setattr__(self, "alpha", positive(self.alpha, "alpha"))
        object.__setattr__(self, "tradeoff", positive(self.tradeoff, "the tradeoff"))
        object.__setattr__(self, "wealth", finite(self.wealth, "the wealth"))
        if not math.isfinite(_log_weight(self.alpha, self.tradeoff, self.wealth)):
            raise UsageError(f"alpha times the wealth is too large: {self.alpha:g} times {self.wealth:g}")

    @property
    def linear(self) -> float:
        """The weight of the total cost in the disutility `C + (D/A) e^(-A W) e^(A C)`: 1."""
        return 1.0

    @property
    def terms(self) -> tuple[Term, ...]:
        """The exponential of the disutility, of slope `A` and weight `(D/A) e^(-A W)`."""
        return (Term(self.alpha, _log_weight(self.alpha, self.tradeoff, self.wealth)),)

    def value(self, law: CostLaw) -> float:
        """Return the certainty-equivalent cost, at least the expected cost.

        Raises:
            InputError: the exponential mean for `alpha` is infinite, or cannot be computed.
        """
        return certainty_equivalent(self.linear, self.terms, expect_law(law))

    def __str__(self) -> str:
        parameters = (("alpha", self.alpha), ("tradeoff", self.tradeoff), ("wealth", self.wealth))
        return " ".join(["one-switch", *(f"{name}={text_of(value)}" for name, value in parameters)])


@lru_cache(maxsize=64)
def _log_weight(alpha: float, tradeoff: float, wealth: float) -> float:
    """Return `ln(D/A) - A W` to the last bit: its two parts may nearly cancel."""
    logarithm = _MANY_DIGITS.ln(_MANY_DIGITS.divide(Decimal(tradeoff), Decimal(alpha)))
    return float(_MANY_DIGITS.subtract(logarithm, _MANY_DIGITS.multiply(Decimal(alpha), Decimal(wealth))))
