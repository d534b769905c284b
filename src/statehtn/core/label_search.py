"""Search for the best plans by an objective whose label is not one price, in the compiled core."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence

import statehtn._relax as _relax
from statehtn.core.grounding import Grounding
from statehtn.core.label_run import PRECISION, LabelRun, NetworkRun
from statehtn.core.plan_based import plan_based_options
from statehtn.core.progress import SearchProgress
from statehtn.core.search_run import SearchOutcome
from statehtn.core.switches import LabelSwitches, TopSwitches, set_switches
from statehtn.core.top_plans import DISTINCT
from statehtn.core.valuations import labels_of
from statehtn.limits import Limits
from statehtn.risk.keep import Keep
from statehtn.risk.objective import Objective


def search_labels(
    grounding: Grounding,
    objective: Objective,
    *,
    keep: Sequence[Keep] = (),
    k: int = 1,
    distinct: str = "sequence",
    heuristic: str = "potential",
    precision: float = PRECISION,
    limits: Limits = Limits(),
    progress: Callable[[SearchProgress], None] | None = None,
    switches: LabelSwitches = LabelSwitches(),
) -> Iterator[SearchOutcome]:
    """Search for the k plans of least value that differ in their actions; yield an outcome after every better plan.

    All but the last have the status `SOLVED`. Lower bounds are in the unit of the objective.

    Args:
        grounding: the ground problem and its cost laws.
        objective: what is minimised.
        keep: budgets that every plan is to keep.
        k: how many plans are wanted, at least 1.
        distinct: a name in `DISTINCT`: when plans are different, where several are wanted.
        heuristic: the name of an admissible heuristic in `HEURISTICS`.
        precision: how much of its value, or of 1 if that is more, a plan that is called optimal may be worse than the
            best.
        limits: when to stop; Ctrl-C stops, too.
        progress: called about every 50 ms on the calling thread.
        switches: refinements to leave out.
    """
    options = _relax.LabelSearchOptions()
    options.count = k
    options.distinct = DISTINCT[distinct]
    options.heuristic = heuristic
    set_switches(options, switches, TopSwitches)
    labels = labels_of(grounding, objective, keep, switches, limits)
    return LabelRun(grounding, labels, options, keep, precision, limits, progress).outcomes()


def search_networks_by_labels(
    grounding: Grounding,
    objective: Objective,
    *,
    keep: Sequence[Keep] = (),
    branch: str = "fewest",
    checks_preconditions: bool = True,
    precision: float = PRECISION,
    limits: Limits = Limits(),
    progress: Callable[[SearchProgress], None] | None = None,
    switches: LabelSwitches = LabelSwitches(),
) -> Iterator[SearchOutcome]:
    """Search task networks for the plan of least value, as `search_labels` does over states and networks.

    A network determines which actions it has, so that it has one label: the paper's Algorithm 3 with another f.
    """
    options = plan_based_options("tdg", branch, checks_preconditions)
    labels = labels_of(grounding, objective, keep, switches, limits)
    return NetworkRun(grounding, labels, options, keep, precision, limits, progress).outcomes()
