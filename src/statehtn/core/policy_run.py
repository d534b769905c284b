"""Runs of the policy search in the core, and what they have found together."""

from __future__ import annotations

import math
import time
from abc import ABC, abstractmethod
from collections.abc import Callable

import statehtn._relax as _relax
from statehtn.core.grounding import STOPPED
from statehtn.core.policy_laws import BranchLaws
from statehtn.core.policy_outcome import PolicyOutcome
from statehtn.core.policy_problem import PolicyProblem
from statehtn.core.policy_trace import PolicyReader
from statehtn.core.pricing import ROUNDING
from statehtn.core.progress import Progress, SearchProgress
from statehtn.effort import SearchEffort
from statehtn.limits import Limits
from statehtn.model.status import Status

Watch = Callable[[SearchProgress], None] | None


class PolicyRun(ABC):
    """A search for the best policy by one objective: bounds of its value, and the policy.

    Args:
        problem: the ground problem.
        precision: how much of its value, or of 1 if that is more, a policy that is called optimal may be worse.
        watch: is called while the search goes on.
    """

    recursion = _relax.Recursion.Expected
    worth_unit = 1.0
    """The value of a unit of what the core minimises."""
    breaks_ties = False
    is_infinite = False
    """Whether nodes were found from which every policy that is done for certain costs more than can be expected."""
    is_undecided = False

    def __init__(self, problem: PolicyProblem, precision: float, watch: Watch) -> None:
        self.problem = problem
        self.precision = precision
        self.watch = watch
        self.started = time.monotonic()
        self.effort = SearchEffort()
        self.stopped: Status | None = None

    @property
    def options(self) -> _relax.PolicySearchOptions:
        """What the core is asked for."""
        options = _relax.PolicySearchOptions()
        options.recursion = self.recursion
        options.precision = self.precision / 2
        options.unit = self.worth_unit
        options.breaks_ties = self.breaks_ties
        return options

    @abstractmethod
    def outcome(self, limits: Limits) -> PolicyOutcome:
        """Search, and return what was found."""

    def start(self, run: _relax.PolicyRun, limits: Limits, left: int = 0) -> _relax.PolicyStatistics:
        """Let a run begin, or go on from another amount; returns its statistics."""
        result = run.run(left, *limits.left(), None if self.watch is None else self._report)
        self.effort = effort_of(result.statistics)
        self.stopped = None if result.stop is None else STOPPED[result.stop]
        self.is_infinite = self.is_infinite or result.is_infinite
        self.is_undecided = self.is_undecided or result.is_undecided
        return result.statistics

    def values(self, lower: float, upper: float) -> tuple[float | None, float | None]:
        """Return bounds of the value from bounds of the worth, which are good but for rounding."""
        low, high = lower * self.worth_unit, upper * self.worth_unit
        low -= ROUNDING * abs(low) if math.isfinite(low) else 0.0
        high += ROUNDING * abs(high) if math.isfinite(high) else 0.0
        return None if math.isinf(low) else low, None if math.isinf(high) else high

    def finished(
        self, lower: float, upper: float, run: _relax.PolicyRun, laws: BranchLaws, has_policy: bool
    ) -> PolicyOutcome:
        """Return the outcome of a search whose policy is the last one of a run."""
        low, high = self.values(lower, upper)
        if not has_policy:
            status = Status.UNSOLVABLE if lower == math.inf else self.stopped or Status.GAVE_UP
            return PolicyOutcome(status, self.stopped, low, None, None, self.effort)
        assert high is not None
        slack = self.precision * max(1.0, abs(high))
        is_optimal = low is not None and high - low <= slack
        status = Status.OPTIMAL if is_optimal else Status.SOLVED
        reader = PolicyReader(self.problem.grounding, run, laws)
        stopped = None if is_optimal else self.stopped
        return PolicyOutcome(status, stopped, low, high, reader.graph, self.effort, plan_of=reader.plan_of)

    def _report(self, statistics: _relax.PolicyStatistics) -> None:
        assert self.watch is not None
        low, high = self.values(statistics.lower, statistics.upper)
        self.watch(Progress(time.monotonic() - self.started, effort_of(statistics), low, high))


def effort_of(statistics: _relax.PolicyStatistics) -> SearchEffort:
    """Return the effort of a run in the core."""
    return SearchEffort(statistics.expanded, statistics.generated, statistics.evaluated, statistics.dead_ends)
