"""What the plans of a small problem cost, each by its exact law, and the best of them: the judge of all objectives.

Exhaustive, without any rule of dominance: a node is a state, a network and the law of what the way to it has cost, and
only equal nodes are one. It shares neither the planner's search nor its laws.
"""

from __future__ import annotations

import heapq
import itertools
import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction

from statehtn.model import Problem, Step
from tests.brute_force import LARGEST_NETWORK, Canonical, GaveUp, Node, Pending, Space, Task
from tests.exact_laws import Law, Laws
from tests.exact_objectives import SLACK, ExactObjective, deadline
from tests.naive_semantics import State

MOST_NODES = 1000
MOST_OUTCOMES = 200  # of a law
Actions = tuple[Step, ...]
Budget = tuple[Fraction, Fraction]  # a budget, and the probability with which it is to be kept


@dataclass(frozen=True)
class Outlook:
    """A plan, or one of those with the same law, and that law."""

    steps: Actions
    law: Law


@dataclass(frozen=True)
class Best:
    """A plan that is among the best."""

    value: Fraction
    outlook: Outlook


class LawSpace:
    """The search space of a problem, with the laws of what its steps cost."""

    def __init__(self, problem: Problem) -> None:
        self.space = Space(problem)
        self.laws = Laws()
        self.always: dict[str, Law] = {}
        self.costs: dict[tuple[Step, State], Law] = {}

    def due(self, network: Sequence[Pending]) -> Law:
        """The law of what the actions in a network cost in every state."""
        total = self.laws.zero
        for label in sorted(pending.label for pending in network if self.always_due(pending) is not self.laws.zero):
            total = self.laws.sum(total, self.always[label])
        return total

    def always_due(self, pending: Pending) -> Law:
        if pending.label not in self.always:
            law = self.laws.zero
            actions = self.space.problem.domain.actions
            if isinstance(pending, Task) and pending.name in actions:
                semantics = self.space.semantics
                if semantics.bind(actions[pending.name], pending.arguments) is not None:
                    law = self.laws.of(semantics.exact_law(pending.name, pending.arguments, None))
            self.always[pending.label] = law
        return self.always[pending.label]

    def successors(self, node: Node, law: Law) -> Iterator[tuple[Node, Law, Step | None]]:
        """All nodes one step further, each with the law of what it has cost so far, and the action if it was one."""
        for _, successor in self.space.successors(node, None):
            step = successor.last.step if successor.last is not node.last else None
            if step is None:
                yield successor, law, None
            else:
                yield successor, self.laws.sum(law, self.cost(step, node.state)), step

    def cost(self, step: Step, state: State) -> Law:
        """The law of what an action costs in a state."""
        if (step, state) not in self.costs:
            exact = self.space.semantics.exact_law(step.action, step.arguments, state)
            self.costs[step, state] = self.laws.of(exact)
        return self.costs[step, state]


def all_outlooks(
    problem: Problem, distinct: str = "law", most: int = MOST_NODES, largest_network: float = LARGEST_NETWORK
) -> list[Outlook]:
    """All plans that differ in their `law`, `multiset` of actions and law, or `sequence`, if there are finitely many.

    Raises:
        GaveUp: there were more than so many different nodes, tasks in a network or outcomes in a law.
    """
    space, canonical = LawSpace(problem), Canonical()
    pending: list[tuple[Node, Law, Actions]] = [(root, space.laws.zero, ()) for root in space.space.roots()]
    seen: set[object] = set()
    found: dict[object, Outlook] = {}
    while pending:
        node, law, steps = pending.pop()
        told = told_apart(steps, distinct)
        key = (node.state, canonical(node.network), law.number, told)
        if key in seen:
            continue
        seen.add(key)
        if len(seen) > most or len(node.network) > largest_network or len(law.weights) > MOST_OUTCOMES:
            raise GaveUp
        if space.space.is_goal(node):
            found.setdefault((told, law.number), Outlook(steps, law))
        for successor, after, step in space.successors(node, law):
            pending.append((successor, after, steps if step is None else (*steps, step)))
    return list(found.values())


def law_of(problem: Problem, steps: Sequence[Step]) -> Law:
    """The law of what actions cost, one after the other from the initial state on."""
    space = LawSpace(problem)
    law, state = space.laws.zero, problem.initial_state
    for step in steps:
        law = space.laws.sum(law, space.cost(step, state))
        after = space.space.semantics.execute(step.action, step.arguments, state)
        assert after is not None, f"{step} cannot be executed"
        state = after
    return law


def told_apart(steps: Actions, distinct: str) -> Actions:
    """What two plans have to have in common to count as one."""
    if distinct == "law":
        return ()
    return tuple(sorted(steps, key=str)) if distinct == "multiset" else steps


def best_plans(
    problem: Problem,
    objective: ExactObjective,
    k: int = 1,
    distinct: str = "law",
    keep: Sequence[Budget] = (),
    most_nodes: int = MOST_NODES,
) -> list[Best]:
    """The k best plans, best first, of those that keep the budgets; all if there are fewer.

    Best first by the bound of the law of what is spent, with what the actions in the network will cost in every state:
    recursion that costs something comes to its end by this.

    Raises:
        GaveUp: there were more than so many different nodes, tasks in a network or outcomes in a law.
    """
    space, canonical = LawSpace(problem), Canonical()
    generated = itertools.count()
    queue: list[tuple[Fraction, Fraction, int, int, Node, Law, Actions]] = []
    seen: set[object] = set()
    best: dict[object, Best] = {}
    bounds: dict[int, Fraction] = {}

    def add(node: Node, law: Law, steps: Actions) -> None:
        key = (node.state, canonical(node.network), law.number, told_apart(steps, distinct))
        if key in seen:
            return
        seen.add(key)
        least = space.laws.sum(law, space.due(node.network))
        if all(least.at_most(budget) >= probability - SLACK for budget, probability in keep):
            if len(least.weights) > MOST_OUTCOMES:
                raise GaveUp
            if least.number not in bounds:
                bounds[least.number] = objective.bound(least)
            size = len(node.network)
            heapq.heappush(queue, (bounds[least.number], least.mean, size, next(generated), node, law, steps))

    for root in space.space.roots():
        add(root, space.laws.zero, ())
    while queue:
        bound, _, size, _, node, law, steps = heapq.heappop(queue)
        if bound >= kth(best, k):
            break
        if len(seen) > most_nodes or size > LARGEST_NETWORK:
            raise GaveUp
        if space.space.is_goal(node):
            told = told_apart(steps, distinct) if distinct != "law" else law
            value = objective.value(law)
            if told not in best or value < best[told].value:
                best[told] = Best(value, Outlook(steps, law))
        for successor, after, step in space.successors(node, law):
            add(successor, after, steps if step is None else (*steps, step))
    return sorted(best.values(), key=lambda one: one.value)[:k]


def kth(best: dict[object, Best], k: int) -> float | Fraction:
    """The value from which on plans are not among the k best."""
    return math.inf if len(best) < k else sorted(one.value for one in best.values())[k - 1]


def largest_probability(problem: Problem, budget: Fraction, most_nodes: int = MOST_NODES) -> Fraction | None:
    """The largest probability with which a plan keeps a budget; None if there is no plan.

    Raises:
        GaveUp: as `best_plans`.
    """
    value = deadline(budget)
    best = best_plans(problem, ExactObjective(f"deadline {budget}", value, value), most_nodes=most_nodes)
    return 1 - best[0].value if best else None
