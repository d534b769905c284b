"""Labels of a disutility that is a linear term and exponentials: the mean, and an exponential mean for each slope."""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import chain
from typing import cast

import statehtn._relax as _relax
from statehtn.core.finite_labels import CoreMix, FiniteLabels
from statehtn.core.grounding import Grounding
from statehtn.core.hull import best_mean
from statehtn.core.pricing import check_exponent, price
from statehtn.core.switches import LabelSwitches
from statehtn.limits import Limits
from statehtn.risk import Attitude, Exponential, FiniteObjective, Neutral
from statehtn.risk.objective import Objective


class ExponentialLabels(FiniteLabels):
    """Labels of the certainty equivalent of such a disutility.

    Args:
        grounding: the ground problem.
        objective: its disutility.
        switches: refinements to leave out.
        limits: they hold while actions are priced.

    Raises:
        UsageError: a slope times the costs is too large.
        InputError: a cost has no finite price; the message names the action.
        LimitReached: a limit was reached.
    """

    def __init__(
        self, grounding: Grounding, objective: FiniteObjective, switches: LabelSwitches, limits: Limits
    ) -> None:
        self._linear = objective.linear
        self._terms = objective.terms
        agents = [Neutral()] if self._linear > 0 else []
        problems = [price(grounding, agent, limits) for agent in agents]
        problems += [price(grounding, exponential_agent(term.slope), limits) for term in self._terms]
        for term, problem in zip(self._terms, problems[len(agents) :], strict=True):
            check_exponent(
                objective, term.slope, max((one.cost for one in chain(problem.actions, problem.parts)), default=0.0)
            )
        self._is_convex = all(term.slope > 0 for term in self._terms)
        super().__init__(grounding, cast("Objective", objective), problems, switches, self._is_convex)

    def _core(
        self, prices: Sequence[_relax.PricedProblem], mixes: Sequence[CoreMix], options: _relax.FiniteOptions
    ) -> _relax.Valuation:
        exponents = self._prices.exponents
        return _relax.ExponentialSums(tuple(prices), exponents, self._linear, self._terms, tuple(mixes), options)

    def _next_weights(self, points: Sequence[Sequence[float]], values: Sequence[float]) -> list[float]:
        """Return the tangent of the disutility where it is the least so far.

        Where it is convex that may be a mean of several plans, which is none. A search with the tangent for prices
        finds a plan that is below it, or proves that no plan is better than that mean: so if it is the mean of a single
        plan, this is the best of all.
        """
        return self._gradient(
            best_mean(points, self._gradient) if self._is_convex else points[values.index(min(values))]
        )

    def _gradient(self, point: Sequence[float]) -> list[float]:
        """Return the derivatives of the disutility, divided by the largest of them."""
        first = 1 if self._linear > 0 else 0
        logarithms = [math.log(self._linear)] if first else []
        logarithms += [
            log_weight + slope * cost + math.log(abs(slope))
            for (slope, log_weight), cost in zip(self._terms, point[first:], strict=True)
        ]
        largest = max(logarithms)
        return [math.exp(logarithm - largest) for logarithm in logarithms]


def exponential_agent(slope: float) -> Exponential:
    """Return the agent whose prices are the exponential means of this slope."""
    return Exponential(Attitude.AVERSE if slope > 0 else Attitude.SEEKING, abs(slope))
