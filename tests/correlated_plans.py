"""The best plans of a small problem whose costs hang together: the judge of objectives over scenarios.

Exhaustive, as `all_laws`: a node is a state, a network and, for each scenario, the exact law of what the way has cost.
"""

from __future__ import annotations

import heapq
import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction

from statehtn.model import Problem, Step
from tests.all_laws import MOST_NODES, MOST_OUTCOMES, Actions, Budget, LawSpace
from tests.brute_force import LARGEST_NETWORK, Canonical, GaveUp, Node
from tests.exact_laws import Law
from tests.exact_objectives import SLACK, ExactObjective
from tests.naive_semantics import State

Given = tuple[Law, ...]
"""A law in each scenario."""


@dataclass(frozen=True)
class Plan:
    """A plan that is the best there is: its actions, its law over all scenarios, and its value."""

    steps: Actions
    law: Law
    value: Fraction


class ScenarioSpace(LawSpace):
    """The search space of a problem, with the laws of what its steps cost in each scenario."""

    def __init__(self, problem: Problem) -> None:
        super().__init__(problem)
        self.scenarios = [scenario.facts for scenario in problem.scenarios]
        outcomes = itertools.product(*(chance.outcomes for chance in problem.chances))
        self.weights = dict.fromkeys(self.scenarios, Fraction(0))
        for chosen in outcomes:
            facts: frozenset[tuple[str, ...]] = frozenset().union(*(outcome.facts for outcome in chosen))
            self.weights[facts] += math.prod((outcome.probability for outcome in chosen), start=Fraction(1))
        self.given: dict[tuple[Step, State], Given] = {}

    def mixture(self, given: Given, more: Law) -> Law:
        """The law over all scenarios of what was spent and an independent cost."""
        found: dict[Fraction, Fraction] = {}
        for facts, law in zip(self.scenarios, given, strict=True):
            for cost, probability in self.laws.sum(law, more).outcomes:
                found[cost] = found.get(cost, Fraction(0)) + self.weights[facts] * probability
        return self.laws.of(found)

    def after(self, given: Given, step: Step, state: State) -> Given:
        """What was spent in each scenario after an action."""
        if (step, state) not in self.given:
            exact = self.space.semantics.exact_law
            self.given[step, state] = tuple(
                self.laws.of(exact(step.action, step.arguments, state | facts)) for facts in self.scenarios
            )
        return tuple(map(self.laws.sum, given, self.given[step, state]))


def best_plan(
    problem: Problem, objective: ExactObjective, keep: Sequence[Budget] = (), most_nodes: int = MOST_NODES
) -> Plan | None:
    """The best plan of those that keep the budgets; None if there is none.

    Raises:
        GaveUp: there were more than so many different nodes, tasks in a network or outcomes in a law.
    """
    space, canonical = ScenarioSpace(problem), Canonical()
    generated = itertools.count()
    queue: list[tuple[Fraction, Fraction, int, int, Node, Given, Actions]] = []
    seen: set[object] = set()
    best: Plan | None = None

    def add(node: Node, given: Given, steps: Actions) -> None:
        key = (node.state, canonical(node.network), tuple(law.number for law in given))
        if key in seen:
            return
        seen.add(key)
        least = space.mixture(given, space.due(node.network))
        if all(least.at_most(budget) >= probability - SLACK for budget, probability in keep):
            if len(least.weights) > MOST_OUTCOMES:
                raise GaveUp
            size = len(node.network)
            entry = (objective.bound(least), least.mean, size, next(generated), node, given, steps)
            heapq.heappush(queue, entry)

    for root in space.space.roots():
        add(root, (space.laws.zero,) * len(space.scenarios), ())
    while queue:
        bound, _, size, _, node, given, steps = heapq.heappop(queue)
        if best is not None and bound >= best.value:
            break
        if len(seen) > most_nodes or size > LARGEST_NETWORK:
            raise GaveUp
        if space.space.is_goal(node):
            law = space.mixture(given, space.laws.zero)
            value = objective.value(law)
            if best is None or value < best.value:
                best = Plan(steps, law, value)
        for _, successor in space.space.successors(node, None):
            step = successor.last.step if successor.last is not node.last else None
            if step is None:
                add(successor, given, steps)
            else:
                add(successor, space.after(given, step, node.state), (*steps, step))
    return best
