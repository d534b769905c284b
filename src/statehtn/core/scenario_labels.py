"""Labels of plans whose costs hang together: a total or a law in each scenario, valued over all of them."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from itertools import chain

import statehtn._relax as _relax
from statehtn.core.grounding import Grounding
from statehtn.core.labels import Labels, Support
from statehtn.core.law_grid import MEAN_BITS, Grid, LawGrid, Outcomes
from statehtn.core.law_labels import MOST_LIKELY, law_options
from statehtn.core.law_objectives import EXPONENTIAL, MOST_TABLED, OBJECTIVES
from statehtn.core.pricing import ROUNDING, PricedProblem, RiskCost
from statehtn.core.scenario_tangents import Tangent, tangent
from statehtn.core.scenarios import all_are_certain, given_scenarios
from statehtn.core.searches import SEARCHES, core_options
from statehtn.core.staged_run import StagedRun
from statehtn.core.switches import LabelSwitches, ScenarioSwitches, SearchSwitches, set_switches
from statehtn.limits import Limits, watched
from statehtn.model.cost.law import CostLaw
from statehtn.model.cost.scenario_cost import sum_of
from statehtn.model.status import Status
from statehtn.risk.callable_utility import CallableUtility
from statehtn.risk.deadline import Deadline
from statehtn.risk.keep import TOLERANCE, Keep
from statehtn.risk.neutral import Neutral
from statehtn.risk.objective import Objective

MOST_SEARCHES = 4
"""With one price for each action, before the label search; their tangents bound its nodes, too."""
MOST_ASKED = 8
"""Scenarios in each of which a heuristic is worth its time."""
ALL_SWITCHES = SearchSwitches()
CLOSE = 1e-9
"""A plan that costs less than another one by a smaller part is not better."""


class ScenarioLabels(Labels):
    """Totals where nothing is uncertain once the scenario is known, otherwise laws, on a grid.

    Args:
        grounding: the ground problem, in which costs hang together.
        objective: neutral, or one whose class is in `OBJECTIVES` or `EXPONENTIAL`.
        keep: budgets that plans are to keep, over all scenarios.
        switches: refinements to leave out.
        limits: they hold while laws are put on a grid.
    """

    def __init__(
        self,
        grounding: Grounding,
        objective: Objective,
        keep: Sequence[Keep],
        switches: LabelSwitches,
        limits: Limits,
    ) -> None:
        super().__init__(grounding, objective)
        self._keep = keep
        self._switches = switches
        self._limits = limits
        self._reach = 0.0  # the cost up to which a Python function is tabled
        with watched(limits):
            self._given = given_scenarios(grounding)
            self._weights = [scenario.probability for scenario in self._given]
            self._is_certain = all_are_certain(self._given)
            laws = {law for one in self._given for law in chain(one.grounding.laws, one.grounding.part_laws)}
            grid = Grid.first(laws)
        self._set_grid(grid, limits)
        first = tangent(objective, self._weights, [math.inf] * len(self._given))
        is_positive = first is not None and min(first.weights) > 0
        self._tangents = [first if first is not None and is_positive else Tangent(-math.inf, tuple(self._weights))]

    @property
    def valuation(self) -> _relax.Valuation:
        """The totals or laws on the present grid, and how the objective values them."""
        options = _relax.ScenarioOptions()
        set_switches(options, self._switches, ScenarioSwitches)
        with watched(self._limits):
            tangents = [self._tangent_in_the_core(line) for line in self._tangents]
        asks_scenarios = len(self._given) <= MOST_ASKED
        how = asks_scenarios, self._objective_in_the_core(), self._budgets_in_the_core(), options
        if self._is_certain:
            return _relax.ScenarioTotals([grid.least for grid in self._grids], self._weights, tangents, *how)
        scenarios = [(p, grid.least, grid.costs) for p, grid in zip(self._weights, self._grids, strict=True)]
        return _relax.ScenarioLaws(scenarios, tangents, *how, law_options(self._switches))

    def refine(self, limits: Limits) -> bool:
        """Take a finer grid, or ask a Python function for larger costs."""
        finer = self._grid.finer(self._largest)
        if finer is not None:
            self._set_grid(finer, limits)
            return True
        is_tabled = isinstance(self.objective, CallableUtility)
        self._reach = 2 * (self._reach or self._largest)
        return is_tabled and self._reach <= MOST_TABLED * float(self._grid.step)

    def coarsen(self, limits: Limits) -> bool:
        """Take a coarser grid; not where labels are totals, which are as large on any grid."""
        coarser = None if self._is_certain else self._grid.coarser(self._largest)
        if coarser is not None:
            self._set_grid(coarser, limits)
        return coarser is not None

    def support(self, limits: Limits, share: float = 0.25) -> Iterator[Support]:
        """Yield what searches with one price for each action find: by the mean, and by tangents of the objective.

        Each of them has the tangent at the plan that the one before has found, and proves that no plan is below it.
        """
        best = math.inf  # at the present tangent: what the plan that it touches costs
        for _ in range(MOST_SEARCHES if self._switches.tangent_bound else 1):
            line = self._tangents[-1]
            with watched(limits):
                problem = self._priced(line)
            run = StagedRun(problem, limits.for_a_part(share))
            *_, outcome = run.outcomes([core_options(SEARCHES["astar"][0], self.grounding, "auto", 1.0, ALL_SWITCHES)])
            stopped = None if outcome.stopped is Status.TIME_LIMIT else outcome.stopped
            found, least = outcome.plans.results, outcome.lower_bound
            is_bound = least is not None and math.isfinite(line.constant) and self._switches.tangent_bound
            bound = line.constant + least if is_bound and least is not None else None
            yield Support(found, bound, outcome.effort, stopped, outcome.status is Status.UNSOLVABLE)
            if not found:
                return
            totals = [law.mean for law in self._laws_given(found[0])]
            self._note_reach(found[0])
            following = tangent(self.objective, self._weights, totals)
            if following is None or following in self._tangents or line.at(totals) >= best * (1 - CLOSE):
                return
            best = following.at(totals)
            self._tangents.append(following)

    def _set_grid(self, grid: Grid, limits: Limits) -> None:
        self._grid = grid
        known: dict[CostLaw, Outcomes] = {}
        self._grids = [LawGrid(scenario.grounding, grid, limits, known) for scenario in self._given]

    @property
    def _largest(self) -> float:
        return max(grid.largest for grid in self._grids)

    def _laws_given(self, trace: _relax.SearchResult) -> list[CostLaw]:
        """Return the law of a plan in each scenario."""
        return [
            sum_of(
                [
                    *(given.grounding.laws[one] for one in trace.actions),
                    *(given.grounding.part_laws[one] for one in trace.due_parts),
                ]
            )
            for given in self._given
        ]

    def _note_reach(self, trace: _relax.SearchResult) -> None:
        if not isinstance(self.objective, CallableUtility):
            return
        law = self.law(trace)
        self._reach = max(self._reach, 2 * (law.most if math.isfinite(law.most) else law.quantile(MOST_LIKELY)))

    def _objective_in_the_core(self) -> _relax.LawObjective:
        step = self._grid.step
        if isinstance(self.objective, Neutral):
            return _relax.ExpectedDisutility(0.0, float(step), [(0.0, 0.0, 0.0)])
        make = {**OBJECTIVES, **EXPONENTIAL}[type(self.objective)]
        return make(self.objective, step, self._reach or self._largest)

    def _budgets_in_the_core(self) -> list[tuple[_relax.LawObjective, float]]:
        step = self._grid.step
        return [
            (OBJECTIVES[Deadline](Deadline(budget.budget), step, 0.0), 1 - budget.probability + TOLERANCE)
            for budget in self._keep
        ]

    def _tangent_in_the_core(self, line: Tangent) -> tuple[_relax.PricedProblem, float, float, list[float]]:
        """Return its prices in units, how many of them are one in the objective's unit, its constant and weights."""
        problem = self._priced(line)
        units = 2.0 ** (MEAN_BITS - math.frexp(max(problem.bounds(), default=1.0))[1])
        actions, parts = (
            [math.floor(price.bound * units) for price in prices] for prices in (problem.actions, problem.parts)
        )
        step = float(self._grid.step)
        handle = _relax.PricedProblem(self.grounding.handle, actions, parts)
        return handle, units, line.constant, [weight * step for weight in line.weights]

    def _priced(self, line: Tangent) -> PricedProblem:
        """Return the problem at the prices of a tangent."""
        columns = [(given.grounding.laws, given.grounding.part_laws) for given in self._given]
        actions, parts = (_mixed(line.weights, rows) for rows in zip(*columns, strict=True))
        return PricedProblem(self.grounding, actions, parts)


def _mixed(weights: Sequence[float], columns: Sequence[Sequence[CostLaw]]) -> list[RiskCost]:
    """Return for each row of laws the sum of their means, each times its weight."""
    known: dict[tuple[int, ...], RiskCost] = {}
    prices = []
    for row in zip(*columns, strict=True):
        key = tuple(map(id, row))
        if key not in known:
            cost = math.fsum(weight * law.mean for weight, law in zip(weights, row, strict=True))
            known[key] = RiskCost(cost, cost - ROUNDING * cost)
        prices.append(known[key])
    return prices
