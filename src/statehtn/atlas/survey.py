"""What an atlas knows of a problem: the attitude map, frontiers, and the best plans for deadlines and for wealth."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Any

from statehtn.counted import finite, letters
from statehtn.found_plan import FoundPlan, PricedStep
from statehtn.limits import Limits
from statehtn.model.cost.law import CostLaw
from statehtn.model.expect import expect_problem
from statehtn.model.problem import Problem
from statehtn.model.status import Status
from statehtn.planner import Planner
from statehtn.result import Result
from statehtn.session import ProgressCallback
from statehtn.sweeps.attitude_map import AttitudeMap
from statehtn.sweeps.frontier import Frontier

LEVEL = 0.95
"""Of the CVaR on the page."""
SHARE_OF_MAP = 0.6
SHARE_OF_FRONTIERS = 0.6
"""Of the time that is left: for the map, and then for the frontiers."""
LEAST_SECONDS = 1e-3
DEADLINES = 25
WEALTHS = 13
"""So many deadlines, and so many amounts of wealth, are planned for."""
CAREFUL = 5.0
"""Alpha times the mean of the neutral plan: the agent with the one-switch utility, which cares more the less it has."""


@dataclass(frozen=True, slots=True)
class AtlasPlan:
    """A plan of the page.

    Args:
        name: A, B and so on, in the order of the map.
        found: the plan with its prices.
        total: the law of its total cost.
    """

    name: str
    found: FoundPlan
    total: CostLaw

    def to_dict(self) -> dict[str, Any]:
        """Return the plan as plain data."""
        total = self.total
        return {
            "name": self.name,
            "plan": [str(priced.step) for priced in self.found.steps],
            "mean": total.mean,
            "deviation": total.standard_deviation,
            "least": total.least,
            "most": finite(total.most),
            "quantiles": {str(level): total.quantile(level) for level in (0.05, 0.5, 0.95)},
            "cvar": {str(LEVEL): total.cvar(LEVEL)},
        }


@dataclass(frozen=True, slots=True)
class Choice:
    """The plan for one deadline, or for one amount of wealth.

    Args:
        at: the deadline, or the wealth, in the domain's unit.
        plan: the index of the plan; None where none was found.
        value: what it is worth by the objective.
        gap: how much better another plan may be, by the objective; None where nothing is known.
    """

    at: float
    plan: int | None
    value: float | None
    gap: float | None

    def to_dict(self) -> dict[str, Any]:
        """Return the choice as plain data; the plan by its index in `plans`."""
        return {"at": self.at, "plan": self.plan, "value": self.value, "gap": self.gap}


@dataclass(slots=True)
class Atlas:
    """Everything that the page about one problem shows.

    Args:
        problem: the problem.
        map: the attitude map.
        frontiers: of mean against risk, by the risk.
        deadlines: the plan with the least chance to exceed each of them.
        wealths: the plan of the agent with a one-switch utility for each amount.
        one_switch: that agent's objective but for the wealth: alpha and tradeoff.
        plans: all plans on the page; those of the map come first, in its order.
        of_piece: for each piece of the map, the index of its plan.
    """

    problem: Problem
    map: AttitudeMap
    frontiers: list[Frontier] = field(default_factory=list)
    deadlines: list[Choice] = field(default_factory=list)
    wealths: list[Choice] = field(default_factory=list)
    one_switch: tuple[float, float] = (0.0, 0.0)
    plans: list[AtlasPlan] = field(default_factory=list)
    of_piece: list[int] = field(default_factory=list)
    _numbers: dict[tuple[object, ...], int] = field(default_factory=dict, repr=False)

    def __repr__(self) -> str:
        return f"<atlas of '{self.problem.name}': {self.map!r}>"

    @property
    def status(self) -> Status:
        """How the map ended; without a plan, why there is none."""
        return self.map.status

    def number(self, found: FoundPlan) -> int:
        """Return the index of a plan, which is taken up if no plan with these actions is there."""
        key = tuple((priced.step, priced.law) for priced in found.steps)
        if key not in self._numbers:
            self._numbers[key] = len(self.plans)
            total = found.plan.cost_distribution()
            self.plans.append(AtlasPlan(letters(len(self.plans)), found, total))
        return self._numbers[key]

    @property
    def mildest(self) -> int:
        """The index of the plan of the neutral agent, or of the one on the map that is nearest to it."""
        pieces = self.map.pieces
        return self.of_piece[min(range(len(pieces)), key=lambda at: max(pieces[at].low, -pieces[at].high, 0.0))]

    def to_dict(self) -> dict[str, Any]:
        """Return the atlas as plain data: what `statehtn atlas --json` prints."""
        return {
            "problem": self.problem.name,
            "domain": self.problem.domain.name,
            "map": self.map.to_dict(),
            "plans": [plan.to_dict() for plan in self.plans],
            "plan_of_interval": self.of_piece,
            "frontiers": [one.to_dict() for one in self.frontiers],
            "deadlines": [one.to_dict() for one in self.deadlines],
            "wealths": [one.to_dict() for one in self.wealths],
        }

    def to_html(self) -> str:
        """Return the page.

        Raises:
            UsageError: a package that it needs is not installed (`pip install 'statehtn[report]'`).
        """
        from statehtn.display.atlas.page import atlas_page

        return atlas_page(self)

    def steps(self) -> list[PricedStep]:
        """Return every action of the plans once with each of its laws, in the order in which they are met."""
        met = {(step.step, step.law): step for plan in self.plans for step in plan.found.steps}
        return list(met.values())


def survey(
    problem: Problem,
    low: float = -math.inf,
    high: float = math.inf,
    *,
    time_limit: float | None = None,
    memory_limit: float | None = None,
    progress: ProgressCallback | None = None,
) -> Atlas:
    """Find what the page about a problem shows, as far as a time limit allows; exported as `statehtn.survey`.

    Args:
        problem: the problem.
        low: the least alpha of the map, signed: negative for seeking agents.
        high: its largest.
        time_limit: seconds for everything; the map has the larger part. What was not done by then is left out, and what
            is not proven has a gap.
        memory_limit: resident memory of the whole process in MB (10^6 bytes).
        progress: is called while searches go on, with the effort of the one that runs.

    Raises:
        UsageError: an argument is out of its range.
        InputError: as `statehtn.plan`; a cost has no finite price for the agent of `high`.
        UnsupportedError: as `statehtn.plan`; costs hang together.
    """
    planner = Planner(expect_problem(problem))
    limits = Limits.starting_now(time_limit, memory_limit)
    how: dict[str, Any] = {"memory_limit": memory_limit, "progress": progress}
    found = planner.attitude_map(low, high, time_limit=_seconds(limits, SHARE_OF_MAP), **how)
    atlas = Atlas(problem, found)
    if not found.pieces or found.stopped is Status.INTERRUPTED:
        return atlas
    atlas.of_piece = [atlas.number(piece.found) for piece in found.pieces]
    _add_frontiers(atlas, planner, limits, how)
    _add_choices(atlas, planner, limits, how)
    return atlas


def _add_frontiers(atlas: Atlas, planner: Planner, limits: Limits, how: dict[str, Any]) -> None:
    budget = _rounded(atlas.plans[atlas.mildest].total.quantile(0.75))
    risks = [f"cvar {LEVEL:g}", f"deadline {budget:g}", "deviation"]
    for rank, risk in enumerate(risks):
        seconds = _seconds(limits, SHARE_OF_FRONTIERS / (len(risks) - rank))
        frontier = planner.frontier(risk, time_limit=seconds, **how)
        if frontier.stopped is Status.INTERRUPTED:
            return
        if frontier.points:
            atlas.frontiers.append(frontier)
            for point in frontier.points:
                atlas.number(point.found)


def _add_choices(atlas: Atlas, planner: Planner, limits: Limits, how: dict[str, Any]) -> None:
    totals = [plan.total for plan in atlas.plans]
    least, most = min(total.least for total in totals), max(total.quantile(0.99) for total in totals)
    mean = min(total.mean for total in totals)
    if least < most:
        deadlines = _spread(least, most, DEADLINES)
        _choose(atlas, planner, limits.for_a_part(0.5), how, deadlines, lambda at: f"deadline {at:g}", atlas.deadlines)
    if mean > 0:
        atlas.one_switch = _rounded(CAREFUL / mean), _rounded(mean)
        alpha, tradeoff = atlas.one_switch
        wealths = _spread(0, 3 * mean, WEALTHS)
        text = f"one-switch alpha={alpha:g} tradeoff={tradeoff:g}"
        _choose(atlas, planner, limits.for_a_part(0.5), how, wealths, lambda at: f"{text} wealth={at:g}", atlas.wealths)


def _choose(
    atlas: Atlas,
    planner: Planner,
    limits: Limits,
    how: dict[str, Any],
    places: Sequence[float],
    objective: Callable[[float], str],
    choices: list[Choice],
) -> None:
    """Plan for each of the places, each with an equal share of the time that is left."""
    for rank, at in enumerate(places):
        seconds = _seconds(limits, 1 / (len(places) - rank))
        if seconds == LEAST_SECONDS:
            return
        result = planner.plan(objective=objective(at), time_limit=seconds, **how)
        choices.append(_choice(atlas, at, result))
        if result.stopped is Status.INTERRUPTED:
            return


def _choice(atlas: Atlas, at: float, result: Result) -> Choice:
    plan = None if result.found is None else atlas.number(result.found)
    return Choice(at, plan, result.value, result.gap)


def _seconds(limits: Limits, share: float = 1.0) -> float | None:
    """Return a part of the time that is left; None without a limit. Some is always left, to say that it is over."""
    left, _, _ = limits.left()
    return None if left is None else max(share * left, LEAST_SECONDS)


def _spread(low: float, high: float, count: int) -> list[float]:
    """Return rounded numbers at equal distances, in order and different, the ends about included."""
    return sorted({_rounded(low + (high - low) * step / (count - 1)) for step in range(count)})


def _rounded(value: float) -> float:
    """Return a number with three digits."""
    return float(f"{value:.3g}")
