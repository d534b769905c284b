"""The policy of least entropic value at risk of those that searches have found."""

from __future__ import annotations

import math

from statehtn.core.policy_outcome import PolicyOutcome
from statehtn.errors import StateHtnError
from statehtn.found_plan import SECONDS_TO_VALIDATE
from statehtn.limits import Limits, watched
from statehtn.model.cost.numerics.evar import least_bound
from statehtn.policies.chain import Chain
from statehtn.policies.total_cost import PolicyCost

ACCURACY = 1e-4
"""Of the logarithm of x at most: a value is level there, so that it is good to the square of that."""


class BestByEvar:
    """The best policy known, with its value.

    Args:
        level: of the entropic value at risk.
        failure: what failing costs on top of what was spent; 0 where no run fails.
        precision: how far from the best a policy may be that counts as optimal, as a part of max(1, value).
    """

    def __init__(self, level: float, failure: float, precision: float) -> None:
        self.level = level
        self.failure = failure
        self.precision = precision
        self.found: PolicyOutcome | None = None
        self.value = math.inf
        """At least its value, and more by a small part of the precision at most; infinite where none is known."""
        self.x = 0.0
        """1 / alpha of the agent whose certainty equivalent the value comes from; 0 where it is the largest cost."""

    def consider(self, found: PolicyOutcome, limits: Limits) -> None:
        """Take a policy for the best one, if it is.

        Raises:
            LimitReached: a limit was reached, with a little grace.
        """
        if found.graph is None or self._has(found):
            return
        cost = PolicyCost(Chain(found.graph.flat), self.failure)
        try:
            with watched(limits.with_grace(SECONDS_TO_VALIDATE, is_over=found.stopped is not None)):
                if math.isinf(cost.mean):
                    return
                accuracy = min(ACCURACY, math.sqrt(self.precision) / 10)
                value, x = least_bound(cost, self.level, self.x, accuracy)
        except StateHtnError:  # it is infinite, or cannot be computed
            return
        if value < self.value:
            self.value, self.x, self.found = value, x, found

    def _has(self, found: PolicyOutcome) -> bool:
        """Tell whether it is the same policy."""
        if self.found is None or self.found.graph is None or found.graph is None:
            return False
        return self.found.graph.flat == found.graph.flat

    @property
    def enough(self) -> float:
        """A bound of all policies that proves this one."""
        return self.value - self.precision * max(1.0, abs(self.value))

    def say_what_is_infinite(self, found: PolicyOutcome) -> None:
        """Raise what keeps a policy from having a value.

        Raises:
            InputError: it has none.
        """
        assert found.graph is not None
        least_bound(PolicyCost(Chain(found.graph.flat), self.failure), self.level)
