"""How plans are compared in the core where their costs hang together."""

from __future__ import annotations

from collections.abc import Sequence

from statehtn.core.grounding import Grounding
from statehtn.core.labels import Labels
from statehtn.core.law_objectives import EXPONENTIAL, OBJECTIVES
from statehtn.core.price_labels import PriceLabels
from statehtn.core.scenario_exponential_labels import ScenarioExponentialLabels
from statehtn.core.scenario_labels import ScenarioLabels
from statehtn.core.switches import LabelSwitches
from statehtn.errors import UnsupportedError
from statehtn.limits import Limits
from statehtn.risk import Exponential, Exponentials, MeanDeviation, MeanVariance, Neutral, OneSwitch
from statehtn.risk.keep import Keep
from statehtn.risk.objective import Objective


def correlated_labels(
    grounding: Grounding, objective: Objective, keep: Sequence[Keep], switches: LabelSwitches, limits: Limits
) -> Labels:
    """Return how plans are compared by an objective, of those that keep budgets; see `labels_of`.

    Raises:
        UnsupportedError: the objective is not monotone: where costs hang together, wasting some in good scenarios would
            lower it. Or there is no label search by it.
        LimitReached: a limit was reached.
    """
    if not objective.monotone:
        raise UnsupportedError(
            f"'{objective}' is not monotone: where costs hang together, it could be lowered by wasting cost in good "
            f"scenarios; take an objective such as 'cvar 0.9' or 'averse 0.1'"
        )
    if isinstance(objective, Neutral) and not keep:
        return PriceLabels(grounding, objective, limits)
    if isinstance(objective, Exponential | OneSwitch | Exponentials) and not keep:
        return ScenarioExponentialLabels(grounding, objective, switches, limits)
    if isinstance(objective, Neutral) or type(objective) in OBJECTIVES or type(objective) in EXPONENTIAL:
        return ScenarioLabels(grounding, objective, keep, switches, limits)
    take = "'neutral', which is the same" if isinstance(objective, MeanDeviation | MeanVariance) else "another one"
    raise UnsupportedError(f"plans whose costs hang together are not compared by '{objective}'; take {take}")
