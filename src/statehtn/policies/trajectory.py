"""A run of a policy from its beginning on: what was done, what came of it, and what it has cost."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from statehtn.counted import counted
from statehtn.model.cost.distribution import CostDistribution
from statehtn.model.cost.law import CostLaw
from statehtn.model.plan import Step
from statehtn.model.policy_graph import Branch, End, PolicyGraph
from statehtn.model.problem import Fact

if TYPE_CHECKING:
    from numpy.random import Generator

MOST_DRAWN = 100_000
"""Decisions of a run that is drawn; one that goes on has come to a loop."""


@dataclass(frozen=True, slots=True)
class TakenStep:
    """An action of a run, and what came of it.

    Args:
        step: the action.
        probability: of the outcome and of the cost that came; of the outcome alone where the cost has no list of them.
        added: ground facts that it has made true.
        deleted: ground facts that it has made false.
        cost: what it has cost, in the domain's unit.
    """

    step: Step
    probability: float
    added: frozenset[Fact]
    deleted: frozenset[Fact]
    cost: float


@dataclass(frozen=True, slots=True, repr=False, eq=False)
class Trajectory:
    """A run of a policy, or the beginning of one.

    Args:
        graph: the policy.
        branches: what came of each decision, as indices of `graph.flat`; those of decompositions included.
        costs: what was paid on each of them, in the domain's unit.
    """

    graph: PolicyGraph
    branches: tuple[int, ...]
    costs: tuple[float, ...]

    def __repr__(self) -> str:
        end = "goes on" if self.end is None else str(self.end)
        return f"<run of {counted(len(self.steps), 'step')}: {end}, cost {self.cost:.6g}>"

    @property
    def steps(self) -> tuple[TakenStep, ...]:
        """The actions with what came of them; those of the domain only."""
        return tuple(
            TakenStep(step, branch.probability * _chance(branch.law, cost), branch.added, branch.deleted, cost)
            for step, branch, cost in self._decisions()
            if step is not None
        )

    @property
    def cost(self) -> float:
        """What it has cost, without what failing may cost, in the domain's unit."""
        return math.fsum(self.costs)

    @property
    def probability(self) -> float:
        """The probability of what came of the decisions, whatever it has cost."""
        return math.prod(self.graph.flat.probabilities[branch] for branch in self.branches)

    @property
    def node(self) -> int:
        """The index of the node at which it stands."""
        return self.graph.flat.successors[self.branches[-1]] if self.branches else 0

    @property
    def end(self) -> End | None:
        """Why it is over; None where it goes on."""
        return self.graph.flat.ends[self.node]

    def _decisions(self) -> Iterator[tuple[Step | None, Branch, float]]:
        at = 0
        for index, cost in zip(self.branches, self.costs, strict=True):
            decision = self.graph.nodes[at].decision
            assert decision is not None
            branch = decision.branches[index - self.graph.flat.first[at]]
            yield decision.action, branch, cost
            at = branch.successor


def _chance(law: CostLaw, cost: float) -> float:
    """Return the probability of a cost; 1 for a law that is no list of outcomes."""
    outcomes = law.outcomes if isinstance(law, CostDistribution) else ()
    return next((probability for probability, outcome in outcomes if outcome == cost), 1.0)


def drawn(graph: PolicyGraph, generator: Generator) -> Trajectory:
    """Draw a run with a generator of numpy."""
    flat, at = graph.flat, 0
    branches: list[int] = []
    costs: list[float] = []
    while flat.ends[at] is None and len(branches) < MOST_DRAWN:
        options = flat.branches(at)
        taken = options[0] if len(options) == 1 else _drawn_of(options, flat.probabilities, generator)
        branches.append(taken)
        law = flat.laws[taken]
        costs.append(law.least if law.least == law.most else float(law.sample(1, generator)[0]))
        at = flat.successors[taken]
    return Trajectory(graph, tuple(branches), tuple(costs))


def _drawn_of(options: range, probabilities: Sequence[float], generator: Generator) -> int:
    wanted = generator.random() * math.fsum(probabilities[option] for option in options)
    for option in options:
        wanted -= probabilities[option]
        if wanted < 0:
            return option
    return options[-1]
