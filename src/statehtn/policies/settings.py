"""What is asked of the search for a policy: by which objective, what failing costs, and how near to the best."""

from __future__ import annotations

import math
from dataclasses import dataclass

from statehtn.core.switches import PolicySwitches
from statehtn.errors import UsageError
from statehtn.expected import number
from statehtn.risk import Attitude, AttitudeName, ObjectiveLike, Success, agent_in, problem_class
from statehtn.risk.policy_objectives import (
    PolicyObjective,
    check_failure_cost,
    check_has_policies,
    policy_objective_of,
)
from statehtn.settings import DEFAULT_PRECISION, objective_of, precision_of


@dataclass(frozen=True, slots=True)
class PolicySettings:
    """By what policies are compared, and how; make one by `PolicySettings.of`, which checks it.

    Args:
        objective: what is minimised, or `success`.
        failure_cost: what a run pays that fails, on top of what it has spent, in the domain's unit; may be infinite.
            None: only policies count that are done with probability 1, or by `success` those most likely to be done.
        adaptive: whether the best plan is looked for, too, which does not look at what was spent.
        precision: how far from the best a policy may be that counts as optimal, as a part of max(1, value).
        switches: refinements of the search that may be left out.
    """

    objective: PolicyObjective
    failure_cost: float | None = None
    adaptive: bool = False
    precision: float = DEFAULT_PRECISION
    switches: PolicySwitches = PolicySwitches()

    @staticmethod
    def of(
        objective: ObjectiveLike | Success | None = None,
        attitude: Attitude | AttitudeName | None = None,
        alpha: float | None = None,
        failure_cost: float | None = None,
        adaptive: bool = False,
        precision: float | None = None,
    ) -> PolicySettings:
        """Check the arguments, described at `statehtn.policy`.

        Raises:
            UsageError: a number is out of range, or they do not go together.
            UnsupportedError: no policy can be found by this objective.
        """
        wanted = policy_objective(objective, attitude, alpha)
        cost = None if failure_cost is None else _failure_cost(failure_cost, wanted)
        if not isinstance(adaptive, bool):
            raise UsageError(f"'adaptive' must be True or False, found {adaptive!r}")
        if adaptive and isinstance(wanted, Success):
            raise UsageError("what looking at costs is worth has no meaning by 'success', which looks at no costs")
        return PolicySettings(wanted, cost, adaptive, precision_of(precision, wanted))  # type: ignore[arg-type]

    def problem_class(self, has_outcomes: bool) -> str | None:
        """Return the paper's RA-parameters of what is solved, such as `PSn0110`; None where it has no such class."""
        if isinstance(self.objective, Success):
            return None
        found = problem_class("state", self.objective, "n" if has_outcomes else "1")
        return None if found is None else str(found)

    @property
    def shown_failure_cost(self) -> float | str | None:
        """What failing costs, as JSON has it: `inf` where it is infinite."""
        return "inf" if self.failure_cost is not None and math.isinf(self.failure_cost) else self.failure_cost

    @property
    def attitude(self) -> str | None:
        """The agent's attitude: neutral, averse or seeking; None for any other objective."""
        agent = None if isinstance(self.objective, Success) else agent_in(self.objective)
        return None if agent is None else str(agent.attitude)

    @property
    def alpha(self) -> float | None:
        """The curving coefficient of the exponential utility, per unit of cost; None for any other objective."""
        agent = None if isinstance(self.objective, Success) else agent_in(self.objective)
        return None if agent is None else agent.alpha


def policy_objective(
    wanted: ObjectiveLike | Success | None,
    attitude: Attitude | AttitudeName | None = None,
    alpha: float | None = None,
) -> PolicyObjective:
    """Return an objective from what a user gives, `success` included.

    Raises:
        UsageError: there is none like that, or it is given in two ways.
        UnsupportedError: no policy can be found by it.
    """
    found = policy_objective_of(wanted) if isinstance(wanted, str) else wanted
    if isinstance(found, Success):
        if attitude is not None or alpha is not None:
            raise UsageError("by 'success' policies are compared by the probability of being done, for any attitude")
        return found
    found = objective_of(found, attitude, alpha)
    check_has_policies(found)
    return found


def _failure_cost(given: float, objective: PolicyObjective) -> float:
    """Return what failing costs.

    Raises:
        UsageError: it is negative, infinite where that says nothing, or not asked for.
    """
    cost = number(given, "the failure cost")
    check_failure_cost(cost, objective)
    return cost
