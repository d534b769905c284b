"""Labels of plans that are to keep budgets, by whatever objective."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import statehtn._relax as _relax
from statehtn.core.labels import Labels, Support
from statehtn.core.law_grid import LawGrid
from statehtn.core.law_labels import LawLabels, law_options
from statehtn.core.law_objectives import whole_steps
from statehtn.core.switches import LabelSwitches
from statehtn.limits import Limits
from statehtn.model.cost.law import CostLaw
from statehtn.risk.keep import Keep


class BudgetLabels(Labels):
    """The labels of an objective, and laws on a grid that say whether plans keep budgets.

    Args:
        labels: those of the objective.
        keep: the budgets, at least one.
        switches: refinements to leave out.
        limits: they hold while laws are put on a grid.
    """

    def __init__(self, labels: Labels, keep: Sequence[Keep], switches: LabelSwitches, limits: Limits) -> None:
        super().__init__(labels.grounding, labels.objective)
        self.worths_are_values = labels.worths_are_values
        self._labels = labels
        self._keep = keep
        self._options = law_options(switches)
        self._grid = labels.grid if isinstance(labels, LawLabels) else LawGrid.first(labels.grounding, limits)

    @property
    def valuation(self) -> _relax.Valuation:
        """That of the objective, of plans that keep the budgets on the present grid."""
        grid = self._grid
        budgets = [(whole_steps(budget.budget, grid.grid.step), budget.probability) for budget in self._keep]
        return _relax.Budgets(self._labels.valuation, grid.least, grid.costs, budgets, self._options)

    def refine(self, limits: Limits) -> bool:
        """Take a finer grid for the objective, for the budgets, or both."""
        is_finer = self._labels.refine(limits)
        finer = self._labels.grid if isinstance(self._labels, LawLabels) else self._grid.finer(limits)
        if finer is None:
            return is_finer
        is_finer = is_finer or finer is not self._grid
        self._grid = finer
        return is_finer

    def coarsen(self, limits: Limits) -> bool:
        """Take a coarser grid for the budgets, and for an objective that has one."""
        if isinstance(self._labels, LawLabels):
            is_coarser = self._labels.coarsen(limits)
            self._grid = self._labels.grid
            return is_coarser
        coarser = self._grid.coarser(limits)
        self._grid = coarser or self._grid
        return coarser is not None

    def support(self, limits: Limits, share: float = 0.25) -> Iterator[Support]:
        """Yield what searches with a single price find; their plans need not keep the budgets."""
        return self._labels.support(limits, share)

    def law(self, trace: _relax.SearchResult) -> CostLaw:
        """Return the law of a plan that was found."""
        return self._grid.total(trace) or self._labels.law(trace)

    def value(self, trace: _relax.SearchResult) -> float:
        """Return the value of a plan that was found."""
        return self._labels.value(trace)

    def value_of(self, worth: int) -> float:
        """Return the value that a worth in the core stands for."""
        return self._labels.value_of(worth)

    def worth_of(self, value: float) -> int:
        """Return the worth in the core of a value."""
        return self._labels.worth_of(value)
