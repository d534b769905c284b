"""Objectives in the core that value laws on a grid."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from fractions import Fraction
from itertools import accumulate, pairwise
from types import MappingProxyType
from typing import Any

import statehtn._relax as _relax
from statehtn.model.fraction import fraction_of
from statehtn.risk.callable_utility import CallableUtility
from statehtn.risk.cvar import ConditionalValueAtRisk
from statehtn.risk.deadline import Deadline
from statehtn.risk.disutility import FiniteObjective
from statehtn.risk.evar import EntropicValueAtRisk
from statehtn.risk.exponential import Exponential
from statehtn.risk.exponentials import Exponentials
from statehtn.risk.mean_cvar import MeanCvar
from statehtn.risk.one_switch import OneSwitch
from statehtn.risk.overrun import Overrun
from statehtn.risk.piecewise import Piecewise
from statehtn.risk.quantile import Quantile

MOST_TABLED = 2**17
"""Costs on the grid for which a Python function is asked; the utility is taken as flat beyond, which is a bound."""


MOST_STEPS = 2**1000
"""Of a cost: a float in the core, and more than any plan costs."""


def steps(cost: float, step: Fraction) -> float:
    """Return how many steps a cost has."""
    return float(min(fraction_of(cost) / step, Fraction(MOST_STEPS)))


def whole_steps(cost: float, step: Fraction) -> int:
    """Return how many whole steps there are up to a cost."""
    return min(math.floor(fraction_of(cost) / step), MOST_STEPS)


def _deadline(objective: Deadline, step: Fraction, _: float) -> _relax.LawObjective:
    return _relax.ExpectedDisutility(0.0, 0.0, [(float(whole_steps(objective.budget, step)), 1.0, 0.0)])


def _overrun(objective: Overrun, step: Fraction, _: float) -> _relax.LawObjective:
    return _relax.ExpectedDisutility(0.0, 0.0, [(steps(objective.budget, step), 0.0, float(step))])


def _piecewise(objective: Piecewise, step: Fraction, _: float) -> _relax.LawObjective:
    (first, utility), *others = objective.points
    slopes = [-slope for slope in objective.slopes]
    rises = [(later - before) * float(step) for before, later in pairwise(slopes)]
    kinks = [(steps(cost, step), 0.0, rise) for (cost, _), rise in zip(others, [*rises, 0.0], strict=True)]
    return _relax.ExpectedDisutility(-utility - slopes[0] * first, slopes[0] * float(step), kinks)


def _quantile(objective: Quantile, step: Fraction, _: float) -> _relax.LawObjective:
    return _relax.QuantileOfLaw(objective.level, float(step))


def _mean_cvar(objective: MeanCvar | ConditionalValueAtRisk, step: Fraction, _: float) -> _relax.LawObjective:
    return _relax.MeanCvarOfLaw(objective.level, objective.weight, float(step))


def _evar(objective: EntropicValueAtRisk, step: Fraction, _: float) -> _relax.LawObjective:
    return _relax.EvarOfLaw(objective.level, float(step))


def _exponential(objective: Exponential, step: Fraction, _: float) -> _relax.LawObjective:
    return _relax.DisutilityOfLaw(0.0, [(objective.slope, 0.0)], float(step))


def _exponentials(objective: FiniteObjective, step: Fraction, _: float) -> _relax.LawObjective:
    return _relax.DisutilityOfLaw(objective.linear, objective.terms, float(step))


def _callable(objective: CallableUtility, step: Fraction, reach: float) -> _relax.LawObjective:
    count = min(MOST_TABLED, math.ceil(reach / float(step)) + 1)
    table = [-utility for utility in objective.bounds(float(step * number) for number in range(count))]
    rising = list(accumulate(reversed(table), min))  # but for rounding the table is that
    return _relax.TabulatedDisutility(rising[::-1])


OBJECTIVES: Mapping[type, Callable[[Any, Fraction, float], _relax.LawObjective]] = MappingProxyType(
    {
        Deadline: _deadline,
        Overrun: _overrun,
        Piecewise: _piecewise,
        Quantile: _quantile,
        ConditionalValueAtRisk: _mean_cvar,
        MeanCvar: _mean_cvar,
        EntropicValueAtRisk: _evar,
        CallableUtility: _callable,
    }
)
"""By the class of an objective: what it is in the core, for a step of the grid and a cost up to which it is tabled."""
EXPONENTIAL: Mapping[type, Callable[[Any, Fraction, float], _relax.LawObjective]] = MappingProxyType(
    {Exponential: _exponential, OneSwitch: _exponentials, Exponentials: _exponentials}
)
"""Those of which sums of prices say as much, unless plans have to keep budgets over scenarios."""
