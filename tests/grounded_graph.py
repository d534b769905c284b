"""The graph of what an agent can decide, as the core's progression for policies makes it, for the judges of tests."""

from __future__ import annotations

from fractions import Fraction

import statehtn._relax as _relax
from statehtn.core.grounding import Grounding
from statehtn.model import CostDistribution, CostLaw
from statehtn.model.cost.sum import total_cost
from tests.brute_force import GaveUp
from tests.explicit_graph import Branch, ExplicitGraph

MOST_NODES = 2000
FINE = 10**7  # denominators of probabilities and costs in tests are much smaller


def exact(number: float | Fraction) -> Fraction:
    return Fraction(number).limit_denominator(FINE)


def is_uncertain(law: CostLaw) -> bool:
    return law.least != law.most


def space_of(grounding: Grounding, sees_costs: bool, **switches: bool) -> _relax.PolicySpace:
    """Every node that the progression leads to."""
    handle = grounding.handle
    free = [
        law.most == 0 and all(grounding.part_laws[part].most == 0 for part in range(*handle.cost_parts(action)))
        for action, law in enumerate(grounding.laws)
    ]
    seen = ([*map(is_uncertain, grounding.laws)], [*map(is_uncertain, grounding.part_laws)]) if sees_costs else ([], [])
    return _relax.PolicySpace(handle, free, *seen, **switches, most_nodes=MOST_NODES)


def grounded_graph(grounding: Grounding, sees_costs: bool, **switches: bool) -> ExplicitGraph:
    """The graph of a ground problem; costs that an outcome may have are branches of their own.

    Raises:
        GaveUp: it is large.
    """
    graph = ExplicitGraph()
    if not grounding.handle.solvable:
        graph.add("unsolvable")
        return graph
    space = space_of(grounding, sees_costs, **switches)
    if space.stop or space.expanded_count < space.node_count:
        raise GaveUp
    chances = [exact(probability) for probability in grounding.probabilities]
    for node in range(space.node_count):
        graph.add(f"{space.facts(node)} {space.tasks(node)}", not space.tasks(node))
    for node in range(space.node_count):
        for _, _, outcomes in space.decisions(node):
            decision: dict[tuple[Fraction, int], Fraction] = {}
            for successor, action, due in outcomes:
                chance, law = Fraction(1), CostDistribution.certain(0.0)
                if action is not None:
                    chance = chances[action]
                    law = total_of(grounding, action, due)
                for probability, cost in law.outcomes:
                    key = (exact(cost), successor)
                    decision[key] = decision.get(key, Fraction(0)) + chance * exact(probability)
            assert sum(decision.values()) == 1
            graph.decisions[node].append(tuple(Branch(p, cost, to) for (cost, to), p in decision.items() if p))
    return graph


def total_of(grounding: Grounding, action: int, due: list[int]) -> CostDistribution:
    """The law of an action's cost where these parts are due."""
    laws = [grounding.laws[action], *(grounding.part_laws[part] for part in due)]
    total = total_cost(laws)
    assert isinstance(total, CostDistribution)
    return total
