"""Labels of several sums: what they have in common, and the searches with one price that come before theirs."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Iterator, Sequence

import statehtn._relax as _relax
from statehtn.core.finite_prices import FinitePrices, Mix, in_units
from statehtn.core.grounding import Grounding
from statehtn.core.labels import Labels, Support
from statehtn.core.pricing import PricedProblem
from statehtn.core.searches import SEARCHES, core_options
from statehtn.core.staged_run import StagedRun
from statehtn.core.switches import LabelSwitches, SearchSwitches
from statehtn.limits import Limits
from statehtn.model.cost.scenario_cost import sum_of
from statehtn.model.status import Status
from statehtn.risk.objective import Objective

MOST_SEARCHES = 8
"""With one price, before the label search."""
MOST_MIXES = 2
"""At which nodes are bounded. The first one saves half of the labels or more, the second up to a tenth of the rest."""

SWITCHES = ("bound_mixes", "compare_boxes", "compare_envelopes", "use_cutoff")
"""The fields of `LabelSwitches` that the core has under the same names."""


CoreMix = tuple[_relax.PricedProblem, Sequence[float]]
"""A mix in whole units, and the weights of the prices in theirs."""


class FiniteLabels(Labels):
    """Labels of several sums of prices, whose objective rises in each of the sums.

    The first searches have one price for each action, a mix of the others. Each finds a plan, and a bound of all plans.
    They end with one that finds a plan again; what is left to prove then is for the label search.

    Args:
        grounding: the ground problem.
        objective: what is minimised.
        problems: the ground problem at each of the prices.
        switches: refinements to leave out.
        bounds_mixes: whether the core bounds nodes at mixes of the prices.
    """

    def __init__(
        self,
        grounding: Grounding,
        objective: Objective,
        problems: Sequence[PricedProblem],
        switches: LabelSwitches,
        bounds_mixes: bool,
    ) -> None:
        super().__init__(grounding, objective)
        self._prices = FinitePrices(grounding, problems)
        self._switches = switches
        self._bounds_mixes = bounds_mixes
        self._mixes: list[Mix] = []
        self._least = [0.0] * len(problems)  # by price, proven of every plan
        self._largest = [0.0] * len(problems)  # of the plans that were found

    @abstractmethod
    def _core(
        self, prices: Sequence[_relax.PricedProblem], mixes: Sequence[CoreMix], options: _relax.FiniteOptions
    ) -> _relax.Valuation:
        """Return the valuation in the core, of prices on their scales and mixes of them."""

    @abstractmethod
    def _next_weights(self, points: Sequence[Sequence[float]], values: Sequence[float]) -> list[float]:
        """Return weights of the prices for the next search with one price, up to a factor.

        Args:
            points: the sums of the plans that were found so far.
            values: theirs.
        """

    @property
    def valuation(self) -> _relax.Valuation:
        """The sums on their scales, and the latest mixes."""
        options = _relax.FiniteOptions()
        for name in SWITCHES:
            setattr(options, name, getattr(self._switches, name))
        mixes = [(self._prices.handle_of(mix), mix.core_weights) for mix in self._mixes[:MOST_MIXES]]
        return self._core(self._prices.handles(), mixes, options)

    def refine(self, limits: Limits) -> bool:  # noqa: ARG002
        """Take units that fit the plans that were found, if these are others."""
        if not self._prices.fit(self._largest):
            return False
        self._mixes = [self._prices.mix(mix.weights) for mix in self._mixes]
        return True

    def value(self, trace: _relax.SearchResult) -> float:
        """Return the value of a plan that was found; the law of its cost is not needed."""
        point = self._prices.point(trace)
        self._largest = [max(known, number) for known, number in zip(self._largest, point, strict=True)]
        laws, part_laws = self.grounding.laws, self.grounding.part_laws
        parts = (*(laws[one] for one in trace.actions), *(part_laws[one] for one in trace.due_parts))
        return self.objective.value(sum_of(parts))

    def support(self, limits: Limits, share: float = 0.25) -> Iterator[Support]:
        """Yield what searches with one price for each action find, and what follows of every plan."""
        points: list[list[float]] = []
        values: list[float] = []
        weights = [1.0, *([0.0] * (len(self._prices.problems) - 1))]
        for _ in range(MOST_SEARCHES if self._switches.one_price_first else 0):
            mix = self._prices.mix(weights)
            run = StagedRun(mix.problem, limits.for_a_part(share))
            options = core_options(SEARCHES["astar"][0], self.grounding, "auto", 1.0, SearchSwitches())
            *_, outcome = run.outcomes([options])
            found = outcome.plans.results
            stopped = None if outcome.stopped is Status.TIME_LIMIT else outcome.stopped
            bound = None if outcome.lower_bound is None else self._bound(mix, outcome.lower_bound, run.prices.handle)
            yield Support(found, bound, outcome.effort, stopped, outcome.status is Status.UNSOLVABLE)
            if not found or (point := self._prices.point(found[0])) in points:
                break
            points.append(point)
            values.append(self.value(found[0]))
            weights = self._next_weights(points, values)

    def _bound(self, mix: Mix, cost: float, handle: _relax.PricedProblem) -> float:
        """Take up that no plan costs less than this at a mix; return a lower bound of the value of every plan.

        What has cost nothing so far has no need of the prices themselves: any will do.
        """
        positive = [price for price, weight in enumerate(mix.weights) if weight > 0]
        mixes: list[CoreMix] = []
        if len(positive) == 1:
            self._least[positive[0]] = cost / mix.weights[positive[0]]
        elif self._bounds_mixes:
            mixes.append((handle, mix.core_weights))
            self._mixes.insert(0, mix)
        core = self._core([handle] * len(self._least), mixes, _relax.FiniteOptions())
        least = [self._prices.units(price, known) for price, known in enumerate(self._least)]
        return _relax.value_of(core.bound(core.start(), [*least, *(in_units(cost, mix.exponent) for _ in mixes)]))
