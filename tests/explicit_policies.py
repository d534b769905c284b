"""The best policy on an explicit graph, in exact arithmetic: the judge of the planner's policies.

Here are the objectives to which the amount spent so far does not matter; `explicit_memory` has the others. Means and
probabilities are fractions, exponentials decimals of 60 digits. Costs are minimised.

Only policies that are done with probability 1 count, unless giving up has a price. That is said by pairs: giving up
costs (1, 0), anything else (0, cost), and the first part comes first. So the first part is the least probability of
giving up (for averse agents its exponential mean, which is infinite where no policy without it has a finite value).
"""

from __future__ import annotations

import decimal
from collections.abc import Callable
from dataclasses import dataclass
from decimal import Decimal
from fractions import Fraction

from tests.exact import CONTEXT, decimal_of
from tests.exact_policy_iteration import Choice, Exact, Pair, best
from tests.explicit_graph import ExplicitGraph

ZERO, ONE = Fraction(0), Fraction(1)


@dataclass(frozen=True)
class Answer:
    """What the best policy is worth.

    Args:
        value: of the objective; None where no policy counts.
        expected_cost: of objective `success`.
    """

    value: Fraction | None
    expected_cost: Fraction | None = None


@dataclass(frozen=True)
class Recursion:
    """How the value of a decision comes from the values of what it leads to.

    Args:
        done: the value where nothing is left to do.
        given_up: where the agent gives up, with what that costs.
        weights: of a branch of this probability and cost, for both parts of the value there.
        added: to the value by a branch.
    """

    done: Pair
    given_up: Pair
    weights: Callable[[Fraction, Fraction], Pair]
    added: Callable[[Fraction, Fraction], Pair]


def values_of(graph: ExplicitGraph, recursion: Recursion) -> tuple[list[Pair], list[list[Choice]], list[int]]:
    """The best value of every node, what could be chosen there, and what is chosen."""
    choices = []
    for node, decisions in enumerate(graph.decisions):
        end = recursion.done if graph.done[node] else recursion.given_up
        stops = [Choice(end)] if graph.can_stop(node) else []
        several = ([(b.probability, b.cost, b.successor) for b in decision] for decision in decisions)
        choices.append(stops + [choice_of(branches, recursion) for branches in several])
    values, policy = best(choices)
    return values, choices, policy


def choice_of(branches: list[tuple[Fraction, Fraction, int]], recursion: Recursion) -> Choice:
    added = [recursion.added(probability, cost) for probability, cost, _ in branches]
    first = sum((one for one, _ in added), type(recursion.done[0])(0))
    second = sum((two for _, two in added), type(recursion.done[1])(0))
    weights = tuple((successor, *recursion.weights(p, cost)) for p, cost, successor in branches)
    return Choice((first, second), weights)


def neutral(failure_cost: Fraction | None) -> Recursion:
    """The expected cost."""
    given_up = (ONE, ZERO) if failure_cost is None else (ZERO, failure_cost)
    return Recursion((ZERO, ZERO), given_up, lambda p, _: (p, p), lambda p, cost: (ZERO, p * cost))


def averse(alpha: Fraction, failure_cost: Fraction | None) -> Recursion:
    """The mean of `e^(alpha C)`."""
    nothing = (Decimal(0), Decimal(0))
    given_up = (Decimal(1), Decimal(0)) if failure_cost is None else (Decimal(0), power(alpha * failure_cost))

    def weights(p: Fraction, cost: Fraction) -> Pair:
        weight = power(alpha * cost, p)
        return weight, weight

    return Recursion((Decimal(0), Decimal(1)), given_up, weights, lambda _p, _cost: nothing)


def seeking(alpha: Fraction, failure_cost: Fraction | None) -> Recursion:
    """Minus the mean of `e^(-alpha C)`. The first part is a probability: being done with probability 1 comes first."""
    given_up = (ONE, Decimal(0)) if failure_cost is None else (ZERO, -power(-alpha * failure_cost))
    return Recursion(
        (ZERO, Decimal(-1)),
        given_up,
        lambda p, cost: (p, power(-alpha * cost, p)),
        lambda _p, _cost: (ZERO, Decimal(0)),
    )


def power(exponent: Fraction, factor: Fraction = ONE) -> Decimal:
    """`factor * e^exponent`."""
    with decimal.localcontext(CONTEXT):
        return decimal_of(factor) * decimal_of(exponent).exp()


def best_policy(graph: ExplicitGraph, text: str, failure_cost: Fraction | None = None) -> Answer:
    """The value of the best policy for an objective in the planner's form: neutral, averse A, seeking A or success."""
    name, *words = text.split()
    with decimal.localcontext(CONTEXT):
        if name == "success":
            # The agent stops where being done has become impossible: giving up costs nothing more there.
            (failed, cost), *_ = values_of(graph, neutral(None))[0]
            return Answer(1 - fraction(failed), fraction(cost))
        if name == "neutral":
            (bad, value), *_ = values_of(graph, neutral(failure_cost))[0]
            return Answer(None if bad else fraction(value))
        alpha = Fraction(words[0])
        sign, recursion = (1, averse) if name == "averse" else (-1, seeking)
        (bad, value), *_ = values_of(graph, recursion(alpha, failure_cost))[0]
        if bad:
            return Answer(None)
        return Answer(Fraction((sign * value).ln() / (sign * decimal_of(alpha))))  # type: ignore[union-attr, operator]


def fraction(number: Exact) -> Fraction:
    return Fraction(number)
