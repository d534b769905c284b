"""The best policy of agents to whom it matters what they have spent, in exact arithmetic: the judge of the planner's.

The amount is carried along: for every amount that is left until the utility is linear, from the least on, there is a
value for every node. Beyond, the agent is neutral (or does not care what it spends), but for sums of exponentials: they
are linear nowhere, and what comes after a large amount has been spent is taken between two bounds.
"""

from __future__ import annotations

import decimal
import itertools
import math
from collections.abc import Callable
from fractions import Fraction

from tests.brute_force import GaveUp
from tests.exact_policy_iteration import Choice, Pair, best, circles_of
from tests.explicit_graph import ExplicitGraph
from tests.explicit_policies import ONE, ZERO, Answer, neutral, values_of

INFINITE = "inf"
FailureCost = Fraction | str | None
"""What giving up costs; None where only policies that are done with probability 1 count; INFINITE is too much for any
budget."""
MOST_LAYERS = 400
SLACK = Fraction(1, 10**12)  # probabilities that have to reach a level may be so much below it

Payoff = Callable[[Fraction], Fraction]


class Layers:
    """The least expected payoff of what is left in the end, for every node and every amount that is left there.

    Args:
        graph: of the problem.
        payoff: of what is left in the end, negative where too much was spent: linear there.
        slope: by how much the payoff of one unit less left is larger there.
        running: a price of every unit spent, beside the payoff.
        failure_cost: what giving up costs.
        failed: the payoff of giving up where that costs INFINITE.
        offset: amounts left are this plus multiples of the step of all costs.
    """

    def __init__(
        self,
        graph: ExplicitGraph,
        payoff: Payoff,
        slope: Fraction,
        running: Fraction = ZERO,
        failure_cost: FailureCost = None,
        failed: Fraction = ONE,
        offset: Fraction = ZERO,
    ) -> None:
        self.graph = graph
        self.payoff = payoff
        self.slope = slope
        self.running = running
        self.failure_cost = failure_cost
        self.failed = failed
        self.step = step_of(graph, failure_cost)
        self.offset = offset % self.step
        self.layers: list[list[Pair]] = []
        self.circles: list[list[int]] | None = None  # of steps that cost nothing: the same for all amounts
        if failure_cost == INFINITE:  # all that is too late or has failed is worth the same
            assert not slope
            self.beyond: list[Pair] = [(ZERO, ZERO)] * len(graph.done)
        else:
            assert not isinstance(failure_cost, str)
            self.beyond, *_ = values_of(graph, neutral(failure_cost))

    def value(self, left: Fraction, node: int = 0) -> Pair:
        """The value of a node with so much left: the least probability of giving up (where it must not), the payoff."""
        if left < 0:
            bad, cost = self.beyond[node]
            return bad, self.payoff(left) + (self.slope + self.running) * Fraction(cost)
        number = (left - self.offset) / self.step
        assert number.denominator == 1, (left, self.offset, self.step)
        while len(self.layers) <= number:
            if len(self.layers) > MOST_LAYERS:
                raise GaveUp
            self.layers.append(self.next_layer())
        return self.layers[int(number)][node]

    def next_layer(self) -> list[Pair]:
        left = self.offset + len(self.layers) * self.step
        choices = []
        for number, decisions in enumerate(self.graph.decisions):
            node = []
            if self.graph.can_stop(number):
                node.append(Choice((ZERO, self.payoff(left)) if self.graph.done[number] else self.given_up(left)))
            for decision in decisions:
                first = second = ZERO
                weights = []
                for branch in decision:
                    second += branch.probability * self.running * branch.cost
                    if branch.cost:
                        bad, value = self.value(left - branch.cost, branch.successor)
                        first += branch.probability * Fraction(bad)
                        second += branch.probability * Fraction(value)
                    else:
                        weights.append((branch.successor, branch.probability, branch.probability))
                node.append(Choice((first, second), tuple(weights)))
            choices.append(node)
        self.circles = self.circles or circles_of(choices)
        return best(choices, self.circles)[0]

    def given_up(self, left: Fraction) -> Pair:
        if self.failure_cost is None:
            return ONE, ZERO
        if isinstance(self.failure_cost, str):
            return ZERO, self.failed
        return ZERO, self.payoff(left - self.failure_cost) + self.running * self.failure_cost


def step_of(graph: ExplicitGraph, failure_cost: FailureCost = None) -> Fraction:
    """The largest number of which all costs are multiples, that of failure, too."""
    costs = graph.costs | ({failure_cost} if isinstance(failure_cost, Fraction) else set())
    whole = math.lcm(*(cost.denominator for cost in costs), 1)
    return Fraction(math.gcd(*(int(cost * whole) for cost in costs)) or 1, whole)


def answer(pair: Pair) -> Answer:
    bad, value = pair
    return Answer(None if bad else Fraction(value))


def late(left: Fraction) -> Fraction:
    return ZERO if left >= 0 else ONE


