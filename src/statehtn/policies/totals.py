"""The total cost of a policy's runs, amount by amount: how likely each is, among runs that are done and that fail."""

from __future__ import annotations

import heapq
import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from itertools import accumulate

from statehtn.errors import UnsupportedError
from statehtn.limits import Limits
from statehtn.model.cost.distribution import CostDistribution
from statehtn.model.cost.law import CostLaw
from statehtn.model.cost.sum import CostSum
from statehtn.model.fraction import fraction_of
from statehtn.model.policy_graph import End
from statehtn.policies.chain import Chain
from statehtn.policies.components import components
from statehtn.policies.equations import solution

NOTHING = 1e-20
"""Of the probability of being at a node with an amount spent: less is cut off."""
MOST_WORK = 10_000_000
"""Outcomes of decisions, amount by amount, that are followed: some ten seconds."""
UNITS = 1024  # of work between two looks at the limits


@dataclass(slots=True)
class Totals:
    """How likely each amount is as the total cost of a run, in units.

    Args:
        unit: of an amount, in the domain's unit.
        done: the probability of each amount among runs that are done.
        failed: that among runs that fail, as far as they have come.
        endless: the probability of runs that pay again and again and never end.
        cut: the probability of the runs that were not followed to their end.
    """

    unit: Fraction
    done: dict[int, float] = field(default_factory=dict)
    failed: dict[int, float] = field(default_factory=dict)
    endless: float = 0.0
    cut: float = 0.0


def totals_of(chain: Chain, limits: Limits = Limits()) -> Totals:
    """Follow the runs of a policy from amount to amount.

    Loops that cost nothing are solved as linear equations at each amount; loops that cost something go on until what is
    left of them is negligible (`NOTHING`).

    Raises:
        UnsupportedError: a cost is no list of outcomes, or there are too many amounts.
        LimitReached: a limit was reached before that.
    """
    return _Walk(chain, limits).totals()


class _Walk:
    def __init__(self, chain: Chain, limits: Limits) -> None:
        flat = chain.flat
        self.chain = chain
        self.limits = limits
        laws = {id(law): law for law in flat.laws}
        finite = {key: outcomes_of(law) for key, law in laws.items()}
        per_unit = math.lcm(*(cost.denominator for outcomes in finite.values() for _, cost in outcomes), 1)
        self.found = Totals(Fraction(1, per_unit))
        amounts = {key: [(p, int(cost * per_unit)) for p, cost in outcomes] for key, outcomes in finite.items()}
        self.free: list[list[tuple[int, float]]] = []
        """For each node its successors at no cost, with their probabilities."""
        self.paid: list[list[tuple[int, float, int]]] = []
        """For each node its successors at a cost, with probability and amount."""
        for node in range(len(flat)):
            free: dict[int, float] = {}
            paid: list[tuple[int, float, int]] = []
            for branch in flat.branches(node):
                other = flat.successors[branch]
                for p, amount in amounts[id(flat.laws[branch])]:
                    weight = flat.probabilities[branch] * p
                    if amount:
                        paid.append((other, weight, amount))
                    else:
                        free[other] = free.get(other, 0.0) + weight
            self.free.append(list(free.items()))
            self.paid.append(paid)
        first = [0, *accumulate(map(len, self.free))]
        self.groups = components(first, [other for free in self.free for other, _ in free])
        self.rank = [0] * len(flat)  # of its group among those that cost nothing to reach from each other
        for rank, group in enumerate(self.groups):
            for node in group:
                self.rank[node] = rank
        self.pending: dict[int, dict[int, float]] = {0: {0: 1.0}}
        self.levels = [0]

    def totals(self) -> Totals:
        """Return the amounts with their probabilities."""
        work = looked = 0
        while self.levels:
            amount = heapq.heappop(self.levels)
            work += self._settle(amount, self.pending.pop(amount))
            if work > looked:
                self.limits.check()
                looked = work + UNITS
            if work > MOST_WORK:
                raise UnsupportedError(
                    "the total cost of this policy has too many values to be listed; ask for its expected_cost, for "
                    "its certainty equivalents, or for a simulation"
                )
        return self.found

    def _settle(self, amount: int, masses: dict[int, float]) -> int:
        """Move what is at nodes with an amount spent on to ends and to larger amounts; return the work it took.

        Groups come in the order in which they lead to each other.
        """
        flat, work = self.chain.flat, 0
        waiting = {self.rank[node] for node in masses}
        queue = [-rank for rank in waiting]
        heapq.heapify(queue)
        while queue:
            rank = -heapq.heappop(queue)
            group = self.groups[rank]
            for node, mass in self._visits(group, masses):
                work += 1
                if flat.ends[node] is not None or self.chain.stuck[node]:
                    ended = self.found.done if flat.ends[node] is End.DONE else self.found.failed
                    ended[amount] = ended.get(amount, 0.0) + mass
                elif self.chain.endless[node]:
                    self.found.endless += mass
                elif mass < NOTHING:
                    self.found.cut += mass
                else:
                    for other, weight in self.free[node]:
                        if self.rank[other] != rank:
                            masses[other] = masses.get(other, 0.0) + mass * weight
                            if self.rank[other] not in waiting:
                                waiting.add(self.rank[other])
                                heapq.heappush(queue, -self.rank[other])
                    for other, weight, more in self.paid[node]:
                        if amount + more not in self.pending:
                            self.pending[amount + more] = {}
                            heapq.heappush(self.levels, amount + more)
                        level = self.pending[amount + more]
                        level[other] = level.get(other, 0.0) + mass * weight
                    work += len(self.free[node]) + len(self.paid[node])
        return work

    def _visits(self, group: Sequence[int], masses: dict[int, float]) -> list[tuple[int, float]]:
        """Return how often each node of a group is visited with an amount spent, in the mean over all runs."""
        inside = {node: place for place, node in enumerate(group)}
        edges = [
            (inside[other], inside[node], weight)
            for node in group
            for other, weight in self.free[node]
            if other in inside
        ]
        if not edges or self.chain.endless[group[0]]:
            return [(node, masses[node]) for node in group if node in masses]
        visits = solution(edges, [masses.get(node, 0.0) for node in group], len(group))
        return [(node, max(0.0, visit)) for node, visit in zip(group, visits, strict=True)]


def outcomes_of(law: CostLaw) -> list[tuple[float, Fraction]]:
    """Return the outcomes of a law that has some: pairs of a probability and an exact cost.

    Raises:
        UnsupportedError: it has none.
    """
    total = law.total if isinstance(law, CostSum) else law
    if isinstance(total, CostDistribution) and type(total) is CostDistribution:
        return [(probability, fraction_of(cost)) for probability, cost in total.outcomes]
    raise UnsupportedError(
        f"total costs, amount by amount, need lists of outcomes, and one of the costs is none: {law}; the expected "
        "cost, certainty equivalents and simulations do without"
    )
