"""Bounds of an objective that are linear in what a plan costs in each scenario."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from operator import mul
from types import MappingProxyType
from typing import Any

from statehtn.risk.cvar import ConditionalValueAtRisk
from statehtn.risk.exponential import Exponential
from statehtn.risk.exponentials import Exponentials
from statehtn.risk.mean_cvar import MeanCvar
from statehtn.risk.neutral import Neutral
from statehtn.risk.objective import Objective
from statehtn.risk.one_switch import OneSwitch
from statehtn.risk.overrun import Overrun
from statehtn.risk.piecewise import Piecewise

ROUNDING = 2.0**-44
"""Of a constant, relative to the numbers that it is the sum of."""


@dataclass(frozen=True, slots=True)
class Tangent:
    """No value is below `constant` and the sum of the totals in all scenarios, each times its weight.

    Args:
        constant: in the objective's unit.
        weights: by scenario, at least 0, per unit of cost.
    """

    constant: float
    weights: tuple[float, ...]

    def at(self, totals: Sequence[float]) -> float:
        """Return what it is at these totals."""
        return self.constant + math.fsum(map(mul, self.weights, totals))


Totals = Sequence[float]


def tangent(objective: Objective, probabilities: Sequence[float], totals: Totals) -> Tangent | None:
    """Return a tangent of an objective that is convex in the totals; None for an objective that is not.

    Args:
        objective: what is minimised.
        probabilities: of the scenarios.
        totals: where it touches the objective, by scenario.
    """
    make = TANGENTS.get(type(objective))
    return None if make is None or not objective.concave else make(objective, probabilities, totals)


def _worst_cases(
    objective: ConditionalValueAtRisk | MeanCvar, probabilities: Sequence[float], totals: Totals
) -> Tangent:
    """Weigh the scenarios that make up the worst `1 - level` of all cases: the measure is the largest such mean.

    Where all are equally bad, they weigh what they are likely.
    """
    if min(totals) == max(totals):
        return Tangent(0.0, tuple(probabilities))
    tail = 1 - objective.level
    weights = [(1 - objective.weight) * probability for probability in probabilities]
    left = tail
    for scenario in sorted(range(len(totals)), key=lambda one: -totals[one]):
        taken = min(left, probabilities[scenario])
        weights[scenario] += objective.weight * taken / tail
        left -= taken
    return Tangent(0.0, tuple(weights))


def _expected(objective: Overrun, probabilities: Sequence[float], totals: Totals) -> Tangent:
    weights = [p if total > objective.budget else 0.0 for p, total in zip(probabilities, totals, strict=True)]
    constant = -objective.budget * math.fsum(weights)
    return Tangent(constant + ROUNDING * constant, tuple(weights))


def _utilities(objective: Piecewise, probabilities: Sequence[float], totals: Totals) -> Tangent:
    """Take the utility's piece at each total, which is nowhere below the utility, where that is concave."""
    weights: list[float] = []
    constants: list[float] = []
    for probability, total in zip(probabilities, totals, strict=True):
        piece = sum(total >= cost for cost, _ in objective.points[1:-1])
        slope, (cost, utility) = -objective.slopes[piece], objective.points[piece]
        weights.append(probability * slope)
        constants.append(-probability * utility)
        constants.append(-probability * slope * cost)
    lost = ROUNDING * math.fsum(map(abs, constants))
    return Tangent(math.fsum(constants) - lost, tuple(weights))


def _mean(_: Neutral, probabilities: Sequence[float], __: Totals) -> Tangent:
    return Tangent(0.0, tuple(probabilities))


TANGENTS: Mapping[type, Callable[[Any, Sequence[float], Totals], Tangent]] = MappingProxyType(
    {
        ConditionalValueAtRisk: _worst_cases,
        MeanCvar: _worst_cases,
        Overrun: _expected,
        Piecewise: _utilities,
        Neutral: _mean,
        Exponential: _mean,  # no certainty equivalent of an averse agent is below the mean
        OneSwitch: _mean,
        Exponentials: _mean,
    }
)
"""By the class of an objective that may be convex in the totals."""
