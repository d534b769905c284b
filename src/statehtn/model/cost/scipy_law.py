"""Costs whose law is a frozen distribution of `scipy.stats`."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, Any

from statehtn.errors import InputError, UnsupportedError, UsageError
from statehtn.expected import number
from statehtn.model.cost.distribution import CostDistribution
from statehtn.model.cost.law import CostLaw, checked_function, checked_probability, is_of_scipy
from statehtn.model.cost.scipy_call import scipy_call

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy import float64
    from numpy.random import Generator
    from numpy.typing import NDArray

MOST_OUTCOMES = 100_000
PERT_WEIGHT = 4.0  # of the likely cost among the three estimates, the two others weigh 1 each
LEAST_TAIL = 1e-18  # of a discrete law; what is beyond does not count


@dataclass(frozen=True, repr=False)
class ScipyCost(CostLaw):
    """A cost with a distribution of `scipy.stats`: continuous, or Poisson, geometric or negative binomial.

    Make one by `CostDistribution.from_scipy`. Two are equal if family and parameters are.

    Args:
        family: the name of the family in `scipy.stats`.
        parameters: pairs (name, value): shapes, then `loc` and `scale` where they are not 0 and 1.
        frozen: the distribution itself.
        identity: what tells families of one name apart that `scipy.stats` does not have; None where it has it.
        origin: where it is stated, for messages.
    """

    family: str
    parameters: tuple[tuple[str, float | tuple[float, ...]], ...]
    frozen: Any = field(compare=False, repr=False)
    identity: int | None = field(default=None, repr=False)
    origin: str = field(default="", compare=False, repr=False)

    @property
    def is_discrete(self) -> bool:
        """Whether there are single costs that have a probability."""
        return hasattr(self.frozen.dist, "pmf")

    @property
    def title(self) -> str:
        """The law, and where it is stated."""
        return f"{self} ({self.origin})" if self.origin else str(self)

    @property
    def shift(self) -> float:
        """The parameter `loc`: the cost is `shift + scale Z`, where `Z` is the family's standard variable."""
        return float(dict(self.parameters).get("loc", 0.0))  # type: ignore[arg-type]

    @property
    def scale(self) -> float:
        """The parameter `scale`."""
        return float(dict(self.parameters).get("scale", 1.0))  # type: ignore[arg-type]

    @cached_property
    def standard(self) -> ScipyCost:
        """The law of the family's standard variable, with `loc` 0 and `scale` 1, which may be negative."""
        shapes = tuple(item for item in self.parameters if item[0] not in ("loc", "scale"))
        with scipy_call(self.title):
            return ScipyCost(self.family, shapes, self.frozen.dist(**dict(shapes)), self.identity, self.origin)

    @cached_property
    def mean(self) -> float:
        """The expected cost."""
        with scipy_call(self.title):
            return float(self.frozen.mean())

    @cached_property
    def standard_deviation(self) -> float:
        """The standard deviation of the cost; may be infinite."""
        with scipy_call(self.title):
            return float(self.frozen.std())

    @cached_property
    def least(self) -> float:
        """The least cost that is possible."""
        with scipy_call(self.title):
            return float(self.frozen.support()[0])

    @cached_property
    def most(self) -> float:
        """The largest cost that is possible; may be infinite."""
        with scipy_call(self.title):
            return float(self.frozen.support()[1])

    def cdf(self, cost: float) -> float:
        """Return the probability of paying at most `cost`."""
        number(cost, "a cost")
        with scipy_call(self.title):
            return float(self.frozen.cdf(cost))

    def exceedance(self, budget: float) -> float:
        """Return the probability of paying more than `budget`."""
        number(budget, "a budget")
        with scipy_call(self.title):
            return float(self.frozen.sf(budget))

    def quantile(self, probability: float) -> float:
        """Return the least cost that is not exceeded with at least this probability.

        Raises:
            UsageError: the probability is not between 0 and 1.
        """
        if checked_probability(probability, "the probability of a quantile") == 0:
            return self.least
        with scipy_call(self.title):
            return float(self.frozen.ppf(probability))

    def cvar(self, level: float) -> float:
        """Return the mean cost of the worst `1 - level` of all cases.

        Raises:
            UsageError: the level is not between 0 and 1.
        """
        if checked_probability(level, "the level of the CVaR") == 0:
            return self.mean
        if level == 1:
            return self.most
        quantile = self.quantile(level)
        return quantile + self.expected_overrun(quantile) / (1 - level)

    def expectation(self, function: Callable[[float], float]) -> float:
        """Return the expected value of a function of the cost, integrated numerically over the quantiles.

        Raises:
            UsageError: this is no function, or what it returns is no finite number.
            InputError: it could not be integrated to 1e-6 of its size.
        """
        from statehtn.model.cost.numerics.expectation import expectation

        return expectation(self, checked_function(function))

    def expected_overrun(self, budget: float) -> float:
        """Return `E max(C - budget, 0)`: what is paid above a budget, in the mean over all cases."""
        from statehtn.model.cost.numerics.quadrature import excess

        number(budget, "a budget")
        if self.is_discrete:
            import numpy

            last = max(budget, self.least) + 1
            while self.frozen.sf(last) > LEAST_TAIL:
                last = self.least + 2 * (last - self.least)
            beyond = self.least + numpy.arange(max(0.0, math.floor(budget - self.least) + 1), last - self.least + 1)
            return float(numpy.sum((beyond - budget) * self.frozen.pmf(beyond)))
        return excess(self, budget)

    def exponential_mean(self, slope: float) -> float:
        """Return `ln E[e^(slope C)] / slope`.

        It is taken from the moment generating function where that has a closed form, else integrated numerically.

        Raises:
            InputError: the moment generating function is infinite there, or the integral is not accurate enough.
        """
        from statehtn.model.cost.numerics.moment_generating import exponential_mean

        return exponential_mean(self, slope)[0]

    def exponential_mean_error(self, slope: float) -> float:
        """Return how much `exponential_mean` is off at most, as the quadrature tells; 0 for a closed form."""
        from statehtn.model.cost.numerics.moment_generating import exponential_mean

        return exponential_mean(self, slope)[1]

    def to_scipy(self) -> Any:
        """Return the frozen distribution itself."""
        return self.frozen

    def sample(self, runs: int, generator: Generator) -> NDArray[float64]:
        """Draw so many independent costs with a generator of numpy."""
        import numpy

        return numpy.asarray(self.frozen.rvs(size=runs, random_state=generator), dtype=float)

    def masses(self, width: float, count: int) -> NDArray[float64]:
        """Return the probability of each of so many cells from the least cost on; the last has all that is beyond."""
        import numpy

        with scipy_call(self.title):
            below = self.frozen.cdf(self.least + width * numpy.arange(1, count))
        return numpy.diff(below, prepend=0.0, append=1.0)

    def discretised(self, outcomes: int = 20) -> CostDistribution:
        """Return a list of so many outcomes that are equally likely, each the mean of its part of the law.

        The mean is kept, and risk costs of an averse agent fall, those of a seeking one rise. HDDL can hold the result.

        Raises:
            UsageError: there is not at least one outcome.
        """
        if outcomes < 1:
            raise UsageError(f"the number of outcomes must be at least 1, found {outcomes}")
        above = [(1 - i / outcomes) * self.cvar(i / outcomes) for i in range(outcomes)] + [0.0]
        means = [outcomes * (above[i] - above[i + 1]) for i in range(outcomes)]
        return CostDistribution.of((1 / outcomes, max(mean, self.least)) for mean in means)

    def __str__(self) -> str:
        return f"{self.family}({', '.join(f'{name}={_number_text(value)}' for name, value in self.parameters)})"


