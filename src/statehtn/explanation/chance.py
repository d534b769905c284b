"""Why no policy will do: outcomes after which nothing is left, or loops that an averse agent loathes too much."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from statehtn.limits import Limits
from statehtn.model.plan import Step
from statehtn.model.policy_graph import Branch, End, PolicyGraph
from statehtn.model.problem import Fact
from statehtn.model.status import Status
from statehtn.policies.chain import Chain
from statehtn.policies.result import PolicyResult
from statehtn.policies.run import find_policy
from statehtn.policies.settings import PolicySettings
from statehtn.risk import Attitude, Exponential, Exponentials, Neutral, OneSwitch, Quantile, Success
from statehtn.risk.policy_objectives import PolicyObjective
from statehtn.session import Session

Changes = tuple[frozenset[Fact], frozenset[Fact]]
MOST_OUTCOMES = 20
"""Outcomes for which is worked out how likely they come."""
HALVINGS = 60
NEARLY_SURE = 1 - 1e-5
"""By the precision of the search, a policy may be done for certain above that."""


@dataclass(frozen=True, slots=True)
class BadOutcome:
    """An outcome of an action that stands in the way.

    Args:
        action: the action.
        changes: the facts that the outcome makes true, and those that it makes false.
        others: the same of all outcomes of the action there.
        probability: of the outcome when the action is executed.
        reached: the probability that a run of the policy that is most likely to be done comes to it at all.
    """

    action: Step
    changes: Changes
    others: tuple[Changes, ...]
    probability: float
    reached: float

    def to_dict(self) -> dict[str, Any]:
        """Return it as JSON has it."""
        added, deleted = (sorted(f"({' '.join(fact)})" for fact in facts) for facts in self.changes)
        return {
            "action": str(self.action),
            "added": added,
            "deleted": deleted,
            "probability": self.probability,
            "reached": self.reached,
        }


@dataclass(frozen=True, slots=True)
class NoPolicy:
    """Why a problem whose actions have several outcomes has no policy by an objective.

    Args:
        settings: what policies are compared by, and what failing costs.
        most_success: the largest probability of being done that was found; 1 where policies are done for certain.
        is_proven: whether no policy is done with a higher one.
        dead_ends: outcomes in the policy with that probability after which being done is impossible, the likeliest
            first; where runs without an end fail as well, they come on top.
        loops: where policies are done for certain, outcomes in the one of least expected cost after which it comes back
            to where it was.
        finite_below: the alpha below which that policy has a finite value for averse agents; None of other agents.
        failure: the probability that the policy that is most likely done is not, right however small it is; None where
            there is none.
    """

    settings: PolicySettings
    most_success: float
    is_proven: bool
    dead_ends: tuple[BadOutcome, ...] = ()
    loops: tuple[BadOutcome, ...] = ()
    finite_below: float | None = None
    failure: float | None = None

    @property
    def objective(self) -> PolicyObjective:
        """What policies are compared by."""
        return self.settings.objective

    @property
    def wanted_success(self) -> float:
        """The least probability of being done with which a policy would count."""
        if self.settings.failure_cost is not None and isinstance(self.objective, Quantile):
            return self.objective.level
        return 1.0

    def to_dict(self) -> dict[str, Any]:
        """Return the entry `chance` of the JSON object."""
        return {
            "objective": str(self.objective),
            "failure_cost": self.settings.shown_failure_cost,
            "wanted_success": self.wanted_success,
            "most_success": self.most_success,
            "proven": self.is_proven,
            "dead_ends": [each.to_dict() for each in self.dead_ends],
            "loops": [each.to_dict() for each in self.loops],
            "finite_below": self.finite_below,
        }


def why_no_policy(session: Session, settings: PolicySettings, limits: Limits) -> NoPolicy | PolicyResult:
    """Return why there is no policy; the result of the search for one where there is, or where that is not known.

    Where nothing is ever done, the probability of being done is 0: that is not a matter of chance.

    Raises:
        UnsupportedError: there are no policies by this objective, or of this problem.
        InputError: a probability is none.
    """
    wanted = find_policy(session, settings, limits)
    if isinstance(settings.objective, Success) and wanted.value == 0:
        return NoPolicy(settings, 0.0, wanted.status is Status.OPTIMAL)
    if wanted.policy is not None or wanted.status is not Status.UNSOLVABLE:
        return wanted
    return reasons_of_chance(session, settings, limits)


def what_is_lost(found: PolicyResult) -> NoPolicy | None:
    """Return what keeps the policy that is most likely done from being done for certain; None of other policies."""
    if found.policy is None or not isinstance(found.objective, Success) or not found.policy.failure_probability:
        return None
    ends = tuple(_dead_ends(found.policy.graph, Chain(found.policy.graph.flat)))
    lost = found.policy.failure_probability
    return NoPolicy(
        found.settings, found.policy.success_probability, found.status is Status.OPTIMAL, ends, failure=lost
    )


def reasons_of_chance(session: Session, settings: PolicySettings, limits: Limits) -> NoPolicy | PolicyResult:
    """Return why there is no policy, where that is known; the result of the search for the likeliest if it has none.

    Raises:
        InputError: a probability is none.
    """
    likely = find_policy(session, PolicySettings.of(Success()), limits)
    policy = likely.policy
    if policy is None:
        return likely
    chain = Chain(policy.graph.flat)
    is_proven = likely.status is Status.OPTIMAL
    if not chain.sure[0] and not isinstance(settings.objective, Neutral) and (likely.bound or 0.0) > NEARLY_SURE:
        calm = find_policy(session, PolicySettings.of(Neutral()), limits).policy  # has all that are done for certain
        if calm is not None:
            policy, chain = calm, Chain(calm.graph.flat)
    if chain.sure[0]:
        below = _finite_below(chain, settings.objective)
        return NoPolicy(settings, 1.0, True, (), tuple(_loops(policy.graph, chain)), below)
    ends = tuple(_dead_ends(policy.graph, chain))
    return NoPolicy(settings, likely.value or 0.0, is_proven, ends, failure=policy.failure_probability)


def _dead_ends(graph: PolicyGraph, chain: Chain) -> list[BadOutcome]:
    """Return the outcomes of a policy that lead from where it may be done to where it never is."""
    alive = _alive(graph)
    leading = [
        (node, branch)
        for node in range(len(graph))
        if alive[node]
        for branch in graph.flat.branches(node)
        if not alive[graph.flat.successors[branch]]
    ]
    return _outcomes(graph, chain, leading)


def _loops(graph: PolicyGraph, chain: Chain) -> list[BadOutcome]:
    """Return the outcomes of a policy after which it may come back to where it was."""
    component = [0] * len(graph)
    for number, nodes in enumerate(chain.order):
        for node in nodes:
            component[node] = number
    flat = graph.flat
    staying = [
        (node, branch)
        for node in range(len(graph))
        for branch in flat.branches(node)
        if component[flat.successors[branch]] == component[node] and len(flat.branches(node)) > 1
    ]
    return _outcomes(graph, chain, staying)


def _outcomes(graph: PolicyGraph, chain: Chain, found: Sequence[tuple[int, int]]) -> list[BadOutcome]:
    """Return the outcomes that branches stand for, those of an action that are the same once, the likeliest first."""
    groups: dict[tuple[object, ...], tuple[BadOutcome, set[int]]] = {}
    for node, branch in found:
        decision = graph.nodes[node].decision
        if decision is None or decision.action is None:
            continue
        own: Branch = decision.branches[branch - graph.flat.first[node]]
        others = tuple(dict.fromkeys((each.added, each.deleted) for each in decision.branches))
        bad = BadOutcome(decision.action, (own.added, own.deleted), others, own.probability, 0.0)
        groups.setdefault((bad.action, bad.changes, bad.probability), (bad, set()))[1].add(branch)
    several = [
        BadOutcome(bad.action, bad.changes, bad.others, bad.probability, chain.probability_of(branches))
        for bad, branches in list(groups.values())[:MOST_OUTCOMES]
    ]
    return sorted(several, key=lambda bad: -bad.reached)


def _alive(graph: PolicyGraph) -> bytearray:
    """Return for each node whether a run of the policy may be done from it."""
    flat = graph.flat
    before: list[list[int]] = [[] for _ in range(len(graph))]
    for node in range(len(graph)):
        for branch in flat.branches(node):
            before[flat.successors[branch]].append(node)
    alive = bytearray(end is End.DONE for end in flat.ends)
    pending = [node for node in range(len(graph)) if alive[node]]
    while pending:
        for node in before[pending.pop()]:
            if not alive[node]:
                alive[node] = True
                pending.append(node)
    return alive


def _steepest(objective: PolicyObjective) -> float:
    """Return the largest alpha by which an agent shuns risk; 0 where there is none."""
    match objective:
        case Exponential(attitude=Attitude.AVERSE, alpha=alpha):
            return alpha
        case OneSwitch() | Exponentials():
            return max((term.slope for term in objective.terms), default=0.0)
    return 0.0


def _finite_below(chain: Chain, objective: PolicyObjective) -> float | None:
    """Return the alpha below which averse agents find a policy finite; found by halving an interval."""
    low, high = 0.0, _steepest(objective)
    if high <= 0:
        return None
    for _ in range(HALVINGS):
        middle = (low + high) / 2
        if math.isfinite(chain.exponential_mean(middle, 0.0)):
            low = middle
        else:
            high = middle
    return low
