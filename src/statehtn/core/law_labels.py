"""Labels of objectives that need the law of what a way has cost."""

from __future__ import annotations

import math
from collections.abc import Iterator
from contextlib import suppress

import statehtn._relax as _relax
from statehtn.core.grounding import Grounding
from statehtn.core.labels import Labels, Support
from statehtn.core.law_grid import LawGrid
from statehtn.core.law_objectives import MOST_TABLED, OBJECTIVES
from statehtn.core.switches import LabelSwitches, LawSwitches, set_switches
from statehtn.errors import InputError
from statehtn.limits import Limits
from statehtn.model.cost.law import CostLaw
from statehtn.risk.callable_utility import CallableUtility
from statehtn.risk.exponential import Exponential
from statehtn.risk.objective import Objective
from statehtn.risk.utility import Attitude

FIRST_OUTCOMES = 256
"""Of the law of what a way has cost at first, where the objective is averse to risk: costs near each other become their
mean, which no such objective finds worse. So what is proven is a lower bound, as on a coarse grid ..."""
MORE_OUTCOMES = 16
"""... and by so much their number grows where that leaves a gap."""
MANY_NODES = 256
"""Where a search by the expected cost has expanded so many, the label search is long, and good plans help it on ..."""
AVERSE = (0.3, 1.0, 3.0)
"""... such as those of exponential agents of so much alpha, divided by the standard deviation of the first plan."""
MOST_LIKELY = 1 - 1e-9
"""The quantile up to which a Python function is tabled at first, of plans whose cost has no end."""


class LawLabels(Labels):
    """Laws on a grid.

    Args:
        grounding: the ground problem.
        objective: its class is in `OBJECTIVES`.
        switches: refinements to leave out.
        limits: they hold while laws are put on a grid.
    """

    def __init__(self, grounding: Grounding, objective: Objective, switches: LabelSwitches, limits: Limits) -> None:
        super().__init__(grounding, objective)
        self.grid = LawGrid.first(grounding, limits)
        self._options = law_options(switches)
        self._options.label_outcomes = FIRST_OUTCOMES
        self._valuation: _relax.LawValuation | None = None  # the last one
        self._reach = 0.0  # the cost up to which a Python function is tabled

    @property
    def valuation(self) -> _relax.Valuation:
        """The laws on the present grid, and how the objective values them."""
        grid = self.grid
        objective = OBJECTIVES[type(self.objective)](self.objective, grid.grid.step, self._reach or grid.largest)
        self._valuation = _relax.LawValuation(
            grid.least, grid.means, grid.units_per_step, grid.costs, objective, self._options
        )
        return self._valuation

    def refine(self, limits: Limits) -> bool:
        """Take a finer grid, let laws have more outcomes, or ask a Python function for larger costs."""
        finer = self.grid.finer(limits)
        if finer is not None:
            self.grid = finer
            return True
        if self._valuation is not None and not self._valuation.is_exact:
            self._options.label_outcomes *= MORE_OUTCOMES
            return True
        is_tabled = isinstance(self.objective, CallableUtility)
        self._reach = 2 * (self._reach or self.grid.largest)
        return is_tabled and self._reach <= MOST_TABLED * float(self.grid.grid.step)

    def coarsen(self, limits: Limits) -> bool:
        """Take a coarser grid."""
        coarser = self.grid.coarser(limits)
        self.grid = coarser or self.grid
        return coarser is not None

    def law(self, trace: _relax.SearchResult) -> CostLaw:
        """Return the law of a plan that was found."""
        return self.grid.total(trace) or super().law(trace)

    def support(self, limits: Limits, share: float = 0.25) -> Iterator[Support]:
        """Yield what A* by the expected cost finds, and by prices of averse agents where that has taken a while."""
        deviation, takes_long = 0.0, False
        for support in super().support(limits, share):
            takes_long = support.effort.expanded >= MANY_NODES
            if takes_long or isinstance(self.objective, CallableUtility):
                for law in map(self.law, support.traces):
                    deviation = law.standard_deviation
                    most = law.most if math.isfinite(law.most) else law.quantile(MOST_LIKELY)
                    self._reach = max(self._reach, 2 * most)
            yield support
        if takes_long and 0 < deviation < math.inf:
            for slope in AVERSE:
                with suppress(InputError):  # a cost may have no price for such an agent
                    yield from self.cheapest(Exponential(Attitude.AVERSE, slope / deviation), limits, share)


def law_options(switches: LabelSwitches) -> _relax.LawOptions:
    """Return the options of the core for laws."""
    options = _relax.LawOptions()
    set_switches(options, switches, LawSwitches)
    return options
