"""The model checker Storm and the exact judge say the same of models that are written for Storm."""

from __future__ import annotations

import math
from fractions import Fraction

import pytest
from hypothesis import given

from statehtn.model import CostDistribution
from statehtn.policies.prism import Edge, MarkovModel, prism_text
from tests.explicit_graph import ExplicitGraph
from tests.explicit_memory import INFINITE, SLACK, best_policy_with_memory, step_of
from tests.explicit_policies import best_policy
from tests.random_graphs import decision_graphs
from tests.shares import share_of_examples

pytest.importorskip("stormpy", reason="Storm is not installed (pip install 'statehtn[check]')")
from tests.storm import StormModel

MOST_UNITS = 12
LEVELS = ("0.3", "0.75", "0.9")


def markov_model(graph: ExplicitGraph, failure_cost: float | None = None) -> MarkovModel:
    laws = {cost: CostDistribution.certain(float(cost)) for cost in graph.costs}
    choices = [
        [[Edge(branch.probability, laws[branch.cost], branch.successor) for branch in decision] for decision in node]
        for node in graph.decisions
    ]
    return MarkovModel(choices, graph.done, failure_cost)


def must_agree(graph: ExplicitGraph, model: StormModel, unit: Fraction) -> None:
    """Require that Storm says of a model of a graph what the judge says of the graph."""
    success = best_policy(graph, "success").value
    assert model.success_probability == success
    mean = best_policy(graph, "neutral").value
    assert model.expected_cost * unit == (math.inf if mean is None else mean)
    for units in range(MOST_UNITS):
        late = best_policy_with_memory(graph, f"deadline {float(units * unit)}", INFINITE).value
        assert model.within(units) == 1 - late
    for level in map(Fraction, LEVELS):
        if success > level:  # else Storm would look for ever
            answer = best_policy_with_memory(graph, f"quantile {float(level)}", INFINITE)
            assert model.quantile(level - SLACK) * unit == answer.value


@share_of_examples(2)
@given(graph=decision_graphs().filter(lambda graph: any(graph.costs)))
def test_random_graphs(graph: ExplicitGraph) -> None:
    must_agree(graph, StormModel(prism_text(markov_model(graph), "a random graph")), unit_of(graph))


def unit_of(graph: ExplicitGraph) -> Fraction:
    """The unit of the costs in the model's text."""
    return Fraction(1, math.lcm(*(cost.denominator for cost in graph.costs), 1))


@share_of_examples(2)
@given(graph=decision_graphs().filter(lambda graph: any(graph.costs)))
def test_giving_up_is_an_action(graph: ExplicitGraph) -> None:
    """With a price of giving up there is a way to an end from everywhere."""
    failure = Fraction(5, 2)
    lines = list(prism_text(markov_model(graph, float(failure)), "a random graph"))
    model = StormModel(lines)
    unit = Fraction(1, math.lcm(unit_of(graph).denominator, failure.denominator))
    cost = model.value('R{"cost"}min=? [F ("done" | "failed")]')
    assert cost * unit == best_policy(graph, "neutral", failure).value
    assert step_of(graph, failure) >= unit
