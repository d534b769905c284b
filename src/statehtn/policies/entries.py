"""Nodes of policies as plain data, for JSON."""

from __future__ import annotations

import math
from typing import Any

from statehtn.model.cost.distribution import CostDistribution
from statehtn.model.policy_graph import Branch, Decision, PolicyNode
from statehtn.model.problem import Fact


def node_entry(node: PolicyNode) -> dict[str, Any]:
    """Return an entry of `policy.nodes` in the JSON object; an amount that no longer matters is null."""
    return {
        "facts": _texts(node.facts),
        "tasks": list(map(str, node.tasks)),
        "order": [list(pair) for pair in node.order],
        "left": None if node.left is None or math.isinf(node.left) else node.left,
        "end": None if node.end is None else node.end.value,
        "decision": None if node.decision is None else _decision_entry(node.decision),
    }


def _decision_entry(decision: Decision) -> dict[str, Any]:
    return {
        "index": decision.index,
        "task": None if decision.task is None else str(decision.task),
        "method": decision.method,
        "bindings": list(decision.bindings),
        "branches": list(map(_branch_entry, decision.branches)),
    }


def _branch_entry(branch: Branch) -> dict[str, Any]:
    """Return a branch; `outcomes` is null for a law that is no list of outcomes, and `law` then says what it is."""
    entry = {
        "probability": float(branch.probability),
        "successor": branch.successor,
        "added": _texts(branch.added),
        "deleted": _texts(branch.deleted),
        "expected_cost": branch.law.mean,
    }
    if isinstance(branch.law, CostDistribution):
        return entry | {"outcomes": [list(outcome) for outcome in branch.law.outcomes]}
    return entry | {"outcomes": None, "law": str(branch.law)}


def _texts(facts: frozenset[Fact]) -> list[str]:
    return sorted(f"({' '.join(fact)})" for fact in facts)
