"""The frontier of mean and risk: every plan that is not worse than another one in both."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, overload

from statehtn.counted import counted, finite
from statehtn.effort import Statistics
from statehtn.limits import Limits
from statehtn.model.status import Status
from statehtn.session import ProgressCallback, Session
from statehtn.settings import Settings
from statehtn.sweeps.frontier_sweep import FrontierPoint, FrontierSweep
from statehtn.sweeps.risk_measure import risk_measure
from statehtn.sweeps.runs import Runs


@dataclass(frozen=True, slots=True, repr=False)
class Frontier(Sequence[dict[str, Any]]):
    """Plans of which no other one has a lower mean and a lower risk: a sequence from the least mean to the least risk.

    It is a sequence of rows: dicts with `mean`, `risk` and the `plan` as a list of its actions, so that
    `pandas.DataFrame(...)` takes it; `points` has the same with decompositions and prices.

    Args:
        status: `OPTIMAL`: it is proven that no point of the frontier is missing; `SOLVED`: the gaps say what is not
            proven; else why there is no plan.
        risk: what the risk is: `cvar 0.95`, `deadline 25` (the probability to exceed it) or `deviation`.
        points: one plan for each point.
        gaps: between each two points, in the domain's unit: with a CVaR or a deviation, how far a missing plan may lie
            below the corner of the one's risk and the other's mean, in the mixture of both by which the two are equally
            good; with a deadline, how much lower than that of the second one its mean may be. 0 where none is missing.
        runs: how many searches were made.
        statistics: the effort of all of them.
        stopped: what ended the search before it was done; the end of the frontier may be missing then.
    """

    status: Status
    risk: str
    points: tuple[FrontierPoint, ...]
    gaps: tuple[float, ...]
    runs: int
    statistics: Statistics
    stopped: Status | None = None

    def __len__(self) -> int:
        return len(self.points)

    @overload
    def __getitem__(self, index: int) -> dict[str, Any]: ...
    @overload
    def __getitem__(self, index: slice) -> list[dict[str, Any]]: ...
    def __getitem__(self, index: int | slice) -> dict[str, Any] | list[dict[str, Any]]:
        return [_row(one) for one in self.points[index]] if isinstance(index, slice) else _row(self.points[index])

    def __repr__(self) -> str:
        return f"<frontier of mean and {self.risk}: {self.status}, {counted(len(self), 'plan')}>"

    def __str__(self) -> str:
        from statehtn.display.frontier import frontier_text

        return frontier_text(self)

    def _repr_html_(self) -> str:
        from statehtn.display.frontier import frontier_html

        return frontier_html(self)

    def to_dict(self) -> dict[str, Any]:
        """Return the frontier as plain data; an infinite gap, where nothing is known, is null."""
        return {
            "status": self.status.value,
            "risk": self.risk,
            "points": list(self),
            "gaps": list(map(finite, self.gaps)),
            "runs": self.runs,
            "stopped": None if self.stopped is None else self.stopped.value,
            "statistics": self.statistics.to_dict(),
        }


def _row(point: FrontierPoint) -> dict[str, Any]:
    return {"mean": point.mean, "risk": point.risk, "plan": [str(priced.step) for priced in point.found.steps]}


def find_frontier(
    session: Session, risk: str, settings: Settings, limits: Limits, progress: ProgressCallback | None = None
) -> Frontier:
    """Find the plans that are not worse than another one in mean and risk; see `statehtn.frontier`.

    Raises:
        UsageError: there is no such risk.
    """
    measure = risk_measure(risk)
    runs = Runs(session, settings, limits, progress)
    sweep = FrontierSweep(runs, measure)
    chain = sweep.sweep()
    status = sweep.status
    if chain.points:
        is_complete = runs.stopped is None and not any(chain.gaps)
        status = Status.OPTIMAL if is_complete else Status.SOLVED
    how = runs.count, runs.statistics, runs.stopped
    return Frontier(status, measure.name, tuple(chain.points), tuple(chain.gaps), *how)
