"""Search nodes of the reference solvers, and the two steps from one to the next: execute a task, decompose a task."""

from __future__ import annotations

from dataclasses import dataclass

from statehtn.model.ground import GroundProblem
from statehtn.model.plan import Plan
from statehtn.model.status import Status
from statehtn.reference.read_plan import Choice, Execution
from statehtn.reference.task_network import Identifier, TaskNetwork
from statehtn.risk import Utility


@dataclass(frozen=True)
class SearchNode:
    """A search node: n.s, n.tn, n.pi and the sum of the plan's risk costs.

    Args:
        state: the facts that hold.
        network: what is still to be done.
        plan: the actions so far, precondition actions included.
        choices: the methods so far.
        cost: the risk cost of the plan so far, positive, in the domain's unit.
        next_identifier: the first one that no task has had.
    """

    state: frozenset[int]
    network: TaskNetwork
    plan: tuple[Execution, ...] = ()
    choices: tuple[Choice, ...] = ()
    cost: float = 0.0
    next_identifier: int = 1


@dataclass(frozen=True)
class Solution:
    """How a search ended: optimal, unsolvable, or exhausted where it gave up.

    Args:
        status: one of these three.
        plan: the plan with its decomposition.
        risk_cost: its certainty-equivalent cost, positive, in the domain's unit.
        expanded: the number of nodes that were expanded.
    """

    status: Status
    plan: Plan | None = None
    risk_cost: float | None = None
    expanded: int = 0


def initial_node(problem: GroundProblem) -> SearchNode:
    """Return the node of the initial state, the initial task and the empty plan.

    Raises:
        ValueError: the problem is not plain, so that no decomposition could be read from it, or an action has several
            outcomes, of which a plan cannot choose one.
    """
    if problem.chance_tasks:
        raise ValueError("the reference search takes problems whose actions have one outcome")
    if not problem.is_plain:
        raise ValueError("the reference search takes plain ground problems: ground(problem, switches=PLAIN)")
    return SearchNode(problem.initial_state, TaskNetwork({0: problem.initial_task}))


def apply(node: SearchNode, identifier: Identifier, problem: GroundProblem, utility: Utility) -> SearchNode:
    """Return the node after an unconstrained primitive task has been executed (`n.apply` of Algorithm 4)."""
    task = node.network.tasks[identifier]
    action = problem.actions[task]
    return SearchNode(
        action.apply(node.state),
        node.network.without(identifier),
        (*node.plan, Execution(identifier, task)),
        node.choices,
        node.cost + sum(map(utility.risk_cost, action.costs_in(node.state))),
        node.next_identifier,
    )


def decompose(node: SearchNode, identifier: Identifier, method: int, problem: GroundProblem) -> SearchNode:
    """Return the node after a compound task has been decomposed by a method (`n.decompose` of Algorithm 4)."""
    first = node.next_identifier
    return SearchNode(
        node.state,
        node.network.decomposed(identifier, problem.methods[method], first),
        node.plan,
        (*node.choices, Choice(identifier, method, first)),
        node.cost,
        first + len(problem.methods[method].subtasks),
    )
