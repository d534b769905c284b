"""The policy search on random decision graphs, against all policies in fractions."""

from __future__ import annotations

import math
from fractions import Fraction

import pytest
from hypothesis import given
from hypothesis import strategies as st

import statehtn._relax as _relax
from tests.policies_in_fractions import RECURSIONS, Agent, Graph, best, core_nodes, evaluate
from tests.strategies import between, pick

AGENTS = [
    Agent("neutral"),
    Agent("success"),
    Agent("line"),
    *(
        Agent(kind, base)
        for kind in ("averse", "seeking", "rising", "falling")
        for base in (Fraction(9, 8), Fraction(5, 2))
    ),
]
LAWS = [(Fraction(1),), (Fraction(1, 2),) * 2, (Fraction(1, 5), Fraction(4, 5)), (Fraction(1, 3),) * 3]


@st.composite
def graphs(draw: st.DrawFn) -> Graph:
    """Graphs of up to five nodes, with loops that cost nothing, dead ends and several ways to be done."""
    size = between(draw, 1, 5)
    done = tuple(draw(st.booleans()) if node else False for node in range(size))
    decisions = []
    for node in range(size):
        choices = []
        for _ in range(0 if done[node] else between(draw, 0, 2 if size > 3 else 3)):
            law = pick(draw, LAWS)
            choices.append(tuple((between(draw, 0, size - 1), p, pick(draw, [0, 0, 1, 3])) for p in law))
        decisions.append(tuple(choices))
    return Graph(done, tuple(decisions))


@pytest.mark.parametrize("agent", AGENTS, ids=lambda agent: f"{agent.kind} {agent.base}")
@given(graphs(), st.sampled_from([None, 0, 2, 9]), st.data())
def test_best_policy(agent: Agent, graph: Graph, stop: int | None, data: st.DataObject) -> None:
    if agent.kind == "success":
        stop = 1
    exact = best(graph, agent, stop)
    worths = [agent.worth(value) for value in exact]
    shares = data.draw(st.lists(st.sampled_from([0.0, 0.5, 1.0]), min_size=len(worths), max_size=len(worths)))
    done = agent.worth(agent.carried(0))
    lower = [done + share * (worth - done) if share else done for share, worth in zip(shares, worths, strict=True)]
    options = _relax.PolicySearchOptions()
    options.recursion = RECURSIONS[agent.kind]
    options.precision = 0.0
    result, policy = _relax.solve_decision_graph(core_nodes(graph, agent, stop, lower), 0, options)
    assert result.stop is None
    statistics = result.statistics
    if exact[0] is None:
        assert statistics.lower == math.inf
        assert not policy
        return
    assert statistics.lower == pytest.approx(worths[0], rel=1e-11, abs=1e-11)
    assert statistics.upper == pytest.approx(worths[0], rel=1e-11, abs=1e-11)
    chosen: list[int | None] = [None] * len(graph.done)
    for node, choice in policy:
        chosen[node] = choice
    assert agent.worth(evaluate(graph, chosen, agent, stop)[0]) == pytest.approx(worths[0], rel=1e-11, abs=1e-11)


def test_loops_that_refer_to_each_other() -> None:
    """A node with two ways that lead back to it for nothing is a dead end, though each way counts on the other."""
    certain = Fraction(1)
    loop = Graph((False,) * 3, ((((1, certain, 0),), ((2, certain, 0),)), (((0, certain, 0),),), (((0, certain, 0),),)))
    options = _relax.PolicySearchOptions()
    result, policy = _relax.solve_decision_graph(core_nodes(loop, Agent("neutral"), None, [0.0] * 3), 0, options)
    assert result.statistics.lower == math.inf
    assert not policy
