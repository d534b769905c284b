"""Policies as data: a decision for every state and network that can come up, and what may come of it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from enum import StrEnum

from statehtn.model.cost.law import CostLaw
from statehtn.model.plan import Step
from statehtn.model.problem import Fact


class End(StrEnum):
    """Why a run of a policy is over at a node."""

    DONE = "done"
    """The network is empty and the goal holds."""
    FAILED = "failed"
    """Nothing is left to try."""
    GIVEN_UP = "given up"
    """The agent stops though something could be tried."""


@dataclass(frozen=True, slots=True)
class Branch:
    """What may come of a decision.

    Args:
        probability: of it, above 0; those of a decision sum to 1.
        law: of what is paid where it comes: at least 0, in the domain's unit. Where the agent minds what it has spent,
            there is a branch for each amount, and this is the law of the costs that lead to it.
        successor: the index of the node that it leads to.
        added: ground facts that it makes true.
        deleted: ground facts that it makes false.
    """

    probability: float
    law: CostLaw
    successor: int
    added: frozenset[Fact] = frozenset()
    deleted: frozenset[Fact] = frozenset()


@dataclass(frozen=True, slots=True)
class Decision:
    """What the agent does at a node: decompose a task, or execute an action.

    Args:
        index: which of the node's tasks.
        task: the action or compound task as in the domain; None for what only the ground problem knows: an action that
            stands for a precondition of a method, a part of a method.
        method: the name of the method that decomposes it; None for an action.
        bindings: the objects of the method's parameters, where it is one of the domain's.
        branches: what may come of it; one unless an action has several outcomes, or its cost matters from there on.
    """

    index: int
    task: Step | None
    branches: tuple[Branch, ...]
    method: str | None = None
    bindings: tuple[str, ...] = ()

    @property
    def action(self) -> Step | None:
        """The action of the domain that is executed; None where nothing is."""
        return self.task if self.method is None else None


@dataclass(frozen=True, slots=True)
class PolicyNode:
    """A state and a remaining network, with what is left of an amount where that matters, and the decision there.

    Args:
        facts: the ground facts that hold, of those that matter from here on.
        tasks: the tasks of the network. What must hold at some point, a precondition of a method or the goal, is a task
            `condition` of literals, such as `(condition (in-hand cup) (not (torn)))`.
        order: pairs (i, j) of indices into the tasks: i before j.
        decision: None at an end.
        end: why a run is over here; None where it goes on.
        left: the amount that decisions depend on, minus what has been spent, in the domain's unit; minus infinity where
            that is below what still matters; None where decisions do not depend on it.
        known: the ground facts that matter from here on, true or false; None for all.
    """

    facts: frozenset[Fact]
    tasks: tuple[Step, ...]
    order: tuple[tuple[int, int], ...] = ()
    decision: Decision | None = None
    end: End | None = None
    left: float | None = None
    known: frozenset[Fact] | None = None


@dataclass(frozen=True, slots=True)
class FlatPolicy:
    """What runs of a policy do and cost, in lists: node 0 is where they begin.

    Args:
        ends: for each node why a run is over there; None where it goes on.
        first: for each node the index of its first branch, and at the end the number of all branches.
        probabilities: of each branch.
        laws: of what is paid on each branch.
        successors: the node that each branch leads to.
    """

    ends: Sequence[End | None]
    first: Sequence[int]
    probabilities: Sequence[float]
    laws: Sequence[CostLaw]
    successors: Sequence[int]

    @staticmethod
    def of(nodes: Sequence[PolicyNode]) -> FlatPolicy:
        """Return the lists of nodes."""
        first, branches = [0], list[Branch]()
        for node in nodes:
            branches += node.decision.branches if node.decision is not None else ()
            first.append(len(branches))
        return FlatPolicy(
            [node.end for node in nodes],
            first,
            [branch.probability for branch in branches],
            [branch.law for branch in branches],
            [branch.successor for branch in branches],
        )

    def __len__(self) -> int:
        return len(self.ends)

    def branches(self, node: int) -> range:
        """Return the indices of the branches of a node."""
        return range(self.first[node], self.first[node + 1])


@dataclass(frozen=True, slots=True)
class PolicyGraph:
    """The decisions of a policy: node 0 is where it begins, and only nodes that can come up are there.

    Args:
        nodes: made when they are asked for where there are many.
        flat: the same without names.
    """

    nodes: Sequence[PolicyNode]
    flat: FlatPolicy

    @staticmethod
    def of(nodes: Sequence[PolicyNode]) -> PolicyGraph:
        """Return the graph of nodes."""
        return PolicyGraph(nodes, FlatPolicy.of(nodes))

    def __len__(self) -> int:
        return len(self.nodes)
