"""Costs that need a number which `:init` does not give.

Such a cost is priced at 0, the least that it can be, as costs are at least 0. So every plan costs at least what it is
priced at, whatever the number is, and a plan that does not need the number costs just that: if it is the best at these
prices, it is the best for every number. A plan that needs the number is refused.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field

from statehtn.errors import InputError
from statehtn.model.cost.distribution import CostDistribution
from statehtn.model.cost.law import CostLaw
from statehtn.model.cost.sum import parts_of


class MissingNumber(InputError):
    """`:init` does not define the value of a function that is needed."""


@dataclass(frozen=True, slots=True)
class UnknownCost(CostDistribution):
    """What an unknown cost is taken as: nothing.

    Args:
        error: says which number is missing, and where it is needed.
    """

    outcomes: tuple[tuple[float, float], ...] = ((1.0, 0.0),)
    error: MissingNumber = field(kw_only=True, compare=False)


def refuse_unknown(costs: Iterable[CostLaw]) -> None:
    """Raise the `MissingNumber` of the first cost that is unknown."""
    for law in parts_of(costs):
        if isinstance(law, UnknownCost):
            raise law.error
