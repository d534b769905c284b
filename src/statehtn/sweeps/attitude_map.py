"""The attitude map: which plan is best for which alpha, to within a given loss; what is not proven is said."""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any, overload

from statehtn.counted import counted, finite
from statehtn.effort import Statistics
from statehtn.errors import UnsupportedError, UsageError
from statehtn.expected import number
from statehtn.found_plan import FoundPlan
from statehtn.limits import Limits
from statehtn.model.plan import Plan
from statehtn.model.status import Status
from statehtn.session import ProgressCallback, Session
from statehtn.settings import Settings
from statehtn.sweeps.alpha_sweep import AlphaSweep, Stretch
from statehtn.sweeps.plan_curve import PlanCurve
from statehtn.sweeps.runs import Runs

RESOLUTION = 1e-7
"""How narrow the interval of a break point shall be, as a part of the alpha."""
ROUNDING = 1e-9
"""Of alpha: where two curves cross, computed in floating point."""
NOTHING = 1e-9  # an alpha that is shown as 0
LEAST_ROUNDING = 1e-10  # times the inverse of what a plan costs


@dataclass(frozen=True, slots=True, repr=False)
class MapPiece:
    """An interval of alpha, and a plan that is good on all of it.

    Args:
        low: the least alpha, negative for seeking agents.
        high: the largest.
        found: the plan, with its prices for one of the agents.
        gap: the most by which its certainty equivalent may exceed the least of any plan for an agent of the interval,
            in the domain's unit.
        curve: its certainty equivalent for every alpha.
    """

    low: float
    high: float
    found: FoundPlan
    gap: float
    curve: PlanCurve = field(compare=False)

    def __repr__(self) -> str:
        steps = counted(self.found.length, "step")
        return f"<alpha from {self.low:.6g} to {self.high:.6g}: {steps}, mean {self.expected_cost:.6g}>"

    @property
    def plan(self) -> Plan:
        """The plan, with its decomposition."""
        return self.found.plan

    @property
    def expected_cost(self) -> float:
        """The plan's expected cost, positive, in the domain's unit."""
        return self.found.expected_cost

    def certainty_equivalent(self, alpha: float) -> float:
        """Return what the plan is worth to an agent: of `alpha` if averse, of `-alpha` if seeking; 0 is neutral.

        Raises:
            UsageError: alpha is no number.
        """
        return self.curve.at(_slope(alpha, "alpha"))

    def to_dict(self) -> dict[str, Any]:
        """Return the piece as plain data: a row of the map."""
        return {
            "alpha_from": self.low,
            "alpha_to": self.high,
            "plan": [str(priced.step) for priced in self.found.steps],
            "length": self.found.length,
            "expected_cost": self.expected_cost,
            "gap": self.gap,
        }


@dataclass(frozen=True, slots=True)
class BreakPoint:
    """Where the best plan changes: for an alpha between two that were searched, at which different plans are best."""

    low: float
    high: float

    def __str__(self) -> str:
        low, high = (f"{end:.6g}" if abs(end) > NOTHING else "0" for end in (self.low, self.high))
        return low if low == high else f"[{low}, {high}]"


