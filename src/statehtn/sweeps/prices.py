"""What actions cost in the runs of a sweep: additive prices, minimised by today's search."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from dataclasses import dataclass

from statehtn.errors import InputError
from statehtn.model.cost.law import CostLaw
from statehtn.risk import AdditiveObjective, Attitude, Exponential, Neutral
from statehtn.risk.checks import finite_measure
from statehtn.risk.objective import ValueUnit
from statehtn.sweeps.minorants import minorant


class AdditivePrices(ABC):
    """A price for every cost, by which plans are compared in one run of a sweep; prices add up."""

    __slots__ = ()
    unit = ValueUnit.COST
    monotone = False  # nothing relies on it
    concave = False

    @abstractmethod
    def risk_cost(self, law: CostLaw) -> float:
        """Return the price of a cost."""

    def value(self, law: CostLaw) -> float:
        """Return the price of a cost."""
        return self.risk_cost(law)


@dataclass(frozen=True, slots=True)
class ExtremeCost(AdditivePrices):
    """What a cost is worth in the limit of large alpha: the largest one to an averse agent, the least to a seeking one.

    Args:
        averse: whether the agent is.
    """

    averse: bool

    def risk_cost(self, law: CostLaw) -> float:
        """Return the largest or the least cost that is possible.

        Raises:
            InputError: it is infinite.
        """
        extreme = law.most if self.averse else law.least
        if math.isinf(extreme):
            raise InputError(f"{law} has no largest cost, so that there is no worst case; take a finite alpha")
        return extreme

    def __str__(self) -> str:
        return "the largest cost" if self.averse else "the least cost"


@dataclass(frozen=True, slots=True)
class Variance(AdditivePrices):
    """The variance of a cost, in its unit squared."""

    def risk_cost(self, law: CostLaw) -> float:
        """Return the variance.

        Raises:
            InputError: it is infinite, or too large for a float.
        """
        return finite_measure(law.variance, "its variance", law)

    def __str__(self) -> str:
        return "the variance"


@dataclass(frozen=True, slots=True)
class Minorant(AdditivePrices):
    """Prices at one end of an interval of `x = 1 / alpha`: see `statehtn.sweeps.minorants`.

    Args:
        low: the lower end of the interval, in units of cost.
        high: its upper end, finite.
        at: where the minorants of finite laws touch the certainty equivalent.
        upper: whether the prices are those at the upper end.
    """

    low: float
    high: float
    at: float
    upper: bool

    def risk_cost(self, law: CostLaw) -> float:
        """Return the value of the cost's minorant at the end of the interval."""
        return minorant(law, self.low, self.high, self.at)[self.upper]

    def __str__(self) -> str:
        end = self.high if self.upper else self.low
        return f"a lower bound at 1/alpha = {end:g}, of 1/alpha from {self.low:g} to {self.high:g}"


def prices_at(slope: float) -> AdditiveObjective:
    """Return the objective whose prices are certainty equivalents at a slope: alpha, or -alpha of a seeking agent."""
    if slope == 0:
        return Neutral()
    if math.isinf(slope):
        return ExtremeCost(slope > 0)
    return Exponential(Attitude.AVERSE if slope > 0 else Attitude.SEEKING, abs(slope))
