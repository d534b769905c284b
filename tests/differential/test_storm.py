"""The model checker Storm, the exact judge and the planner say the same of models that are written for Storm."""

from __future__ import annotations

import math
from collections.abc import Iterable
from fractions import Fraction
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from statehtn import Problem, read_hddl
from statehtn.effort import Meter
from statehtn.limits import LimitReached, Limits
from statehtn.model import CostDistribution
from statehtn.policies.prism import Edge, MarkovModel, prism_text
from statehtn.policies.reachable import reachable_model
from statehtn.policies.run import find_policy
from statehtn.policies.settings import PolicySettings
from statehtn.session import Session
from tests.brute_force import GaveUp
from tests.explicit_graph import ExplicitGraph, explicit_graph
from tests.explicit_memory import INFINITE, SLACK, best_policy_with_memory, step_of
from tests.explicit_policies import best_policy
from tests.random_graphs import decision_graphs
from tests.random_outcomes import chance_problems, wide_problems
from tests.shares import is_long_run, share_of_examples

pytest.importorskip("stormpy", reason="Storm is not installed (pip install 'statehtn[check]')")
from tests.storm import StormModel

MOST_UNITS = 24 if is_long_run() else 12
EVERY = 1 if is_long_run() else 5
"""Each so many units a budget is tried; in long runs every one."""
LIMITS = Limits(steps=500_000)
PRECISION = 1e-9
CLOSE = {"rel": 1e-6, "abs": 1e-7}
EQUAL = {"rel": 1e-13, "abs": 1e-15}
DOMAINS = Path(__file__).parents[2] / "domains"
EXPORTED = sorted(
    f"{folder}/{path.stem}"
    for folder in ("exploring-rover", "gripper-robot", "trials")
    for path in (DOMAINS / folder).glob("*.hddl")
    if path.stem != "domain" and (folder, path.stem) not in {("exploring-rover", "p2"), ("gripper-robot", "p4")}
)
"""Problems of the domains; two are left out, of which Storm builds the models for a long time."""
LEVELS = ("0.3", "0.75", "0.9")


def markov_model(graph: ExplicitGraph, failure_cost: float | None = None) -> MarkovModel:
    laws = {cost: CostDistribution.certain(float(cost)) for cost in graph.costs}
    choices = [
        [[Edge(branch.probability, laws[branch.cost], branch.successor) for branch in decision] for decision in node]
        for node in graph.decisions
    ]
    return MarkovModel(choices, graph.done, failure_cost)


def must_agree(graph: ExplicitGraph, model: StormModel, unit: Fraction) -> None:
    """Require that Storm says of a model of a graph what the judge says of the graph.

    Both compute with fractions; probabilities in a model of a ground problem are rounded, as all of its are.
    """
    success = best_policy(graph, "success").value
    assert float(model.success_probability) == pytest.approx(float(success), **EQUAL)
    mean = best_policy(graph, "neutral").value
    assert float(model.expected_cost * unit) == pytest.approx(math.inf if mean is None else float(mean), **EQUAL)
    for units in range(0 if EVERY == 1 else 1, MOST_UNITS, EVERY):
        late = best_policy_with_memory(graph, f"deadline {float(units * unit)}", INFINITE).value
        assert float(model.within(units)) == pytest.approx(float(1 - late), **EQUAL)
    for level in map(Fraction, LEVELS):
        if success > level + SLACK:  # else Storm might look for ever
            answer = best_policy_with_memory(graph, f"quantile {float(level)}", INFINITE)
            assert model.quantile(level - SLACK) * unit == answer.value


@share_of_examples(2)
@given(graph=decision_graphs())
def test_random_graphs(graph: ExplicitGraph) -> None:
    must_agree(graph, StormModel(prism_text(markov_model(graph), "a random graph")), unit_of(graph))


@share_of_examples(3)
@given(problem=st.one_of(chance_problems(), chance_problems(), wide_problems()))
def test_exported_random_problems(problem: Problem) -> None:
    """Storm, the judge and the planner agree; the model is made of the planner's own decisions."""
    graph = explicit_graph(problem)
    model, unit = exported(problem)
    must_agree(graph, model, unit)
    must_agree_with_planner(problem, model, unit, range(0, MOST_UNITS, min(EVERY, 3)))


@pytest.mark.parametrize("name", EXPORTED)
def test_exported_problems_of_the_domains(name: str) -> None:
    problem = read_hddl(DOMAINS / name.split("/")[0] / "domain.hddl", DOMAINS / f"{name}.hddl")
    model, unit = exported(problem, exact=False)
    must_agree_with_planner(problem, model, unit, range(0, 60, 12))


def exported(problem: Problem, exact: bool = True) -> tuple[StormModel, Fraction]:
    """The model that `statehtn export --prism` writes, and the unit of its costs."""
    grounding = Session(problem).ground_for_policies(LIMITS, Meter())
    try:
        lines = list(prism_text(reachable_model(grounding, None, LIMITS), "a problem"))
    except LimitReached:
        raise GaveUp from None
    (unit,) = (line.split()[6] for line in lines if line.startswith("// costs are in units of"))
    return StormModel(lines, exact), Fraction(unit)


def must_agree_with_planner(problem: Problem, model: StormModel, unit: Fraction, units: Iterable[int]) -> None:
    """Require that Storm says of a model what the planner says of the problem."""
    session = Session(problem)

    def value(text: str, failure_cost: float | None = None) -> float:
        settings = PolicySettings.of(text, failure_cost=failure_cost, precision=PRECISION)
        result = find_policy(session, settings, LIMITS)
        if result.stopped is not None:
            raise GaveUp
        return math.inf if result.value is None else result.value

    success = value("success")
    assert success == pytest.approx(float(model.success_probability), **CLOSE)
    assert value("neutral") == pytest.approx(float(model.expected_cost * unit), **CLOSE)
    for count in units:
        late = value(f"deadline {float(count * unit)}", math.inf)
        assert late == pytest.approx(1 - float(model.within(count)), **CLOSE)
    for level in LEVELS:
        if success > float(level) + CLOSE["abs"]:
            found = float(model.quantile(Fraction(level) - SLACK) * unit)
            assert value(f"quantile {level}", math.inf) == pytest.approx(found, **CLOSE)


def unit_of(graph: ExplicitGraph) -> Fraction:
    """The unit of the costs in the model's text."""
    return Fraction(1, math.lcm(*(cost.denominator for cost in graph.costs), 1))


@share_of_examples(2)
@given(graph=decision_graphs())
def test_giving_up_is_an_action(graph: ExplicitGraph) -> None:
    """With a price of giving up there is a way to an end from everywhere."""
    failure = Fraction(5, 2)
    lines = list(prism_text(markov_model(graph, float(failure)), "a random graph"))
    model = StormModel(lines)
    unit = Fraction(1, math.lcm(unit_of(graph).denominator, failure.denominator))
    cost = model.value('R{"cost"}min=? [F ("done" | "failed")]')
    assert cost * unit == best_policy(graph, "neutral", failure).value
    assert step_of(graph, failure) >= unit
