"""What a search for a policy needs to know of a ground problem."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property

import statehtn._relax as _relax
from statehtn.core.grounding import Grounding
from statehtn.core.pricing import Pricing, RiskCost, price
from statehtn.core.scale import Scale
from statehtn.core.switches import PolicySwitches
from statehtn.limits import Limits
from statehtn.risk.neutral import Neutral


@dataclass(frozen=True)
class PolicyProblem:
    """A ground problem whose policies are searched for.

    Args:
        grounding: the ground problem; its methods are whole.
        heuristic: the name of an admissible heuristic in `HEURISTICS`.
        limits: they hold for all that is worked out.
        switches: refinements of the search.
    """

    grounding: Grounding
    heuristic: str
    limits: Limits
    switches: PolicySwitches = PolicySwitches()

    @cached_property
    def probabilities(self) -> list[float]:
        """By ground action: the probability of it as an outcome; 1 for an action with one outcome."""
        return [float(probability) for probability in self.grounding.probabilities]

    @cached_property
    def free_actions(self) -> list[bool]:
        """By ground action: whether it certainly costs nothing."""
        return free_actions(self.grounding)

    @cached_property
    def means(self) -> Prices:
        """The problem at its expected costs."""
        return self.priced(Neutral())

    def priced(self, pricing: Pricing) -> Prices:
        """Return the problem at prices that add up."""
        found = price(self.grounding, pricing, self.limits)
        scale = Scale.first(found.bounds())
        return Prices(found.on(scale).handle, 2.0**-scale.exponent, _costs(found.actions), _costs(found.parts))

    def run(
        self,
        options: _relax.PolicySearchOptions,
        handle: _relax.PricedProblem,
        *,
        only_done_runs_pay: bool,
        sees_costs: bool = False,
    ) -> _relax.PolicyRun:
        """Return a run of the search in the core.

        Args:
            options: what it is asked for.
            handle: the problem at prices by which nodes are bounded.
            only_done_runs_pay: whether it does not matter what a run has cost that is not done.
            sees_costs: whether what comes next may depend on what actions have cost.
        """
        seen = uncertain_costs(self.grounding) if sees_costs else ([], [])
        by_action = self.probabilities, self.free_actions, *seen
        switches = self.switches.follow_forced, self.switches.forget_unreachable
        return _relax.PolicyRun(handle, options, *by_action, only_done_runs_pay, *switches)


@dataclass(frozen=True, slots=True)
class Prices:
    """Prices in the domain's unit.

    Args:
        handle: the ground problem at these prices in the core, in whole units.
        unit: one of these in the domain's unit.
        actions: by ground action.
        parts: by part of its cost.
    """

    handle: _relax.PricedProblem
    unit: float
    actions: Sequence[float]
    parts: Sequence[float]


def _costs(prices: Iterable[RiskCost]) -> list[float]:
    return [price.cost for price in prices]


def free_actions(grounding: Grounding) -> list[bool]:
    """Return for each ground action whether it certainly costs nothing."""
    free_parts = [law.most == 0 for law in grounding.part_laws]
    return [
        law.most == 0 and all(free_parts[part] for part in range(*grounding.handle.cost_parts(action)))
        for action, law in enumerate(grounding.laws)
    ]


def uncertain_costs(grounding: Grounding) -> tuple[list[bool], list[bool]]:
    """Return for each ground action, and for each part of a cost, whether what it costs tells something."""
    actions, parts = ([law.least != law.most for law in laws] for laws in (grounding.laws, grounding.part_laws))
    return actions, parts
