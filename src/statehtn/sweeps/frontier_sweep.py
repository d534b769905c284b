"""The plans of which no other one has a lower mean and a lower risk.

For a risk that is measured as a cost (CVaR, standard deviation) the sweep has two phases (Ulungu and Teghem, *The
two-phases method*, 1995):

1. Between two plans that are known, the mixture of mean and risk by which they are equally good is minimised. Either it
   finds a plan that is better, which goes between them, or no plan lies below the line through the two (Eisner and
   Severance, *Mathematical techniques for efficient record segmentation*, 1976).
2. A plan above that line may be on the frontier, too, if its mean is below the one's and its risk below the other's. So
   the best plans by that mixture are enumerated, until their values have reached that of this corner: then none is
   missing. `MOST_RANKED` ends it earlier; then the gap says how far below the corners a missing plan may lie.

For the probability to miss a deadline one phase is enough: the plan of least mean among those that are on time with a
higher probability than the last one is the next (the epsilon-constraint method of Haimes, Lasdon and Wismer, 1971).
"""

from __future__ import annotations

import itertools
import math
from dataclasses import dataclass

from statehtn.found_plan import SECONDS_TO_VALIDATE, FoundPlan
from statehtn.limits import ENDINGS, status_of, watched
from statehtn.model.cost.distribution import CostDistribution
from statehtn.model.cost.scenario_cost import sum_of
from statehtn.model.status import Status
from statehtn.risk import Keep, Neutral, Objective
from statehtn.sweeps.risk_measure import RiskMeasure
from statehtn.sweeps.runs import Runs

MOST_RANKED = 256
"""Plans that are enumerated between two neighbours."""
FEWEST_RANKED = 4
EQUAL = 1e-9
"""Means, risks and mixtures that differ by no more than this part of them are the same."""
MORE = 1e-9
"""By how much likelier to be on time the next plan shall be."""


@dataclass(frozen=True, slots=True)
class FrontierPoint:
    """A plan with its expected cost and its risk."""

    mean: float
    risk: float
    found: FoundPlan

    def mixture(self, weight: float) -> float:
        """Return `(1 - weight) mean + weight risk`."""
        return (1 - weight) * self.mean + weight * self.risk


@dataclass(frozen=True, slots=True)
class Chain:
    """Plans from the least mean to the least risk, and between each two how far a missing plan may lie below both."""

    points: list[FrontierPoint]
    gaps: list[float]

    def before(self, other: Chain) -> Chain:
        """Return this chain and another that begins where it ends."""
        return Chain([*self.points, *other.points[1:]], [*self.gaps, *other.gaps])


