"""How large the cost of a failure may be beside the costs of actions."""

from __future__ import annotations

import math

from statehtn.core.grounding import Grounding
from statehtn.errors import UsageError
from statehtn.risk import Deadline, Objective, Quantile

MOST_TIMES = 1e9
"""The largest expected cost of an action: worths are told apart to 1e-13 of themselves (policy_iteration.hpp), and of
those a failure cost is a part. So differences of a ten thousandth of that cost still count."""


def check_failure_size(grounding: Grounding, objective: Objective, failure_cost: float) -> None:
    """Raise an error if rounding a failure cost would hide what actions cost, so that giving up seems to be as good.

    What is counted in steps of an amount, until it is late, is exact.

    Raises:
        UsageError: it is too large; the message says what is not.
    """
    if isinstance(objective, Deadline | Quantile) or math.isinf(failure_cost):
        return
    handle = grounding.handle
    parts = [law.mean for law in grounding.part_laws]
    means = (
        law.mean + math.fsum(parts[part] for part in range(*handle.cost_parts(action)))
        for action, law in enumerate(grounding.laws)
    )
    largest = max(means, default=0.0)
    if 0 < MOST_TIMES * largest < failure_cost:
        raise UsageError(
            f"a failure cost of {failure_cost:g} is too large beside the costs, which its rounding would hide; take at "
            f"most {MOST_TIMES * largest:.3g}, 10^9 times the largest expected cost of an action (by 'deadline' and "
            "'quantile' it may be larger, and 'inf')"
        )