def overspent(left: Fraction) -> Fraction:
    return max(-left, ZERO)


def deadline(graph: ExplicitGraph, failure_cost: FailureCost, budget: Fraction) -> Answer:
    """The least probability of spending more."""
    if budget < 0:
        raise GaveUp
    layers = Layers(graph, late, ZERO, failure_cost=failure_cost, offset=budget)
    return answer(layers.value(budget))


def overrun(graph: ExplicitGraph, failure_cost: FailureCost, budget: Fraction) -> Answer:
    """The least expected amount by which the budget is overspent."""
    layers = Layers(graph, overspent, ONE, failure_cost=failure_cost, offset=budget)
    return answer(layers.value(budget))


def piecewise(graph: ExplicitGraph, failure_cost: FailureCost, *pairs: tuple[Fraction, Fraction]) -> Answer:
    """The least of minus the expected utility, through these points (cost, utility), straight beyond them."""
    last = pairs[-1][0]

    def payoff(left: Fraction) -> Fraction:
        cost = last - left
        number = next((i for i in range(1, len(pairs)) if cost <= pairs[i][0]), len(pairs) - 1)
        (c0, u0), (c1, u1) = pairs[number - 1], pairs[number]
        return -(u0 + (u1 - u0) * (cost - c0) / (c1 - c0))

    slope = payoff(Fraction(-1)) - payoff(ZERO)
    layers = Layers(graph, payoff, slope, failure_cost=failure_cost, offset=last)
    return answer(layers.value(last))


def quantile(graph: ExplicitGraph, failure_cost: FailureCost, level: Fraction) -> Answer:
    """The least budget that some policy keeps with this probability."""
    if failure_cost is None and values_of(graph, neutral(None))[0][0][0]:
        return Answer(None)
    layers = Layers(graph, late, ZERO, failure_cost=failure_cost)
    grid = (number * layers.step for number in itertools.count())
    if failure_cost == INFINITE:
        (failed, _), *_ = values_of(graph, neutral(None))[0]
        if 1 - failed < level - SLACK:
            return Answer(None)
    return Answer(next(budget for budget in grid if 1 - layers.value(budget)[1] >= level - SLACK))  # type: ignore[operator]


def mean_cvar(graph: ExplicitGraph, failure_cost: FailureCost, level: Fraction, weight: Fraction) -> Answer:
    """`(1 - weight)` of the mean and `weight` of the mean of the worst `1 - level`.

    That is the least over t of `(1 - weight) E C + weight (t + E max(C - t, 0) / (1 - level))`, and for the best policy
    the least is at a cost that it may have; t alone is a bound on what follows.
    """
    slope = weight / (1 - level)
    layers = Layers(graph, lambda left: slope * overspent(left), slope, 1 - weight, failure_cost)
    bad, least = layers.value(ZERO)
    if bad:
        return Answer(None)
    least = Fraction(least)
    running, *_ = values_of(graph, neutral(failure_cost))[0]  # type: ignore[arg-type]
    for number in itertools.count(1):
        t = number * layers.step
        if weight * t + (1 - weight) * Fraction(running[1]) >= least:
            return Answer(least)
        least = min(least, weight * t + Fraction(layers.value(t)[1]))
    raise AssertionError


def cvar(graph: ExplicitGraph, failure_cost: FailureCost, level: Fraction) -> Answer:
    return mean_cvar(graph, failure_cost, level, ONE)


def most_cost(graph: ExplicitGraph) -> Fraction | None:
    """The largest total cost of a run, by relaxation; None where a loop costs something."""
    most = [ZERO] * len(graph.done)
    for _ in range(len(graph.done) + 1):
        before = list(most)
        for node, decisions in enumerate(graph.decisions):
            most[node] = max([b.cost + most[b.successor] for decision in decisions for b in decision], default=ZERO)
        if most == before:
            return most[0]
    return None


def bounded(graph: ExplicitGraph, failure_cost: Fraction | None, disutility: Payoff) -> Answer | None:
    """The least expected disutility of the total cost; None where there is no largest total cost."""
    most = most_cost(graph)
    if most is None:
        return None
    most += failure_cost or 0
    layers = Layers(graph, lambda left: disutility(most - left), ZERO, failure_cost=failure_cost, offset=most)
    return answer(layers.value(most))


BY_NAME: dict[str, Callable[..., Answer]] = {
    "deadline": deadline,
    "overrun": overrun,
    "piecewise": piecewise,
    "quantile": quantile,
    "cvar": cvar,
    "mean-cvar": mean_cvar,
}


def best_policy_with_memory(graph: ExplicitGraph, text: str, failure_cost: FailureCost = None) -> Answer:
    """The value of the best policy for an objective in the planner's form, of those that look at the amount spent."""
    name, *words = text.split()
    numbers: list[object] = [tuple(map(Fraction, word.split(":"))) if ":" in word else Fraction(word) for word in words]
    with decimal.localcontext() as context:
        context.prec = 60
        return BY_NAME[name](graph, failure_cost, *numbers)
