"""The distribution of the total cost of a plan whose actions' costs are independent."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from statehtn.model.costs import CostDistribution

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Floats = NDArray[np.float64]

MOST_COSTS = 4000
"""So many different costs are kept apart; more are put on a grid of so many points."""
DECIMALS = 9
"""Costs that agree to so many decimals are one cost: sums of floating-point numbers in another order."""


@dataclass(frozen=True, slots=True)
class TotalCost:
    """The distribution of a plan's total cost, in the domain's unit.

    Args:
        costs: in ascending order.
        probabilities: of the costs; they sum to 1 but for rounding.
        is_exact: no cost was put on a grid; a grid keeps the mean, and moves no cost by more than its spacing.
    """

    costs: Floats
    probabilities: Floats
    is_exact: bool

    @property
    def mean(self) -> float:
        """The expected cost."""
        return float(self.costs @ self.probabilities)

    @property
    def least(self) -> float:
        """The least cost that is possible."""
        return float(self.costs[0])

    @property
    def most(self) -> float:
        """The highest cost that is possible."""
        return float(self.costs[-1])

    def quantile(self, share: float) -> float:
        """Return the least cost that is not exceeded with this probability."""
        index = int((self.probabilities.cumsum() < share - 1e-12).sum())
        return float(self.costs[min(index, len(self.costs) - 1)])

    def on_grid(self, points: int) -> TotalCost:
        """Return the distribution with at most so many costs, evenly spaced; the mean stays.

        The probability of a cost between two points is shared by them, the nearer one getting more.
        """
        import numpy as np

        if len(self.costs) <= points or self.most <= self.least:
            return self
        grid = np.linspace(self.least, self.most, points)
        position = (self.costs - self.least) * ((points - 1) / (self.most - self.least))
        lower = np.clip(position.astype(np.int64), 0, points - 2)
        share = np.clip(position - lower, 0.0, 1.0)
        mass: Any = np.bincount(lower, self.probabilities * (1 - share), points)
        mass += np.bincount(lower + 1, self.probabilities * share, points)
        return _without_gaps(grid, mass, is_exact=False)


def total_cost(laws: Sequence[CostDistribution], most_costs: int = MOST_COSTS) -> TotalCost:
    """Return the distribution of the sum of independent costs; 0 for certain if there are none."""
    import numpy as np

    total = TotalCost(np.zeros(1), np.ones(1), is_exact=True)
    for law in laws:
        outcomes = np.array(law.outcomes)
        costs = np.add.outer(total.costs, outcomes[:, 1]).ravel()
        probabilities = np.multiply.outer(total.probabilities, outcomes[:, 0]).ravel()
        different, which = np.unique(costs.round(DECIMALS), return_inverse=True)
        mass: Any = np.bincount(which, probabilities, len(different))
        total = TotalCost(different, mass, total.is_exact).on_grid(most_costs)
    return total


def _without_gaps(costs: Floats, probabilities: Floats, *, is_exact: bool) -> TotalCost:
    """Leave out costs of probability 0."""
    kept = probabilities > 0
    return TotalCost(costs[kept], probabilities[kept], is_exact)
