"""Which valuation in the core stands for an objective."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from types import MappingProxyType
from typing import Any

from statehtn.core.budget_labels import BudgetLabels
from statehtn.core.correlated_labels import correlated_labels
from statehtn.core.exponential_labels import ExponentialLabels
from statehtn.core.grounding import Grounding
from statehtn.core.labels import Labels
from statehtn.core.law_labels import LawLabels
from statehtn.core.law_objectives import OBJECTIVES
from statehtn.core.mean_deviation_labels import MeanDeviationLabels
from statehtn.core.price_labels import PriceLabels
from statehtn.core.switches import LabelSwitches
from statehtn.errors import UnsupportedError
from statehtn.limits import Limits
from statehtn.risk import AdditiveObjective, Exponentials, MeanDeviation, OneSwitch
from statehtn.risk.keep import Keep
from statehtn.risk.objective import Objective

Constructor = Callable[[Grounding, Any, LabelSwitches, Limits], Labels]


VALUATIONS: Mapping[type, Constructor] = MappingProxyType(
    {
        OneSwitch: ExponentialLabels,
        Exponentials: ExponentialLabels,
        MeanDeviation: MeanDeviationLabels,
        **dict.fromkeys(OBJECTIVES, LawLabels),
    }
)
"""By the class of an objective whose prices do not add up: how its labels are made."""


def labels_of(
    grounding: Grounding, objective: Objective, keep: Sequence[Keep], switches: LabelSwitches, limits: Limits
) -> Labels:
    """Return how plans are compared in the core by an objective, of those that keep budgets.

    Raises:
        UnsupportedError: there is no label search by it.
        InputError: a cost has no finite price for it; the message names the action.
        LimitReached: a limit was reached.
    """
    if grounding.has_scenarios:
        return correlated_labels(grounding, objective, keep, switches, limits)
    labels: Labels
    if isinstance(objective, AdditiveObjective):
        labels = PriceLabels(grounding, objective, limits)
    elif type(objective) in VALUATIONS:
        labels = VALUATIONS[type(objective)](grounding, objective, switches, limits)
    else:
        raise UnsupportedError(f"there is no label search by the objective '{objective}'")
    return BudgetLabels(labels, keep, switches, limits) if keep else labels