def _number_text(value: float | tuple[float, ...]) -> str:
    return f"[{', '.join(map(_number_text, value))}]" if isinstance(value, tuple) else f"{value:g}"


def law_of(distribution: Any) -> CostLaw:
    """Return the law of a frozen distribution; see `CostDistribution.from_scipy`."""
    if not (is_of_scipy(distribution) and hasattr(distribution, "dist") and hasattr(distribution, "support")):
        raise InputError(
            f"expected a frozen distribution such as scipy.stats.gamma(2, scale=3), found {_shown(distribution)}"
        )
    if hasattr(distribution.dist, "xk"):  # a list of outcomes, which need not be whole numbers
        costs = distribution.dist.xk + distribution.kwds.get("loc", 0)
        return CostDistribution.of(zip(distribution.pmf(costs).tolist(), costs.tolist(), strict=True))
    family = str(distribution.dist.name)
    law = ScipyCost(family, _parameters(distribution), distribution, _identity(distribution))
    if not law.is_discrete and any(isinstance(value, tuple) for _, value in law.parameters):
        raise InputError(f"the parameters of '{family}' must be numbers, found {law}")
    least, most = law.least, law.most
    if math.isnan(least) or math.isnan(most):
        raise InputError(f"{law}: the parameters of '{family}' are out of their range")
    if least < 0:
        raise InputError(
            f"{law} can be as low as {least:g}, but a cost is at least 0; truncate it (as scipy.stats.truncnorm does), "
            f"or shift it by 'loc'"
        )
    if law.is_discrete and most - least < MOST_OUTCOMES:
        return _listed(law)
    if law.is_discrete and math.isfinite(most):
        raise UnsupportedError(
            f"{law} has {most - least + 1:.15g} outcomes, more than {MOST_OUTCOMES}; give a continuous law that is "
            f"close to it, or outcomes or samples"
        )
    from statehtn.model.cost.numerics.moment_generating import CLOSED_FORMS

    if law.is_discrete and family not in CLOSED_FORMS:
        raise UnsupportedError(f"{law} has infinitely many outcomes; give those that matter by CostDistribution.of")
    if not math.isfinite(law.mean):
        raise InputError(f"{law} has no finite mean; the expected cost of an action must be finite")
    return law


