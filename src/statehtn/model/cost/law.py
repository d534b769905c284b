"""What every law of an uncertain cost can be asked."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from typing import TYPE_CHECKING, Any

from statehtn.counted import brief
from statehtn.errors import StateHtnError, UsageError
from statehtn.expected import expect, number, shown

if TYPE_CHECKING:
    from collections.abc import Callable

    from matplotlib.axes import Axes
    from numpy import float64
    from numpy.random import Generator
    from numpy.typing import NDArray

PLOT_POINTS = 400
MOST_DRAWN = 0.9995  # the rest of a long tail is left out


class CostLaw(ABC):
    """The probability law of a cost of an action or a plan: at least 0, minimised, in the domain's own unit.

    `CostDistribution` is a list of outcomes, `ScipyCost` a continuous law, `CostSum` a sum of independent laws.
    """

    __slots__ = ()

    @property
    @abstractmethod
    def mean(self) -> float:
        """The expected cost."""

    @property
    @abstractmethod
    def standard_deviation(self) -> float:
        """The standard deviation of the cost, in the same unit; may be infinite."""

    @property
    def variance(self) -> float:
        """The variance of the cost, in the square of the unit; may be infinite."""
        return self.standard_deviation * self.standard_deviation

    @property
    @abstractmethod
    def least(self) -> float:
        """The least cost that is possible."""

    @property
    @abstractmethod
    def most(self) -> float:
        """The largest cost that is possible; may be infinite."""

    @abstractmethod
    def cdf(self, cost: float) -> float:
        """Return the probability of paying at most `cost`."""

    @abstractmethod
    def exceedance(self, budget: float) -> float:
        """Return the probability of paying more than `budget`."""

    @abstractmethod
    def quantile(self, probability: float) -> float:
        """Return the least budget that is kept with at least this probability (the value at risk).

        Raises:
            UsageError: the probability is not between 0 and 1.
        """

    @abstractmethod
    def cvar(self, level: float) -> float:
        """Return the conditional value at risk: the mean of the worst `1 - level` of all cases.

        It is the mean for level 0 and the largest possible cost for level 1. Source: Acerbi and Tasche, *On the
        coherence of expected shortfall*, 2002, with costs for losses.

        Raises:
            UsageError: the level is not between 0 and 1.
        """

    @abstractmethod
    def exponential_mean(self, slope: float) -> float:
        """Return `ln E[e^(slope C)] / slope`; it rises with the slope, through the mean (the limit) at 0.

        It is the certainty equivalent of an exponential utility: the slope is alpha for an averse agent and -alpha for
        a seeking one.

        Args:
            slope: not 0, per unit of cost.

        Raises:
            InputError: the expectation is infinite, or cannot be computed.
        """

    @abstractmethod
    def exponential_mean_error(self, slope: float) -> float:
        """Return the error of `exponential_mean` beyond rounding: 0 but for what is integrated numerically."""

    @abstractmethod
    def expectation(self, function: Callable[[float], float]) -> float:
        """Return the expected value of a function of the cost.

        Args:
            function: of a cost as a float, to a finite number.

        Raises:
            UsageError: this is no function, or what it returns is no finite number.
            InputError: the expectation cannot be computed.
        """

    def expected_overrun(self, budget: float) -> float:
        """Return `E max(C - budget, 0)`: what is paid above a budget, in the mean over all cases."""
        number(budget, "a budget")
        return self.expectation(lambda cost: max(cost - budget, 0.0))

    def semi_deviation(self, target: float | None = None) -> float:
        """Return `sqrt(E max(C - target, 0)^2)`: the deviation of all costs above a target, in the unit of costs.

        Source: Fishburn, *Mean-risk analysis with risk associated with below-target returns*, 1977 (his exponent 2),
        with costs for losses.

        Args:
            target: the mean where it is None.
        """
        from_here = self.mean if target is None else number(target, "a target")
        return math.sqrt(self.expectation(lambda cost: max(cost - from_here, 0.0) ** 2))

    def entropic(self, alpha: float) -> float:
        """Return the entropic risk measure `ln E[e^(alpha C)] / alpha`, in the unit of costs.

        It is the certainty equivalent of a risk-averse agent for a positive alpha, of a risk-seeking one of `-alpha`
        for a negative, and the mean for 0. Source: Föllmer and Schied, *Convex measures of risk and trading
        constraints*, 2002, with costs for losses.

        Raises:
            UsageError: alpha is not finite.
            InputError: it is infinite, or cannot be computed.
        """
        slope = number(alpha, "alpha")
        if not math.isfinite(slope):
            raise UsageError(f"alpha must be a finite number, found {slope:g}")
        return self.exponential_mean(slope) if slope else self.mean

    def evar(self, level: float) -> float:
        """Return the entropic value at risk: the infimum over all `a > 0` of `entropic(a) + ln(1 / (1 - level)) / a`.

        It is at least the CVaR of the level, the mean for level 0 and the largest possible cost for level 1. Source:
        Ahmadi-Javid, *Entropic value-at-risk: a new coherent risk measure*, 2012, with costs for losses.

        Raises:
            UsageError: the level is not between 0 and 1.
            InputError: it is infinite, or cannot be computed.
        """
        from statehtn.model.cost.numerics.evar import entropic_value_at_risk

        if checked_probability(level, "the level of the entropic value at risk") == 0:
            return self.mean
        if level == 1 or math.isinf(self.mean):
            return self.most
        return entropic_value_at_risk(self, level)

    def dominates(self, other: CostLaw, order: int = 1) -> bool:
        """Tell whether this cost is at least as good as another to every agent of a kind (stochastic dominance).

        For order 1 every agent counts that likes lower costs: `P(C <= x)` is at least as large for every x. For order
        2 only those count that also shun risk: `E max(C - x, 0)` is at most as large for every x (the increasing convex
        order). A law dominates itself. It is exact, to 1e-12, for lists of outcomes; continuous laws are compared at
        some 120 of their quantiles. Source: Shaked and Shanthikumar, *Stochastic Orders*, 2007.

        Args:
            other: the law that this one is compared with.
            order: 1 or 2.

        Raises:
            UsageError: the other is no law, or there is no such order.
        """
        from statehtn.model.cost.comparison import dominates

        return dominates(self, expect(other, CostLaw, "expected the law of a cost"), order)

    def probability_above(self, other: CostLaw) -> float:
        """Return the probability that this cost is larger than another, independent one.

        Args:
            other: the law of the other cost.

        Raises:
            UsageError: the other is no law.
        """
        from statehtn.model.cost.comparison import probability_above

        return probability_above(self, expect(other, CostLaw, "expected the law of a cost"))

    @abstractmethod
    def to_scipy(self) -> Any:
        """Return the law as a frozen distribution of `scipy.stats`; `CostDistribution.from_scipy` reads it back.

        Raises:
            UsageError: scipy is not installed.
        """

    @abstractmethod
    def sample(self, runs: int, generator: Generator) -> NDArray[float64]:
        """Draw so many independent costs with a generator of numpy."""

    def __repr__(self) -> str:
        return f"<{type(self).__name__}: {brief(str(self))}; mean {self.mean:.6g}>"

    def _repr_html_(self) -> str:
        from statehtn.display.law import law_html

        return law_html(self)

    def plot(self, ax: Axes | None = None, *, label: str | None = None, color: str | None = None) -> Axes:
        """Draw the probability of keeping each budget, by matplotlib (`pip install 'statehtn[plots]'`).

        Several laws can be drawn on the same axes.

        Args:
            ax: where to draw; a new figure where it is None.
            label: the law's name in the legend; the law in words where it is None.
            color: of all its lines; the next one of the colour cycle where it is None.

        Raises:
            UsageError: matplotlib is not installed, or these are no axes.
        """
        from statehtn.display.law_plot import plot_law

        return plot_law(self, ax, str(self) if label is None else str(label), color)

    def curve(self, points: int = PLOT_POINTS) -> tuple[list[float], list[float]]:
        """Return ascending costs, and the probability of each or less, for a drawing in about so many steps.

        It begins with probability 0 where the least cost has one; of a long tail the end may be missing.
        """
        low, high = self.quantile(0), min(self.most, self.quantile(MOST_DRAWN))
        costs = [low + (high - low) * point / points for point in range(points + 1)]
        return costs, [self.cdf(cost) for cost in costs]


def checked_probability(value: float, what: str) -> float:
    """Return a probability.

    Raises:
        UsageError: it is not between 0 and 1.
    """
    if not 0 <= number(value, what) <= 1:
        raise UsageError(f"{what} must be between 0 and 1, found {value:g}")
    return value


def checked_function(function: Callable[[float], float], what: str = "the function") -> Callable[[float], float]:
    """Return a function of the cost that checks what it returns.

    Raises:
        UsageError: this is no function; the function that is returned raises it where it fails or gets no finite
            number.
    """
    if not callable(function):
        raise UsageError(f"expected a function of the cost, found {shown(function)}")

    def called(cost: float) -> float:
        try:
            given = function(cost)
        except StateHtnError:
            raise
        except Exception as error:
            reason = " ".join(f"{type(error).__name__}: {error}".split())
            raise UsageError(f"{what} fails for a cost of {cost:g} with {reason:.200}") from error
        value = number(int(given) if isinstance(given, bool) else given, f"what {what} returns for a cost of {cost:g}")
        if not math.isfinite(value):
            raise UsageError(f"what {what} returns for a cost of {cost:g} must be finite, found {value:g}")
        return value

    return called


def is_of_scipy(value: object) -> bool:
    """Tell whether something comes from `scipy.stats`, without importing it."""
    return any(kind.__module__.startswith("scipy.stats") for kind in type(value).__mro__)