class FrontierSweep:
    """Finds the plans of a frontier.

    Args:
        runs: that make the searches.
        measure: of risk.
    """

    def __init__(self, runs: Runs, measure: RiskMeasure) -> None:
        self.runs = runs
        self.measure = measure
        self.status = Status.UNSOLVABLE
        """Why there is no plan, where there is none."""
        self.known: list[FrontierPoint] = []
        self.proven = -math.inf  # of all plans, by the latest objective

    def sweep(self) -> Chain:
        """Search until the frontier is complete, or a limit is reached; return what was found."""
        try:
            return self.chain()
        except ENDINGS as ending:  # between two runs, or while the law of a plan was worked out
            self.runs.stopped = status_of(ending)
            points = _undominated(self.known)
            if not points:
                self.status = self.runs.stopped
            return Chain(points, [math.inf] * (len(points) - 1))

    def chain(self) -> Chain:
        """Return what `sweep` does, unless something ends it between two runs."""
        first = self.searched(Neutral())
        if first is None:
            return Chain([], [])
        if self.measure.budget is not None:
            return self.kept(first, self.measure.budget)
        last = None if self.runs.stopped else self.searched(self.measure.least)
        if last is None:
            return Chain([first], [])
        if not _is_more(last.mean, first.mean):
            return Chain([last], [])
        return self.between(first, last) if _is_more(first.risk, last.risk) else Chain([first], [])

    def searched(self, objective: Objective) -> FrontierPoint | None:
        """Search for the best plan by an objective; None where none is found."""
        result = self.runs.run(objective)
        if result.found is None:
            self.status = result.status
        self.proven = -math.inf if result.lower_bound is None else result.lower_bound
        return None if result.found is None else self.point(result.found)

    def point(self, found: FoundPlan) -> FrontierPoint:
        """Return a plan with its mean and its risk."""
        assert found.plan.costs is not None
        law = sum_of(found.plan.costs) if found.plan.costs else CostDistribution.certain(0)
        with watched(self.runs.limits.with_grace(SECONDS_TO_VALIDATE)):
            point = FrontierPoint(law.mean, self.measure.of(law), found)
        self.known.append(point)
        return point

    def between(self, left: FrontierPoint, right: FrontierPoint) -> Chain:
        """Return the frontier from one plan to another of higher mean and lower risk."""
        gain, price = left.risk - right.risk, right.mean - left.mean
        weight = price / (gain + price)
        corner = (1 - weight) * right.mean + weight * left.risk
        if self.runs.stopped is not None:
            return Chain([left, right], [math.inf])
        objective, factor = self.measure.mixed(weight)
        found = self.searched(objective)
        bound = self.proven * factor
        if found is not None and _is_more(left.mixture(weight), found.mixture(weight)):
            is_cheaper, is_safer = _is_more(right.mean, found.mean), _is_more(left.risk, found.risk)
            if is_cheaper and is_safer:
                below = self.between(left, found) if _is_more(found.mean, left.mean) else Chain([found], [])
                above = self.between(found, right) if _is_more(found.risk, right.risk) else Chain([found], [])
                return below.before(above)
        return self.ranked(left, right, weight, corner, bound)

    def ranked(self, left: FrontierPoint, right: FrontierPoint, weight: float, corner: float, bound: float) -> Chain:
        """Return two neighbours on a line below which there is no plan, and those between that are above it."""
        objective, factor = self.measure.mixed(weight)
        inside: list[FrontierPoint] = []
        count = FEWEST_RANKED
        while _is_more(corner, bound) and count <= MOST_RANKED and self.runs.stopped is None:
            top = self.runs.top(objective, count)
            inside = [point for plan in top if _is_inside(point := self.point(plan), left, right)]
            if top.lower_bound is not None:
                bound = max(bound, top.lower_bound * factor)
            elif top.is_all:
                bound = math.inf
            count *= 4
        points = [left, *_undominated(inside), right]
        corners = ((1 - weight) * after.mean + weight * one.risk for one, after in itertools.pairwise(points))
        return Chain(points, [one - bound if _is_more(one, bound) else 0.0 for one in corners])

    def kept(self, first: FrontierPoint, budget: float) -> Chain:
        """Return the frontier of mean and probability to exceed a budget, from the plan of least mean on."""
        points, gaps = [first], [math.inf]  # of each point to the one before
        while points[-1].risk > MORE and self.runs.stopped is None:
            result = self.runs.run(Neutral(), (Keep(budget, 1 - points[-1].risk + MORE),))
            if result.found is None:
                break
            following = self.point(result.found)
            if not _is_more(following.mean, points[-1].mean):  # as cheap, and late less often
                points.pop()
                gaps.pop()
            points.append(following)
            gaps.append(0.0 if result.status is Status.OPTIMAL or result.gap is None else result.gap)
        return Chain(points, gaps[1:])


def _is_more(one: float, other: float) -> bool:
    """Tell whether a number is larger than another, beyond rounding."""
    return one - other > EQUAL * max(abs(one), abs(other))


def _is_inside(point: FrontierPoint, left: FrontierPoint, right: FrontierPoint) -> bool:
    """Tell whether neither of two plans is as good as another one."""
    return _is_more(right.mean, point.mean) and _is_more(left.risk, point.risk)


def _undominated(points: list[FrontierPoint]) -> list[FrontierPoint]:
    """Return the points of which no other one is as good, in order of their means."""
    found: list[FrontierPoint] = []
    for point in sorted(points, key=lambda one: (one.mean, one.risk)):
        if not found or _is_more(found[-1].risk, point.risk):
            found.append(point)
    return found
