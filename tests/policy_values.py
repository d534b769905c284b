"""What a policy that was found is worth, worked out from its decisions alone, in exact arithmetic."""

from __future__ import annotations

from fractions import Fraction

from statehtn.model import CostDistribution, CostLaw
from statehtn.model.cost.sum import CostSum
from statehtn.model.policy_graph import End, FlatPolicy
from tests.explicit_evar import best_policy_by_evar
from tests.explicit_exponentials import best_policy_for_exponentials
from tests.explicit_graph import Branch, ExplicitGraph
from tests.explicit_memory import BY_NAME, INFINITE, FailureCost, best_policy_with_memory
from tests.explicit_policies import Answer, best_policy
from tests.naive_semantics import Law, add


def best_answer(graph: ExplicitGraph, text: str, failure_cost: FailureCost = None) -> Answer:
    """The best value of a graph by any objective in the planner's form; of a policy's graph its own."""
    name = text.split()[0]
    if name in BY_NAME:
        return best_policy_with_memory(graph, text, failure_cost)
    assert failure_cost != INFINITE
    assert not isinstance(failure_cost, str)
    if name == "evar":
        return best_policy_by_evar(graph, text, failure_cost)
    if name in ("one-switch", "exponentials"):
        return best_policy_for_exponentials(graph, text, failure_cost)
    return best_policy(graph, text, failure_cost)


def graph_of_policy(policy: FlatPolicy) -> ExplicitGraph:
    """The graph in which nothing is left to decide; numbers are what their digits say."""
    graph = ExplicitGraph(is_policy=True)
    for node, end in enumerate(policy.ends):
        graph.add(str(node), end is End.DONE)
    for node in range(len(policy)):
        branches: dict[tuple[Fraction, int], Fraction] = {}
        for index in policy.branches(node):
            for cost, probability in law_of(policy.laws[index]).items():
                key = (cost, policy.successors[index])
                share = digits(policy.probabilities[index]) * probability
                branches[key] = branches.get(key, Fraction(0)) + share
        if branches:
            graph.decisions[node].append(tuple(Branch(p, cost, to) for (cost, to), p in branches.items()))
    return graph


def law_of(given: CostLaw) -> Law:
    """The probability of each cost."""
    if isinstance(given, CostSum):
        law = {Fraction(0): Fraction(1)}
        for part in given.parts:
            law = add(law, law_of(part))
        return law
    assert isinstance(given, CostDistribution), given
    return {digits(cost): digits(probability) for probability, cost in given.outcomes}


def digits(number: float) -> Fraction:
    return Fraction(repr(float(number))).limit_denominator(10**9)
