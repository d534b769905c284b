"""The best policy of one-switch agents and for other sums of exponentials: the judge of the planner's policies.

The amount spent is carried along up to a cut. Beyond it the disutility lies between that of the ideal point, where each
exponential (and the mean) is as small as any policy makes it, and that of the policy that makes the term smallest which
outweighs all others in the end. The cut moves until both give the same.
"""

from __future__ import annotations

import decimal
from collections.abc import Sequence
from dataclasses import dataclass
from decimal import Decimal
from fractions import Fraction

from tests.brute_force import GaveUp
from tests.exact import CONTEXT, decimal_of
from tests.exact_policy_iteration import Choice, Pair, best, circles_of, evaluate
from tests.explicit_graph import ExplicitGraph
from tests.explicit_memory import MOST_LAYERS, step_of
from tests.explicit_policies import Answer, Recursion, averse, neutral, seeking, values_of

CLOSE = Decimal("1e-13")  # relatively: how close the two bounds on the certainty equivalent must come
NOTHING = Decimal(0)


@dataclass(frozen=True)
class Term:
    """One term of the disutility: linear where alpha is 0; minus the exponential where it is negative."""

    alpha: Fraction
    weight: Decimal

    def at(self, cost: Fraction) -> Decimal:
        """The disutility of a certain cost."""
        if not self.alpha:
            return self.weight * decimal_of(cost)
        size = self.weight * (decimal_of(self.alpha) * decimal_of(cost)).exp()
        return size if self.alpha > 0 else -size

    def after(self, spent: Fraction, value: Decimal) -> Decimal:
        """The expected disutility, where the recursion's value of what follows is this."""
        if not self.alpha:
            return self.weight * (decimal_of(spent) + value)
        return self.weight * (decimal_of(self.alpha) * decimal_of(spent)).exp() * value

    def recursion(self, failure_cost: Fraction | None) -> Recursion:
        if not self.alpha:
            return neutral(failure_cost)
        kind = averse if self.alpha > 0 else seeking
        return kind(abs(self.alpha), failure_cost)


def terms_of(text: str) -> list[Term]:
    """Read `one-switch alpha=A tradeoff=D wealth=W` or `exponentials linear=W0 A1:W1 ..`."""
    name, *words = text.split()
    named = {key: Fraction(number) for key, number in (word.split("=") for word in words if "=" in word)}
    if name == "one-switch":
        alpha = named["alpha"]
        weight = decimal_of(named["tradeoff"] / alpha) * (-decimal_of(alpha * named["wealth"])).exp()
        return [Term(Fraction(0), Decimal(1)), Term(alpha, weight)]
    terms = [Term(Fraction(0), decimal_of(named["linear"]))] if named.get("linear") else []
    pairs = (word.split(":") for word in words if ":" in word)
    return terms + [Term(Fraction(alpha), decimal_of(Fraction(weight))) for alpha, weight in pairs if Fraction(weight)]


def best_policy_for_exponentials(graph: ExplicitGraph, text: str, failure_cost: Fraction | None = None) -> Answer:
    """The certainty equivalent of the best policy.

    Raises:
        GaveUp: the bounds do not meet before the cut is too far.
    """
    with decimal.localcontext(CONTEXT):
        terms = terms_of(text)
        ends = Ends(graph, terms, failure_cost)
        if ends.is_bad:
            return Answer(None)
        cut = 8
        while cut <= MOST_LAYERS:
            low, high = (Cut(graph, terms, ends, failure_cost, cut, upper).root() for upper in (False, True))
            least, most = (certain(terms, value) for value in (low, high))
            if most - least <= CLOSE * max(1, abs(most)):
                return Answer(Fraction((least + most) / 2))
            cut *= 2
        raise GaveUp


