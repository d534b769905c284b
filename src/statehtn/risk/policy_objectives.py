"""By which objectives there is a best policy, and what failing may cost by them."""

from __future__ import annotations

import math
from collections.abc import Mapping
from types import MappingProxyType
from typing import Any

from statehtn.errors import UnsupportedError, UsageError
from statehtn.risk.deadline import Deadline
from statehtn.risk.mean_deviation import MeanDeviation
from statehtn.risk.mean_variance import MeanVariance
from statehtn.risk.objective import Objective
from statehtn.risk.objectives import OBJECTIVES, ObjectiveForm, name_in, parsed
from statehtn.risk.quantile import Quantile
from statehtn.risk.success import Success
from statehtn.risk.success_utility import SuccessUtility

PolicyObjective = Objective | Success

_NOT_MONOTONE = (
    "there are no policies that are best by an objective that may prefer a larger cost to a smaller one, since the "
    "best decision after one outcome then depends on what was decided after the others; averse, overrun or cvar agents "
    "shun risk, too, and have policies"
)
NO_POLICIES: Mapping[Any, str] = MappingProxyType(
    {
        MeanVariance: _NOT_MONOTONE,
        MeanDeviation: _NOT_MONOTONE,
        SuccessUtility: "it values a plan that counts on one outcome of each action, and a policy counts on none; "
        "statehtn plan finds the plan, and policies by 'success' are done most probably",
    }
)
"""The objectives of plans by which there is no best policy, and why."""

_SUCCESS = ObjectiveForm(str(Success()), "probability of being done (the largest one), then expected cost", Success)
POLICY_OBJECTIVES: Mapping[str, ObjectiveForm] = MappingProxyType(
    {_SUCCESS.form: _SUCCESS, **{name: form for name, form in OBJECTIVES.items() if form.make not in NO_POLICIES}}
)
"""The objectives of policies that have a text form, by name."""


def policy_objective_of(text: str) -> PolicyObjective:
    """Return an objective of policies from its text form.

    Raises:
        UsageError: there is no such objective, or a parameter is missing, superfluous or out of its range.
        UnsupportedError: it is one by which there are plans only; the message says why.
    """
    form = OBJECTIVES.get(name_in(text))
    if form is not None and form.make in NO_POLICIES:
        raise _no_policy(text, NO_POLICIES[form.make])
    return parsed(text, POLICY_OBJECTIVES)


def check_has_policies(objective: PolicyObjective) -> None:
    """Raise an error if no policy is searched for by an objective.

    Raises:
        UnsupportedError: the message says why.
    """
    for kind, reason in NO_POLICIES.items():
        if isinstance(objective, kind):
            raise _no_policy(str(objective), reason)


def _no_policy(objective: str, reason: str) -> UnsupportedError:
    return UnsupportedError(f"no policy can be found by '{objective}': {reason}")


def check_failure_cost(cost: float, objective: PolicyObjective) -> None:
    """Raise an error if a run that fails cannot cost so much, on top of what it has spent.

    Raises:
        UsageError: it is negative, infinite where that says nothing, or not asked for.
    """
    if isinstance(objective, Success):
        raise UsageError("by 'success' failing has no cost: policies are compared by how likely it is")
    if math.isnan(cost) or cost < 0:
        raise UsageError(f"the failure cost must be at least 0, or 'inf', found {cost:g}")
    if math.isinf(cost) and not isinstance(objective, Deadline | Quantile):
        raise UsageError(
            "the failure cost may be infinite for deadlines and quantiles: by 'deadline' and 'quantile' only it has a "
            f"finite value then, not by '{objective}'; without a failure cost only policies count that are done with "
            "probability 1"
        )
