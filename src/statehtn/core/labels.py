"""What a family of objectives brings along for a label search: a valuation, and what its worths are."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from functools import partial
from itertools import chain

import statehtn._relax as _relax
from statehtn.core.grounding import Grounding
from statehtn.core.pricing import price
from statehtn.core.searches import SEARCHES, core_options
from statehtn.core.staged_run import StagedRun
from statehtn.core.switches import SearchSwitches
from statehtn.effort import SearchEffort
from statehtn.limits import Limits
from statehtn.model.cost.distribution import CostDistribution
from statehtn.model.cost.law import CostLaw
from statehtn.model.cost.scenario_cost import total_of
from statehtn.model.status import Status
from statehtn.risk.neutral import Neutral
from statehtn.risk.objective import Objective
from statehtn.risk.utility import Utility
from statehtn.risk.valued import value_of_total

ROUNDED_DOWN = 1 - 2.0**-40
"""More than what a proven bound may be too high by rounding."""


@dataclass(frozen=True, slots=True)
class Support:
    """What searches with a single price for each action say of an objective.

    Args:
        traces: plans that they have found; the best of them is an incumbent of the label search.
        bound: a proven lower bound of the value of every plan; None for none.
        effort: theirs.
        stopped: the limit of the run that ended them, if one did.
        unsolvable: whether they have proven that there is no plan.
    """

    traces: Sequence[_relax.SearchResult] = ()
    bound: float | None = None
    effort: SearchEffort = field(default_factory=SearchEffort)
    stopped: Status | None = None
    unsolvable: bool = False


class Labels(ABC):
    """How plans are compared in the core by an objective whose label is not one price, on one grid after the other.

    Args:
        grounding: the ground problem.
        objective: what is minimised.
    """

    worths_are_values = True
    """Whether worths in the core are values, in the order of whole numbers; otherwise they are units."""

    def __init__(self, grounding: Grounding, objective: Objective) -> None:
        self.grounding = grounding
        self.objective = objective

    @property
    @abstractmethod
    def valuation(self) -> _relax.Valuation:
        """The valuation on the present grid; no worth is above the value of the same plan."""

    @abstractmethod
    def refine(self, limits: Limits) -> bool:
        """Take a finer grid; returns false where there is none, since this one is exact, or as fine as can be.

        Raises:
            LimitReached: a limit was reached.
        """

    def coarsen(self, limits: Limits) -> bool:  # noqa: ARG002
        """Take a coarser grid, for which less memory will do; returns false where there is none.

        Raises:
            LimitReached: a limit was reached.
        """
        return False

    def support(self, limits: Limits, share: float = 0.25) -> Iterator[Support]:
        """Yield what searches with a single price for each action find; here A* by the expected cost, or greedy search.

        Args:
            limits: those of the run.
            share: of the time that is left for each of them; they are no more than a beginning.
        """
        is_answered = False
        for support in self.cheapest(Neutral(), limits, share, implied=self._value_of_mean):
            is_answered = is_answered or bool(support.traces) or support.unsolvable
            yield support
        if not is_answered:
            yield from self.cheapest(Neutral(), limits, share, "greedy")

    def _value_of_mean(self, least: float) -> float | None:
        """Return a lower bound of the value of every plan, none of which has a mean below the least one.

        An objective that is averse to risk finds no law better than its mean for certain.
        """
        if not self.objective.concave:
            return None
        return self.objective.value(CostDistribution.certain(least * ROUNDED_DOWN))

    def cheapest(
        self,
        utility: Utility,
        limits: Limits,
        share: float,
        search: str = "astar",
        implied: Callable[[float], float | None] = lambda _: None,
    ) -> Iterator[Support]:
        """Yield what a search by the prices of a utility finds.

        Args:
            utility: its certainty equivalents are the prices.
            limits: those of the run.
            share: of the time that is left.
            search: a name in `SEARCHES`.
            implied: the lower bound of all values that follows from one of all prices; None for none.

        Raises:
            InputError: a cost has no finite price; the message names the action.
            LimitReached: a limit was reached.
        """
        run = StagedRun(price(self.grounding, utility, limits), limits.for_a_part(share))
        for outcome in run.outcomes([core_options(SEARCHES[search][0], self.grounding, "auto", 1.0, SearchSwitches())]):
            stopped = None if outcome.stopped is Status.TIME_LIMIT else outcome.stopped
            bound = None if outcome.lower_bound is None else implied(outcome.lower_bound)
            unsolvable = outcome.status is Status.UNSOLVABLE
            yield Support(outcome.plans.results, bound, outcome.effort, stopped, unsolvable)

    def law(self, trace: _relax.SearchResult) -> CostLaw:
        """Return the law of the total cost of a plan that was found."""
        laws, part_laws = self.grounding.laws, self.grounding.part_laws
        return total_of([*(laws[one] for one in trace.actions), *(part_laws[one] for one in trace.due_parts)])

    def value(self, trace: _relax.SearchResult) -> float:
        """Return the value of a plan that was found, as exactly as can be."""
        grounding = self.grounding
        actions = ((grounding.laws[one], partial(grounding.action_text, one)) for one in trace.actions)
        parts = ((grounding.part_laws[one], partial(grounding.cost_part_text, one)) for one in trace.due_parts)
        return value_of_total(self.objective, self.law(trace), chain(actions, parts))

    def value_of(self, worth: int) -> float:
        """Return the value that a worth in the core stands for."""
        return _relax.value_of(worth)

    def worth_of(self, value: float) -> int:
        """Return the worth in the core of a value, rounded down."""
        return _relax.order_of(value)