def pert(least: float, likely: float, most: float) -> CostLaw:
    """Return the PERT law of three estimates; see `CostDistribution.pert`."""
    if not (0 <= least <= likely <= most < math.inf):
        raise InputError(
            f"the estimates of a PERT law must be finite, at least 0 and in order (least, likely, most), found "
            f"{least:g}, {likely:g}, {most:g}"
        )
    if least == most:
        return CostDistribution.certain(likely)
    try:
        from scipy.stats import beta
    except ImportError:
        raise UsageError("a PERT law needs the package 'scipy': pip install 'statehtn[scipy]'") from None
    width = most - least
    shape = 1 + PERT_WEIGHT * (likely - least) / width
    return law_of(beta(shape, 2 + PERT_WEIGHT - shape, loc=least, scale=width))


def _listed(law: ScipyCost) -> CostDistribution:
    import numpy

    costs = law.least + numpy.arange(law.most - law.least + 1)
    with scipy_call(law.title):
        masses = law.frozen.pmf(costs)
    return CostDistribution.of(zip(masses.tolist(), costs.tolist(), strict=True))


def _parameters(distribution: Any) -> tuple[tuple[str, float | tuple[float, ...]], ...]:
    shapes = [name.strip() for name in (distribution.dist.shapes or "").split(",") if name.strip()]
    names = [*shapes, "loc", "scale"]
    given = dict(zip(names, distribution.args, strict=False)) | dict(distribution.kwds)
    try:
        values = {name: _parameter(given[name]) for name in names if name in given}
    except (TypeError, ValueError):
        raise InputError(f"the parameters of '{distribution.dist.name}' must be numbers, found {given}") from None
    return tuple(item for item in values.items() if item not in (("loc", 0.0), ("scale", 1.0)))


def _parameter(value: Any) -> float | tuple[float, ...]:
    """Return a number, or the numbers of a list: the Poisson binomial law has one."""
    if isinstance(value, list | tuple) or getattr(value, "ndim", 0) == 1:
        return tuple(map(float, value))
    return float(value)


def _identity(distribution: Any) -> int | None:
    import scipy.stats

    own = getattr(scipy.stats, distribution.dist.name, None)
    return None if type(own) is type(distribution.dist) else id(distribution.dist)


def _shown(value: object) -> str:
    if is_of_scipy(value) and hasattr(value, "name"):
        return f"the family '{value.name}' without parameters; call it with them"
    return repr(value)
