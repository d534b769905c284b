"""Disutilities of what is left of an amount, and the exact grid of costs on which amounts are counted."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from fractions import Fraction
from types import MappingProxyType
from typing import Any

from statehtn.core.law_grid import Grid, LawGrid
from statehtn.core.policy_problem import PolicyProblem
from statehtn.errors import UnsupportedError
from statehtn.limits import Limits
from statehtn.model.fraction import fraction_of
from statehtn.risk import ConditionalValueAtRisk, Deadline, MeanCvar, Objective, Overrun, Piecewise, Quantile

MOST_LEFT = 2**31 - 2
"""Steps of an amount."""
MOST_STEPS = 2**22
"""Of the cost of an action, and up to the last point of a utility that is linear in pieces."""


@dataclass(frozen=True, slots=True)
class Disutility:
    """The disutility of what is left of an amount in the end, in steps, as the core takes it.

    Args:
        first: what is left to begin with; None where it is chosen from outside.
        of_left: by what is left, from 0 on.
        gain: by so much it falls for each step that is left beyond that.
        beyond: what is spent beyond the amount costs this, and ...
        slope: ... this for each step.
    """

    first: int | None
    of_left: tuple[float, ...] = (0.0,)
    gain: float = 0.0
    beyond: float = 0.0
    slope: float = 0.0


def _deadline(objective: Deadline, step: Fraction) -> Disutility:
    return Disutility(math.floor(fraction_of(objective.budget) / step), beyond=1.0)


def _overrun(objective: Overrun, step: Fraction) -> Disutility:
    first, rest = divmod(fraction_of(objective.budget), step)
    return Disutility(int(first), beyond=-float(rest), slope=float(step))


def _piecewise(objective: Piecewise, step: Fraction) -> Disutility:
    last = math.ceil(fraction_of(objective.points[-1][0]) / step)
    if last >= MOST_STEPS:
        raise UnsupportedError(
            f"a policy by '{objective}' depends on what was spent, in steps of {float(step):g}: there are more than "
            f"{MOST_STEPS} of them up to its last point, which is too many; round the costs"
        )
    value = [-objective.finite_utility(float(step * steps)) for steps in range(last + 2)]
    return Disutility(last, tuple(reversed(value[:-1])), beyond=value[-2], slope=value[-1] - value[-2])


def _quantile(objective: Quantile, step: Fraction) -> Disutility:  # noqa: ARG001
    return Disutility(None, beyond=1.0)


def _mean_cvar(objective: ConditionalValueAtRisk | MeanCvar, step: Fraction) -> Disutility:
    """Return `(1 - weight) C + weight max(C - t, 0) / (1 - level)` but for `(1 - weight) t`."""
    mean = (1 - objective.weight) * float(step)
    slope = mean + objective.weight * float(step) / (1 - objective.level)
    return Disutility(None, gain=mean, slope=slope)


DISUTILITIES: Mapping[type[Any], Callable[[Any, Fraction], Disutility]] = MappingProxyType(
    {
        Deadline: _deadline,
        Overrun: _overrun,
        Piecewise: _piecewise,
        Quantile: _quantile,
        ConditionalValueAtRisk: _mean_cvar,
        MeanCvar: _mean_cvar,
    }
)
"""Objectives by which the best policy depends on what was spent."""


def exact_grid(problem: PolicyProblem, objective: Objective, failure_cost: float | None, limits: Limits) -> LawGrid:
    """Return the laws of all actions on a grid on which the cost of a failure is, too.

    Raises:
        UnsupportedError: costs are not whole multiples of one step.
    """
    found = LawGrid.first(problem.grounding, limits)
    exact = found.grid.exact_step
    if exact is None or found.largest > exact * MOST_STEPS:
        raise UnsupportedError(
            f"a policy by '{objective}' depends on what was spent: all costs must be multiples of one step that is"
            " not too small for them, and no continuous ones"
        )
    if not found.grid.is_exact:
        found = LawGrid(problem.grounding, Grid(exact, exact, found.grid.tail), limits)
    if failure_cost is None or not math.isfinite(failure_cost):
        return found
    step, failure = found.grid.step, fraction_of(failure_cost)
    unit = math.lcm(step.denominator, failure.denominator)
    common = Fraction(math.gcd(int(step * unit), int(failure * unit)), unit)
    if common == step:
        return found
    return LawGrid(problem.grounding, Grid(common, common, found.grid.tail), limits)
