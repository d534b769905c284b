"""Sums of exponential utilities: agents that are averse to some risks and seek others."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass

from statehtn.errors import UsageError
from statehtn.expected import items, shown
from statehtn.model.cost.law import CostLaw
from statehtn.model.expect import expect_law
from statehtn.risk.checks import finite, not_negative, text_of
from statehtn.risk.disutility import Term, certainty_equivalent
from statehtn.risk.objective import ValueUnit
from statehtn.risk.total_utility import TotalUtility


@dataclass(frozen=True, slots=True)
class Exponentials(TotalUtility):
    """The certain cost as bad as a law to an agent whose disutility is a linear term and some exponentials.

    The disutility of a cost C is `W0 C`, plus `Wj e^(Aj C)` for every `Aj > 0`, minus `Wj e^(Aj C)` for every
    `Aj < 0`; the value `ce` is the cost whose disutility is the expected one. The unit is that of costs. The agent is
    averse to risk if no `Aj` is negative.

    Source: Bell, *One-switch utility functions and a measure of risk*, 1988, for sums of a linear term and
    exponentials; Nakamura, *Sumex utility functions*, 1996.

    Args:
        linear: `W0`, at least 0.
        weights: pairs `(Aj, Wj)` of a slope, per unit of cost, not 0, and a weight of at least 0; each slope once.

    Raises:
        UsageError: a number is out of its range, a slope comes twice, or all weights are 0.
    """

    linear: float
    weights: tuple[tuple[float, float], ...]

    unit = ValueUnit.COST
    monotone = True

    def __post_init__(self) -> None:
        object.__setattr__(self, "linear", not_negative(self.linear, "the linear weight"))
        object.__setattr__(self, "weights", _checked(self.weights))
        if self.linear == 0 and not self.terms:
            raise UsageError("one of the weights of a sum of exponentials must be above 0, found 0 for all")

    @property
    def terms(self) -> tuple[Term, ...]:
        """The exponentials of a weight above 0."""
        return tuple(Term(slope, math.log(weight)) for slope, weight in self.weights if weight > 0)

    @property
    def concave(self) -> bool:
        """True if no exponential of negative slope weighs anything."""
        return all(term.slope > 0 for term in self.terms)

    def value(self, law: CostLaw) -> float:
        """Return the certainty-equivalent cost.

        Raises:
            InputError: an exponential mean is infinite, or cannot be computed.
        """
        return certainty_equivalent(self.linear, self.terms, expect_law(law))

    def __str__(self) -> str:
        pairs = (f"{text_of(slope)}:{text_of(weight)}" for slope, weight in self.weights)
        return " ".join(["exponentials", f"linear={text_of(self.linear)}", *pairs])


def _checked(given: Iterable[tuple[float, float]]) -> tuple[tuple[float, float], ...]:
    """Return pairs of a slope and a weight that are in their range."""
    pairs: dict[float, float] = {}
    for pair in items(given, "the exponentials"):
        try:
            first, second = pair
        except (TypeError, ValueError):
            raise UsageError(f"an exponential is a pair (slope, weight), found {shown(pair)}") from None
        slope = finite(first, "the slope of an exponential")
        if slope == 0:
            raise UsageError("the slope of an exponential must not be 0; give the linear weight instead")
        if slope in pairs:
            raise UsageError(f"each slope of an exponential comes once, found {text_of(slope)} twice")
        pairs[slope] = not_negative(second, f"the weight of the exponential of slope {text_of(slope)}")
    return tuple(pairs.items())