class Ends:
    """What may follow after the cut: for each term the least value, and that of one policy for all."""

    def __init__(self, graph: ExplicitGraph, terms: Sequence[Term], failure_cost: Fraction | None) -> None:
        solved = [values_of(graph, term.recursion(failure_cost)) for term in terms]
        self.bad = [max(Fraction(values[node][0]) for values, *_ in solved) for node in range(len(graph.done))]
        self.is_bad = self.bad[0] > 0
        self.least = [
            [Decimal(second) if isinstance(second, Decimal) else decimal_of(second) for _, second in values]
            for values, *_ in solved
        ]
        heaviest = max(range(len(terms)), key=lambda number: terms[number].alpha)
        policy = solved[heaviest][2]
        self.fixed = []
        for _, choices, _ in solved:
            values: list[Pair | None] = [None] * len(graph.done)
            # Where the agent cannot but give up, another term's policy may be of spectral radius 1: nobody goes there.
            good = [node for node in range(len(graph.done)) if not self.bad[node]]
            for node in range(len(graph.done)):
                values[node] = choices[0][0].constant
            evaluate(choices, policy, values, good)
            self.fixed.append([Decimal(v[1]) if isinstance(v[1], Decimal) else decimal_of(v[1]) for v in values if v])


class Cut:
    """The least expected disutility, from every amount spent up to a number of steps; one of the bounds beyond."""

    def __init__(
        self,
        graph: ExplicitGraph,
        terms: Sequence[Term],
        ends: Ends,
        failure_cost: Fraction | None,
        layers: int,
        upper: bool,
    ) -> None:
        self.graph = graph
        self.terms = terms
        self.ends = ends
        self.after = ends.fixed if upper else ends.least
        self.failure_cost = failure_cost
        self.step = step_of(graph)
        self.layers: dict[int, list[Pair]] = {}
        self.circles: list[list[int]] | None = None  # of steps that cost nothing: the same for all amounts
        self.last = layers
        for number in reversed(range(layers)):
            self.layers[number] = self.layer(number)

    def root(self) -> Decimal:
        value = self.layers[0][0][1]
        assert isinstance(value, Decimal)
        return value

    def value(self, number: int, node: int) -> Pair:
        if number < self.last:
            return self.layers[number][node]
        spent = number * self.step
        total = sum((t.after(spent, v[node]) for t, v in zip(self.terms, self.after, strict=True)), NOTHING)
        return self.ends.bad[node], total

    def layer(self, number: int) -> list[Pair]:
        spent = number * self.step
        choices = []
        for at, decisions in enumerate(self.graph.decisions):
            node = [Choice(self.end(at, spent))] if self.graph.can_stop(at) else []
            for decision in decisions:
                first, second = Fraction(0), NOTHING
                weights = []
                for branch in decision:
                    p = decimal_of(branch.probability)
                    if branch.cost:
                        bad, value = self.value(number + int(branch.cost / self.step), branch.successor)
                        first += branch.probability * Fraction(bad)
                        second += p * Decimal(value)  # type: ignore[arg-type]
                    else:
                        weights.append((branch.successor, branch.probability, p))
                node.append(Choice((first, second), tuple(weights)))
            choices.append(node)
        self.circles = self.circles or circles_of(choices)
        return best(choices, self.circles)[0]

    def end(self, node: int, spent: Fraction) -> Pair:
        """The value of stopping."""
        if not self.graph.done[node]:
            if self.failure_cost is None:
                return Fraction(1), NOTHING
            spent += self.failure_cost
        return Fraction(0), sum((term.at(spent) for term in self.terms), NOTHING)


def certain(terms: Sequence[Term], disutility: Decimal) -> Decimal:
    """The certain cost of this disutility, which rises with it."""
    low, high = Decimal(-1), Decimal(1)
    while sum((term.at(Fraction(high)) for term in terms), NOTHING) < disutility:
        high *= 2
    for _ in range(120):
        middle = (low + high) / 2
        if sum((term.at(Fraction(middle)) for term in terms), NOTHING) < disutility:
            low = middle
        else:
            high = middle
    return high
