"""What a search for an averse agent tells about less patient ones: lines below the values of all policies."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import statehtn._relax as _relax
from statehtn.core.grounding import STOPPED
from statehtn.core.policy_problem import PolicyProblem
from statehtn.limits import Limits, ending_by
from statehtn.model.cost.by_law import by_law
from statehtn.model.cost.law import CostLaw

Line = tuple[float, float]
"""Its values at both ends of an interval."""


@dataclass(frozen=True, slots=True)
class ExploredPolicies:
    """What a search for an averse agent has explored.

    Args:
        problem: the ground problem.
        run: the search in the core.
        x: 1 / alpha of the agent, in the domain's unit of cost.
    """

    problem: PolicyProblem
    run: _relax.PolicyRun
    x: float

    def chord(
        self, line_of: Callable[[CostLaw], Line], low: float, high: float, touching: float, enough: Line, limits: Limits
    ) -> Line | None:
        """Return a line that is below the certainty equivalents of all policies on an interval of 1 / alpha.

        Args:
            line_of: returns a line that is below the certainty equivalents of a law there.
            low: the lower end, at least 0.
            high: the upper end, at most `x`.
            touching: where it is to be near the best certainty equivalent: in the interval, above 0.
            enough: values at both ends that need not be exceeded; as long as they are not reached, more is explored.
            limits: they hold.

        Returns:
            None where sums of steps, which may be negative, have no least one, or nothing is finite at `touching`.

        Raises:
            LimitReached, KeyboardInterrupt: a limit was reached, or Ctrl-C pressed.
            InputError: a law has no line, as `line_of` says.
        """
        grounding = self.problem.grounding
        actions, parts = by_law(grounding.laws, line_of), by_law(grounding.part_laws, line_of)
        ends = [([line[end] for line in actions], [line[end] for line in parts]) for end in (0, 1)]
        stop, found = self.run.chord(ends[0], ends[1], low, high, touching, self.x, enough, *limits.left())
        if stop is not None:
            raise ending_by(STOPPED[stop])
        return found
