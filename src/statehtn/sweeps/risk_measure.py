"""Measures of risk that plans are compared by beside their mean, and the objectives that find the best trade-offs."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Any

from statehtn.errors import UsageError
from statehtn.expected import one_of, shown
from statehtn.model.cost.law import CostLaw
from statehtn.risk import ConditionalValueAtRisk, Deadline, MeanCvar, MeanDeviation, Neutral, Objective, objective
from statehtn.sweeps.prices import Variance

FORMS = "'cvar 0.95', 'deadline 25' or 'deviation'"


@dataclass(frozen=True, slots=True)
class RiskMeasure:
    """What a frontier has beside the mean.

    Args:
        name: the text form.
        of: the risk of a law.
        least: the objective whose best plan has the least risk; None where budgets are kept instead of mixing.
        mixed: the objective whose value is, but for a factor, `(1 - weight) mean + weight risk`, and that factor;
            the weight is above 0 and below 1.
        budget: of a deadline; else None.
    """

    name: str
    of: Callable[[CostLaw], float]
    least: Objective
    mixed: Callable[[float], tuple[Objective, float]]
    budget: float | None = None


def _cvar(level: str) -> RiskMeasure:
    wanted = objective(f"cvar {level}")
    assert isinstance(wanted, ConditionalValueAtRisk)
    return RiskMeasure(str(wanted), wanted.value, wanted, lambda weight: (MeanCvar(wanted.level, weight), 1.0))


def _deviation() -> RiskMeasure:
    def mixed(weight: float) -> tuple[Objective, float]:
        return MeanDeviation(weight / (1 - weight)), 1 - weight

    return RiskMeasure("deviation", lambda law: law.standard_deviation, Variance(), mixed)


def _deadline(budget: str) -> RiskMeasure:
    wanted = objective(f"deadline {budget}")
    assert isinstance(wanted, Deadline)

    def mixed(_: float) -> tuple[Objective, float]:
        return Neutral(), 1.0

    return RiskMeasure(str(wanted), wanted.value, wanted, mixed, wanted.budget)


MEASURES: Mapping[str, tuple[Callable[..., RiskMeasure], int]] = MappingProxyType(
    {"cvar": (_cvar, 1), "deadline": (_deadline, 1), "deviation": (_deviation, 0)}
)
"""By name: what makes a measure of the words that follow, and how many these are."""


def risk_measure(text: Any) -> RiskMeasure:
    """Return a measure of risk from its text form.

    Raises:
        UsageError: there is none like that, or its number is out of range.
    """
    if not isinstance(text, str) or not text.split():
        raise UsageError(f"the risk of a frontier is a text such as {FORMS}, found {shown(text)}")
    name, *words = text.split()
    make, count = MEASURES[one_of(name, MEASURES, "risk of a frontier")]
    if len(words) != count:
        raise UsageError(f"the risk of a frontier is {FORMS}, found '{text}'")
    return make(*words)
