"""What a search for a policy returns: the policy with its value, what is proven about it, and the effort."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

from statehtn.counted import counted, finite
from statehtn.effort import Statistics
from statehtn.errors import UnsupportedError
from statehtn.found_plan import FoundPlan
from statehtn.model.status import Status
from statehtn.policies.policy import Policy
from statehtn.policies.settings import PolicySettings
from statehtn.risk import Success, certainty_equivalent
from statehtn.risk.policy_objectives import PolicyObjective


@dataclass(frozen=True, slots=True)
class Looking:
    """What it is worth to look at what was spent before each decision: the best plan does not.

    Args:
        plan: the best plan that was found.
        proven: whether it is proven to be the best.
        worth: its value minus that of the policy, in the objective's unit: at least 0, but for what is not proven.
    """

    plan: FoundPlan
    proven: bool
    worth: float

    def to_dict(self) -> dict[str, Any]:
        """Return the entry `looking` of the JSON object."""
        plan = [str(priced.step) for priced in self.plan.steps]
        return {"plan_value": self.plan.value, "worth": self.worth, "proven": self.proven, "plan": plan}


@dataclass(frozen=True, repr=False)
class PolicyResult:
    """The result of a search for a policy; what is not known is None.

    Args:
        status: how the run ended. `OPTIMAL`: no policy is better, to within the precision; `SOLVED`: the bounds say how
            much better one could be; `UNSOLVABLE`: none has a finite value, or none is done with probability 1;
            `reason` says which.
        settings: what was asked for.
        statistics: the effort.
        stopped: what ended the run before it was done, with or without a policy; None for nothing.
        policy: the best policy found.
        bound: no policy of the problem has a value below this (by `success`: above), in the objective's unit.
        reason: why there is no policy, in a sentence.
        most_success: where no policy is done with probability 1, the largest probability of being done, as far as it
            is known.
        looking: what it is worth to look at costs, where that was asked for and the plan was found.
        has_outcomes: whether actions of the problem have several outcomes.
        validated: how the policy was checked against the lifted problem, in words; None where it was not.
        value: what the policy is worth by the objective, in its unit, worked out from the policy alone. It is
            minimised, but for `success`, whose value is the probability of being done. Where that takes the law of the
            total cost, and it has too many amounts or a limit came first, it is what the search has found.
    """

    status: Status
    settings: PolicySettings
    statistics: Statistics = field(default_factory=Statistics)
    stopped: Status | None = None
    policy: Policy | None = None
    bound: float | None = None
    reason: str | None = None
    most_success: float | None = None
    looking: Looking | None = None
    has_outcomes: bool = False
    validated: str | None = None
    value: float | None = None

    def __bool__(self) -> bool:
        """Tell whether there is a policy."""
        return self.policy is not None

    def __repr__(self) -> str:
        found = "no policy"
        if self.policy is not None:
            found = f"{counted(len(self.policy), 'node')}, value {self.value:.10g}"
        return f"<policy result by '{self.objective}': {self.status}, {found}>"

    def __str__(self) -> str:
        from statehtn.display.policy_result import policy_result_text

        return policy_result_text(self)

    def _repr_html_(self) -> str:
        from statehtn.display.policy_result import policy_result_html

        return policy_result_html(self)

    @property
    def objective(self) -> PolicyObjective:
        """What policies are compared by."""
        return self.settings.objective

    @property
    def value_unit(self) -> str:
        """The unit of the objective's values: `cost`, `probability` or `utility` (minus the expected utility)."""
        return str(self.objective.unit)

    @property
    def problem_class(self) -> str | None:
        """The paper's RA-parameters of what was solved, such as `PSn0110`; None where the paper has no such class."""
        return self.settings.problem_class(self.has_outcomes)

    @cached_property
    def success_probability(self) -> float | None:
        """The probability that a run of the policy is done."""
        return None if self.policy is None else self.policy.success_probability

    @cached_property
    def expected_cost(self) -> float | None:
        """The expected cost of a run of the policy, failure costs included; may be infinite."""
        return None if self.policy is None else self.policy.expected_cost

    @cached_property
    def risk_cost(self) -> float | None:
        """The certain cost that has the policy's value, in the domain's unit; None where there is none."""
        if self.policy is None or isinstance(self.objective, Success):
            return None
        try:
            return certainty_equivalent(self.objective, self.policy.cost_distribution(), self.value)
        except UnsupportedError:
            return None

    @property
    def lower_bound(self) -> float | None:
        """The best policy has no value below this."""
        return self._bounds()[0]

    @property
    def upper_bound(self) -> float | None:
        """The best policy has no value above this."""
        return self._bounds()[1]

    @property
    def gap(self) -> float | None:
        """By how much the value of the policy may differ from that of the best one, in the objective's unit."""
        low, high = self._bounds()
        return None if low is None or high is None else high - low

    def _bounds(self) -> tuple[float | None, float | None]:
        value = finite(self.value)
        bound = finite(self.bound)
        if isinstance(self.objective, Success):
            return value, bound if bound is None or value is None else max(bound, value)
        return bound if bound is None or value is None else min(bound, value), value

    def to_dict(self) -> dict[str, Any]:
        """Return the object that `statehtn policy --json` prints; what is infinite is null."""
        return {
            "status": self.status.value,
            "problem_class": self.problem_class,
            "objective": str(self.objective),
            "attitude": self.settings.attitude,
            "alpha": self.settings.alpha,
            "failure_cost": self.settings.shown_failure_cost,
            "adaptive": self.settings.adaptive,
            "value": finite(self.value),
            "value_unit": self.value_unit,
            "lower_bound": self.lower_bound,
            "upper_bound": self.upper_bound,
            "gap": self.gap,
            "success_probability": self.success_probability,
            "expected_cost": finite(self.expected_cost),
            "risk_cost": finite(self.risk_cost),
            "policy": None if self.policy is None else self.policy.to_dict(),
            "looking": None if self.looking is None else self.looking.to_dict(),
            "reason": self.reason,
            "most_success": self.most_success,
            "validated": self.validated,
            "stopped": None if self.stopped is None else self.stopped.value,
            "statistics": self.statistics.to_dict(),
        }
