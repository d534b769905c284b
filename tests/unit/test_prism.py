"""Policies in the PRISM language: what is written, and that Storm reads the same values from it."""

from __future__ import annotations

import math
from pathlib import Path

import pytest

from statehtn.errors import UnsupportedError
from statehtn.model import CostDistribution, Step
from statehtn.model.policy_graph import Branch, Decision, End, PolicyGraph, PolicyNode
from statehtn.policies.chain import Chain
from statehtn.policies.prism import Edge, MarkovModel, chain_of, prism_text
from statehtn.policies.total_cost import PolicyCost
from tests.made_policies import certain, ferry_or_bridge, retry, tries


def test_each_cost_has_a_state_of_its_own() -> None:
    assert list(prism_text(chain_of(retry().flat, None), "a cup"))[2:] == [
        "dtmc",
        "",
        "module run",
        "  s : [0..6] init 0;",
        "  [c0] s=0 -> 0.5:(s'=4) + 0.5:(s'=5);",
        "  [c0] s=1 -> (s'=6);",
        "  [pay] s=4 -> (s'=1);",
        "  [pay] s=5 -> (s'=0);",
        "  [pay] s=6 -> (s'=2);",
        "  [end] s=3 -> true;",
        "  [end] s=2 -> true;",
        "endmodule",
        "",
        'rewards "cost"',
        "  true : 0;",
        "  s=4 : 1;",
        "  s=5 : 1;",
        "  s=6 : 3;",
        "endrewards",
        "",
        'label "done" = s=2;',
        'label "failed" = s=3;',
    ]


def test_costs_are_whole_numbers_of_units() -> None:
    edges = [Edge(1.0, CostDistribution.of([(0.5, 0.25), (0.5, 1.5)]), 1)]
    lines = list(prism_text(MarkovModel([[edges], []], [False, True]), "quarters"))
    assert lines[1] == "// costs are in units of 1/4 of the domain's unit"
    assert [line for line in lines if line.startswith("  s=")] == ["  s=3 : 1;", "  s=4 : 6;"]


def test_giving_up_is_an_action_of_an_mdp() -> None:
    """It is there in every state that is not done, and pays the failure cost."""
    model = MarkovModel([[[Edge(1.0, certain(0), 1)]], [], []], [False, True, False], failure=5)
    lines = list(prism_text(model, "giving up"))
    assert "  [give_up] s=0 -> (s'=4);" in lines
    assert "  [give_up] s=2 -> (s'=4);" in lines
    assert not any(line.startswith("  [give_up] s=1") for line in lines)
    assert "  s=4 : 5;" in lines
    assert "mdp" in lines


def test_costs_without_a_unit_are_refused() -> None:
    edges = [Edge(1.0, CostDistribution.of([(0.5, 1e-9), (0.5, 1e9)]), 1)]
    with pytest.raises(UnsupportedError, match="whole numbers"):
        list(prism_text(MarkovModel([[edges], []], [False, True]), "far apart"))


def bridge_of_chance() -> PolicyGraph:
    """A third of the runs fails, at costs that differ."""
    go = Step("go")
    law = CostDistribution.of([(0.4, 1), (0.6, 2.5)])
    branches = (Branch(1 / 3, law, 1), Branch(2 / 3, certain(1), 2))
    return PolicyGraph.of(
        [
            PolicyNode(frozenset(), (go,), (), Decision(0, go, branches)),
            PolicyNode(frozenset(), (go,), (), None, End.FAILED),
            PolicyNode(frozenset(), (), (), None, End.DONE),
        ]
    )


@pytest.mark.parametrize(
    ("graph", "failure"), [(retry(), None), (tries(3), 10.0), (ferry_or_bridge(), None), (bridge_of_chance(), 3.5)]
)
def test_storm_agrees(graph: PolicyGraph, failure: float | None, tmp_path: Path) -> None:
    stormpy = pytest.importorskip("stormpy", reason="Storm is not installed (extra 'check')")
    file = tmp_path / "policy.prism"
    lines = list(prism_text(chain_of(graph.flat, failure), "a policy"))
    file.write_text("\n".join(lines) + "\n", encoding="utf-8")
    unit = 2 if "1/2" in lines[1] else 1
    program = stormpy.parse_prism_program(str(file))

    def value(formula: str) -> float:
        (wanted,) = stormpy.parse_properties(formula, program)
        model = stormpy.build_model(program, [wanted])
        found = stormpy.model_checking(model, wanted, only_initial_states=True)
        return float(found.get_value(model.initial_states[0]))

    chain = Chain(graph.flat)
    law = PolicyCost(chain, failure or 0.0)
    assert value('P=? [F "done"]') == pytest.approx(chain.success_probability(), abs=1e-6)
    assert value('R{"cost"}=? [F "done" | "failed"]') / unit == pytest.approx(law.mean, rel=1e-5)
    late = PolicyCost(chain, math.inf)
    for budget in range(12):
        in_time = value(f'P=? [F{{"cost"}}<={budget * unit} "done"]')
        assert in_time == pytest.approx(late.cdf(budget), abs=1e-6)
