"""The searches for the k best plans, on one scale after the other, with what they have proven together."""

from __future__ import annotations

import math
import time
from collections.abc import Callable

import statehtn._relax as _relax
from statehtn.core.grounding import STOPPED, Grounding
from statehtn.core.pricing import FoundPlan, RiskCosts
from statehtn.core.progress import TopProgress
from statehtn.core.scale import TOLERANCE, Scale
from statehtn.limits import Limits
from statehtn.model.status import Status

Key = tuple[int, ...]
"""What no two plans have in common: their actions, in the order of their execution or sorted."""


class TopRun:
    """The best plans that are known, in the order of their costs, and a bound of all others.

    `bound` holds for every plan that is not among the `plans`, on whatever scale it was proven: a search proves it of
    all that it has not found, what it has found is compared by its own cost, and what is taken off the end of the list
    costs no less than the last plan. It is infinite where there are no others.
    """

    def __init__(
        self,
        grounding: Grounding,
        costs: RiskCosts,
        options: _relax.TopPlansOptions,
        limits: Limits,
        progress: Callable[[TopProgress], None] | None,
    ) -> None:
        self.grounding = grounding
        self.labels = _labels(grounding)
        self.costs = costs
        self.prices = costs.on(Scale.first(costs.bounds()))
        self.options = options
        self.limits = limits
        self.progress = progress
        self.started = time.monotonic()
        self.plans: list[FoundPlan] = []
        self.bound: float | None = None
        self.stopped: Status | None = None
        self.done: list[_relax.TopPlansStatistics] = []
        self._found: dict[Key, FoundPlan] = {}

    @property
    def proven(self) -> int:
        """How many plans, counted from the first, are proven to be the best: no other costs less."""
        if self.bound is None:
            return 0
        return sum(plan.cost * (1 - TOLERANCE) <= self.bound for plan in self.plans)

    @property
    def lower_bound(self) -> float | None:
        """What every plan costs at least that is not among the plans; None if there is none, or nothing is known."""
        if self.bound is None or math.isinf(self.bound):
            return None
        return min(self.bound, self.plans[-1].cost) if len(self.plans) == self.options.count else self.bound

    def search(self) -> None:
        """Search on the present scale."""
        limits = self.limits
        result = _relax.top_plans(
            self.grounding.handle,
            self.prices.units,
            self.labels,
            self.options,
            None if limits.deadline is None else limits.deadline - time.monotonic(),
            None if limits.memory_mb is None else int(limits.memory_mb * 1e6),
            None if self.progress is None else self._report,
        )
        self.done.append(result.statistics)
        self.stopped = None if result.stop is None else STOPPED[result.stop]
        self.bound = math.inf if result.is_all else self._bound_with(result.statistics.lower_bound)
        for trace in result.plans:
            plan = self.costs.of_plan(trace)
            known = self._found.setdefault(self._key(plan), plan)
            if plan.cost < known.cost:
                self._found[self._key(plan)] = plan
        self.plans = sorted(self._found.values(), key=lambda plan: plan.cost)[: self.options.count]

    def sharpen(self) -> bool:
        """Take a finer scale, or one with a higher cap, where something is left to prove; returns whether it is."""
        is_full = len(self.plans) == self.options.count
        bound = self.bound or 0.0
        if self.stopped or math.isinf(bound) or (is_full and self.proven == len(self.plans)):
            return False
        last = self.plans[-1] if is_full else None  # without it, sums have left the range of fixed point
        scale = Scale.after(last.cost, bound, last.steps) if last else Scale.after(None, bound)
        if scale == self.prices.scale:
            return False
        self.prices = self.costs.on(scale)
        return True

    def _key(self, plan: FoundPlan) -> Key:
        labels = (self.labels[action] for action in plan.actions)
        own = [label for label in labels if label is not None]
        return tuple(own if self.options.distinct == _relax.Distinct.Sequence else sorted(own))

    def _bound_with(self, units: int | None) -> float | None:
        bound = None if units is None else self.prices.scale.cost(units)
        return max((known for known in (self.bound, bound) if known is not None), default=None)

    def _report(self, statistics: _relax.TopPlansStatistics) -> None:
        """Tell the user's callback how far the search has come."""
        assert self.progress is not None
        everything = [*self.done, statistics]
        self.progress(
            TopProgress(
                time.monotonic() - self.started,
                sum(one.expanded for one in everything),
                sum(one.generated for one in everything),
                sum(one.evaluated for one in everything),
                self._bound_with(statistics.lower_bound),
                max(len(self.plans), statistics.found),
                max(self.proven, statistics.proven),
            )
        )


def _labels(grounding: Grounding) -> list[int | None]:
    """Return a number for every ground action, the same for the cases of one action; None for an artificial one."""
    numbers: dict[tuple[int, tuple[int, ...]], int] = {}
    handle = grounding.handle
    return [
        None
        if grounding.encoding.actions[schema] is None
        else numbers.setdefault((schema, tuple(handle.action_arguments(action))), len(numbers))
        for action, schema in enumerate(handle.action_schema)
    ]
