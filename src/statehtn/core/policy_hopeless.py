"""Policies of problems of which grounding has proven that they cannot be done: to stop at once is all there is."""

from __future__ import annotations

import math

from statehtn.core.policy_outcome import PolicyOutcome
from statehtn.effort import SearchEffort
from statehtn.model import CostDistribution
from statehtn.model.policy_graph import End, PolicyGraph, PolicyNode
from statehtn.model.status import Status
from statehtn.risk import Deadline, Objective
from statehtn.risk.success import Success


def hopeless(objective: Objective | Success, failure_cost: float | None) -> PolicyOutcome:
    """Return the outcome of a problem that cannot be done.

    Args:
        objective: what is minimised; `Success` is maximised.
        failure_cost: what giving up costs; None where only policies that are done with probability 1 count.
    """
    if isinstance(objective, Success):
        value: float | None = 0.0
    elif failure_cost is None:
        value = None
    elif math.isinf(failure_cost):
        value = 1.0 if isinstance(objective, Deadline) else None
    else:
        value = objective.value(CostDistribution.certain(failure_cost))
    if value is None:
        return PolicyOutcome(Status.UNSOLVABLE, None, None, None, None, SearchEffort(), "nothing can be done", 0.0)
    graph = PolicyGraph.of([PolicyNode(frozenset(), (), end=End.GIVEN_UP)])
    return PolicyOutcome(Status.OPTIMAL, None, value, value, graph, SearchEffort())