@dataclass(frozen=True, slots=True, repr=False)
class AttitudeMap(Sequence[dict[str, Any]]):
    """The best plans of all exponential agents of an interval of alpha: a sequence of rows from low to high.

    Alpha is signed here: negative for seeking agents, 0 for the neutral one, positive for averse ones. A row is a dict
    with `alpha_from` and `alpha_to`, the `plan` as a list of its actions, its `length`, `expected_cost` and `gap`, so
    that `pandas.DataFrame(...)` takes the map; `pieces` has the same with decompositions, prices and curves.

    Args:
        status: `OPTIMAL`: every plan is proven to be within `eps` of the best one, on its whole piece; `SOLVED`: the
            gaps say how much is not proven; else why there is no plan.
        low: the least alpha that was asked for; may be minus infinity, where the least possible cost counts.
        high: the largest; may be infinite, where the largest possible cost counts.
        eps: the loss that was allowed, in the domain's unit; None where nothing is known.
        pieces: the intervals with their plans; different plans stand next to each other.
        breaks: between each two pieces, in order.
        runs: how many searches were made.
        statistics: the effort of all of them.
        stopped: what ended the sweep before it was done; None for nothing.
    """

    status: Status
    low: float
    high: float
    eps: float | None
    pieces: tuple[MapPiece, ...]
    breaks: tuple[BreakPoint, ...]
    runs: int
    statistics: Statistics
    stopped: Status | None = None

    def __len__(self) -> int:
        return len(self.pieces)

    @overload
    def __getitem__(self, index: int) -> dict[str, Any]: ...
    @overload
    def __getitem__(self, index: slice) -> list[dict[str, Any]]: ...
    def __getitem__(self, index: int | slice) -> dict[str, Any] | list[dict[str, Any]]:
        if isinstance(index, slice):
            return [piece.to_dict() for piece in self.pieces[index]]
        return self.pieces[index].to_dict()

    def __repr__(self) -> str:
        interval = f"from {self.low:g} to {self.high:g}"
        plans = "no plan" if self.gap is None else f"{counted(len(self), 'plan')}, to within {self.gap:.3g}"
        return f"<attitude map {interval}: {self.status}, {plans}>"

    def __str__(self) -> str:
        from statehtn.display.attitude_map import map_text

        return map_text(self)

    def _repr_html_(self) -> str:
        from statehtn.display.attitude_map import map_html

        return map_html(self)

    @property
    def gap(self) -> float | None:
        """The largest gap of all pieces; None where there is no plan."""
        return max((piece.gap for piece in self.pieces), default=None)

    def at(self, alpha: float) -> MapPiece:
        """Return the piece of an agent: of `alpha` if averse, of `-alpha` if seeking; 0 is neutral.

        Raises:
            UsageError: it is not on the map, or there is no plan.
        """
        slope = _slope(alpha, "alpha")
        for piece in self.pieces:
            if piece.low <= slope <= piece.high:
                return piece
        raise UsageError(f"alpha {slope:g} is not on the map, which goes from {self.low:g} to {self.high:g}")

    def to_dict(self) -> dict[str, Any]:
        """Return the map as plain data; an infinite alpha is null."""
        return {
            "status": self.status.value,
            "alpha_from": finite(self.low),
            "alpha_to": finite(self.high),
            "eps": self.eps,
            "gap": self.gap,
            "intervals": [
                {**row, "alpha_from": finite(row["alpha_from"]), "alpha_to": finite(row["alpha_to"])} for row in self
            ],
            "breaks": [[one.low, one.high] for one in self.breaks],
            "runs": self.runs,
            "stopped": None if self.stopped is None else self.stopped.value,
            "statistics": self.statistics.to_dict(),
        }


def map_attitudes(
    session: Session,
    low: float,
    high: float,
    eps: float | None,
    resolution: float,
    settings: Settings,
    limits: Limits,
    progress: ProgressCallback | None = None,
) -> AttitudeMap:
    """Find the best plans of all agents between two alphas; see `statehtn.attitude_map`.

    Raises:
        UsageError: an argument is out of its range.
        InputError: a cost has no finite price for one of the agents.
        UnsupportedError: costs hang together.
    """
    low, high = _slope(low, "the lower alpha"), _slope(high, "the upper alpha")
    if not low < high:
        raise UsageError(f"the lower alpha must be below the upper one, found {low:g} and {high:g}")
    if eps is not None:
        eps = _positive(eps, "eps")
    runs = Runs(session, settings, limits, progress)
    if runs.has_scenarios:
        raise UnsupportedError(
            "an attitude map needs prices that add up, and costs that depend on hidden facts hang together; "
            "plan for one agent at a time"
        )
    sweep = AlphaSweep(runs, low, high, eps, _positive(resolution, "the resolution"))
    sweep.sweep()
    pieces: list[MapPiece] = []
    breaks: list[BreakPoint] = []
    for _, group in itertools.groupby(sweep.stretches(), key=lambda stretch: id(stretch.plan)):
        piece = _piece(list(group))
        if pieces:
            breaks.append(_break(sweep, piece.low))
        pieces.append(piece)
    status = sweep.status
    if pieces:
        is_done = sweep.loss is not None and all(piece.gap <= sweep.loss for piece in pieces)
        status = Status.OPTIMAL if is_done else Status.SOLVED
    how = runs.count, runs.statistics, runs.stopped
    return AttitudeMap(status, low, high, sweep.loss, tuple(pieces), tuple(breaks), *how)


def _piece(stretches: Sequence[Stretch]) -> MapPiece:
    first, last = stretches[0], stretches[-1]
    gap = max(stretch.gap for stretch in stretches)
    return MapPiece(first.low, last.high, first.plan.found, gap, first.plan.curve)


def _break(sweep: AlphaSweep, at: float) -> BreakPoint:
    """Return slopes next to a break: those that were searched; where all plans are known, the crossing to rounding."""
    below = [segment for segment in sweep.segments if segment.low.slope <= at]
    above = [segment for segment in sweep.segments if segment.high.slope >= at]
    if below[-1].is_complete and above[0].is_complete:
        apart = max(abs(at) * ROUNDING, LEAST_ROUNDING / sweep.unit)
        return BreakPoint(at - apart, at + apart)
    return BreakPoint(below[-1].low.slope, above[0].high.slope)


def _slope(value: object, what: str) -> float:
    slope = number(value, what)
    if math.isnan(slope):
        raise UsageError(f"{what} must be a number, found {slope:g}")
    return slope


def _positive(value: object, what: str) -> float:
    found = number(value, what)
    if not (found > 0 and math.isfinite(found)):
        raise UsageError(f"{what} must be a positive finite number, found {found:g}")
    return found
