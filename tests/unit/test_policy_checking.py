"""Policies that are wrong are found so by the lifted problem."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import pytest

import statehtn
from statehtn import CostDistribution
from statehtn.errors import InternalError
from statehtn.model.policy_graph import Branch, Decision, End, PolicyGraph, PolicyNode
from statehtn.policies.checking import check_policy
from statehtn.policies.policy import Policy

GRIPPER = ("domains/gripper-robot/domain.hddl", "domains/gripper-robot/p1.hddl")
SEEN = frozenset({("in-hand", "ball"), ("on-belt", "ball"), ("hand-empty",), ("torn",)})


@pytest.fixture
def policy() -> Policy:
    found = statehtn.policy(statehtn.read_hddl(*GRIPPER)).policy
    assert found is not None
    return found


def changed(policy: Policy, change: Callable[[PolicyNode], PolicyNode]) -> Policy:
    graph = PolicyGraph.of([change(node) for node in policy.graph.nodes])
    return Policy(policy.problem, graph, policy.objective, None, policy._plan_of)


def test_a_right_policy_is_right(policy: Policy) -> None:
    checked = check_policy(policy, SEEN)
    assert (checked.is_all, checked.covers) == (True, True)
    assert checked.runs >= 2


def branches(node: PolicyNode, change: Callable[[Branch], Branch]) -> PolicyNode:
    decision = node.decision
    if decision is None or decision.action is None:
        return node
    return replace(node, decision=replace(decision, branches=tuple(map(change, decision.branches))))


def other_probability(node: PolicyNode) -> PolicyNode:
    return branches(node, lambda branch: replace(branch, probability=0.6 if branch.added else 0.4))


def other_cost(node: PolicyNode) -> PolicyNode:
    return branches(node, lambda branch: replace(branch, law=CostDistribution.certain(2)))


def other_effect(node: PolicyNode) -> PolicyNode:
    return branches(node, lambda branch: replace(branch, added=frozenset({("torn",)})))


def other_action(node: PolicyNode) -> PolicyNode:
    decision = node.decision
    if decision is None or decision.action is None or decision.action.action != "suck":
        return node
    return replace(node, decision=replace(decision, task=statehtn.Step("place", ("ball",))))


def ends_early(node: PolicyNode) -> PolicyNode:
    is_place = node.decision is not None and node.decision.action == statehtn.Step("place", ("ball",))
    return replace(node, decision=None, end=End.DONE) if is_place else node


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (other_probability, "probability"),
        (other_cost, "costs"),
        (other_effect, "outcome"),
        (other_action, "precondition"),
        (ends_early, "tasks left"),
    ],
)
def test_wrong_ones_are_wrong(policy: Policy, change: Callable[[PolicyNode], PolicyNode], message: str) -> None:
    with pytest.raises(InternalError, match=message):
        check_policy(changed(policy, change), SEEN)


def test_a_decision_has_a_kind() -> None:
    step = statehtn.Step("go")
    assert Decision(0, step, ()).action == step
    assert Decision(0, step, (), "by-going").action is None
