"""Costs from data: samples with bounds on what they may miss, and counts with a prior."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from fractions import Fraction
from typing import Protocol

from statehtn.errors import InputError, UsageError
from statehtn.expected import each_of, number, shown
from statehtn.model.cost.distribution import CostDistribution
from statehtn.model.cost.law import CostLaw


class Pricing(Protocol):
    """What gives an uncertain cost its price; every `statehtn.Utility` does."""

    def risk_cost(self, law: CostLaw) -> float:
        """Return the certainty-equivalent cost."""
        ...


@dataclass(frozen=True, slots=True, repr=False)
class SampledCost(CostDistribution):
    """The empirical distribution of observed costs, and what the true law may be beyond them.

    Args:
        count: the number of observations.
        limits: the least and the largest cost that are possible at all; the second is infinite where it is not known.
    """

    count: int
    limits: tuple[float, float]

    def band(self, confidence: float = 0.95) -> tuple[CostDistribution, CostDistribution | None]:
        """Return the best and the worst law that the data leave possible, for all questions at once.

        With at least this confidence the distribution function of the true law lies between theirs everywhere, so that
        every mean, quantile, CVaR and risk cost of it does. The worst law is None where the largest possible cost is
        not known. The best one has the highest `epsilon` of the observations replaced by the least possible cost, the
        worst one the lowest `epsilon` by the largest, with `epsilon = sqrt(ln(2 / (1 - confidence)) / (2 count))`.
        Source: the inequality of Dvoretzky, Kiefer and Wolfowitz with the constant of Massart, *The tight constant in
        the Dvoretzky-Kiefer-Wolfowitz inequality*, 1990. Nothing is assumed of the law but independent observations.

        Raises:
            UsageError: the confidence is not above 0 and below 1.
        """
        if not 0 < number(confidence, "the confidence") < 1:
            raise UsageError(f"the confidence must be above 0 and below 1, found {confidence:g}")
        epsilon = min(1.0, math.sqrt(math.log(2 / (1 - confidence)) / (2 * self.count)))
        least, most = self.limits
        best = _moved(self.outcomes[::-1], epsilon, least)
        return best, _moved(self.outcomes, epsilon, most) if math.isfinite(most) else None

    def risk_cost_bounds(self, utility: Pricing, confidence: float = 0.95) -> tuple[float, float]:
        """Return bounds between which the risk cost of the true law lies, with at least this confidence.

        The upper one is infinite where the largest possible cost is not known: no data exclude a rare disaster. The
        bounds hold for all agents at once; see `band`.

        Args:
            utility: the agent's, such as `statehtn.utility_for("averse", 0.5)`.
            confidence: above 0 and below 1.
        """
        if not callable(getattr(utility, "risk_cost", None)):
            raise UsageError(f"expected an agent's utility, such as utility_for('averse', 0.5), found {shown(utility)}")
        best, worst = self.band(confidence)
        return utility.risk_cost(best), math.inf if worst is None else utility.risk_cost(worst)

    def __str__(self) -> str:
        return CostDistribution.__str__(self)


def _moved(outcomes: Iterable[tuple[float, float]], epsilon: float, target: float) -> CostDistribution:
    """Return the distribution with a probability of `epsilon` moved from the first outcomes to another cost."""
    left = epsilon
    kept = [(epsilon, target)]
    for probability, cost in outcomes:
        taken = min(left, probability)
        left -= taken
        kept.append((probability - taken, cost))
    return CostDistribution.of(kept)


def sampled_cost(data: Iterable[float], most: float | None) -> SampledCost:
    """Return the empirical distribution of observations; see `CostDistribution.from_samples`."""
    counts: dict[float, int] = {}
    for value in each_of(data, "the observed costs"):  # which may come from a large file, piece by piece
        cost = _number(value, "an observed cost")
        counts[cost] = counts.get(cost, 0) + 1
    if not counts:
        raise InputError("a distribution from samples needs at least one observation, found none")
    limit = math.inf if most is None else _number(most, "the largest possible cost")
    if max(counts) > limit:
        raise InputError(f"an observed cost of {max(counts):g} is above the largest possible cost, {limit:g}")
    total = sum(counts.values())
    outcomes = tuple([(counts[cost] / total, cost) for cost in sorted(counts)])
    return SampledCost(outcomes, total, (0.0, limit))


def posterior_predictive(counts: Mapping[float, float], prior: float | Mapping[float, float]) -> CostDistribution:
    """Return the posterior predictive distribution; see `CostDistribution.from_counts`."""
    if not isinstance(counts, Mapping):
        raise InputError(f"counts are a mapping from costs to numbers, such as {{2: 17, 6: 3}}, found {counts!r}")
    weights: dict[float, Fraction] = {}
    for what, given in (
        ("the count", counts),
        ("the prior weight", prior if isinstance(prior, Mapping) else dict.fromkeys(counts, prior)),
    ):
        for key, value in given.items():
            cost = _number(key, "a cost")
            weight = Fraction(_number(value, f"{what} of {cost:g}"))
            weights[cost] = weights.get(cost, Fraction(0)) + weight
    total = sum(weights.values(), Fraction(0))
    if total == 0:
        raise InputError("counts and prior are all 0; at least one outcome must have been seen, or be expected")
    return CostDistribution.of((float(weight / total), cost) for cost, weight in weights.items())


def _number(value: object, what: str) -> float:
    """Return a finite number of at least 0 as a float."""
    if isinstance(value, str | bool) or not hasattr(value, "__float__"):
        raise InputError(f"{what} must be a number, found {value!r}")
    try:
        number = float(value)
    except (TypeError, ValueError, OverflowError):
        raise InputError(f"{what} must be a number, found {value!r}") from None
    if not (math.isfinite(number) and number >= 0):
        raise InputError(f"{what} must be a finite number of at least 0, found {number:g}")
    return number
