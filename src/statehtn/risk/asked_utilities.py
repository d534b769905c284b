"""What a utility has been asked about: it must not rise from any of these costs to another."""

from __future__ import annotations

from bisect import bisect_left

from statehtn.errors import UsageError

ROUNDING = 1e-12  # relative, by which a utility may rise
MOST_KEPT = 2**18  # costs; others are compared with these


class AskedUtilities:
    """The costs that a utility was asked about, ascending, and what it said."""

    def __init__(self) -> None:
        self._costs: list[float] = []
        self._utilities: list[float] = []

    def add(self, name: str, cost: float, utility: float) -> None:
        """Add the utility of a cost, and compare it with those of the next smaller and the next larger cost.

        Args:
            name: what the utility is called.
            cost: what was asked.
            utility: the answer.

        Raises:
            UsageError: the utility rises.
        """
        costs, utilities = self._costs, self._utilities
        at = bisect_left(costs, cost)
        if at < len(costs) and costs[at] == cost:
            return
        if at > 0:
            _check(name, (costs[at - 1], utilities[at - 1]), (cost, utility))
        if at < len(costs):
            _check(name, (cost, utility), (costs[at], utilities[at]))
        if len(costs) < MOST_KEPT:
            costs.insert(at, cost)
            utilities.insert(at, utility)


def _check(name: str, one: tuple[float, float], later: tuple[float, float]) -> None:
    """Check that the utility of the larger of two costs, each with its utility, is not the larger one."""
    (cost, utility), (more, other) = one, later
    if other > utility + ROUNDING * max(abs(utility), abs(other)):
        raise UsageError(
            f"the utility '{name}' rises: {utility:g} for a cost of {cost:g}, {other:g} for {more:g}; costs are "
            f"positive and utilities maximised, so it must fall or stay"
        )
