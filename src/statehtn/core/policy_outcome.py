"""What a search for a policy returns."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from statehtn.core.policy_chord import ExploredPolicies
from statehtn.effort import SearchEffort
from statehtn.model.plan import Plan
from statehtn.model.policy_graph import PolicyGraph
from statehtn.model.status import Status


@dataclass(frozen=True, slots=True)
class PolicyOutcome:
    """How a search for a policy ended.

    Args:
        status: how it ended; `SOLVED` where a policy is not proven to be the best.
        stopped: what ended it before it was done, with or without a policy; None for nothing.
        lower: no policy has a lower value, in the unit of the objective; of `success`, where more is better, the
            probability of being done by the policy that was found. None where nothing is known.
        upper: the value of the policy that was found; of `success`, no policy is done with a higher probability.
        graph: the policy; None where none was found.
        effort: of all searches together.
        reason: why there is no policy, or none is known; None where there is one.
        most_success: where there is no policy, the largest probability of being done, as far as it was found.
        plan_of: the plan, with its decomposition, of a run of the policy as branches of `graph.flat` from the root on.
        explored: what an averse agent's search has explored; None after other searches.
    """

    status: Status
    stopped: Status | None
    lower: float | None
    upper: float | None
    graph: PolicyGraph | None
    effort: SearchEffort
    reason: str | None = None
    most_success: float | None = None
    plan_of: Callable[[Sequence[int]], Plan] | None = None
    explored: ExploredPolicies | None = None
