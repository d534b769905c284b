"""What heuristics promise (admissible, consistent, safe) holds on all nodes of the spaces of random small problems."""

from __future__ import annotations

import itertools
import math

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from statehtn.core.grounding import ground
from statehtn.core.heuristics import HEURISTICS, HeuristicEvaluator
from statehtn.model import GroundProblem, Problem
from statehtn.reference import RelaxedTask, compute_rc_ad_heur, hmax
from statehtn.risk import Utility
from statehtn.risk.cost_shifting import shifted_prices
from tests.brute_force import GaveUp
from tests.differential.oracles import ADMISSIBLE, close_to
from tests.remaining_cost import explore
from tests.shares import share_of_examples
from tests.strategies import problems, utilities

HALF = share_of_examples(2)  # for each heuristic
SLACK = 1e-9  # relative: fixed-point prices, sums of doubles
MOST_SUBSETS = 2**9
OTHERS = [name for name, info in HEURISTICS.items() if info.safe and not info.admissible]
CONSISTENT = [name for name, info in HEURISTICS.items() if info.consistent]


def estimate(value: float | None) -> float:
    """A heuristic's value with dead ends as infinity."""
    return math.inf if value is None else value


@pytest.mark.parametrize("heuristic", ADMISSIBLE)
@pytest.mark.parametrize("orders", [("total",), ("none", "partial")])
@HALF
@given(data=st.data(), utility=utilities())
def test_never_above_the_remaining_cost(
    heuristic: str, orders: tuple[str, ...], data: st.DataObject, utility: Utility
) -> None:
    grounding = ground(data.draw(problems(orders)))
    assume(grounding.to_model().methods)
    h = HeuristicEvaluator(grounding, utility, heuristic)
    for node in explore(grounding.to_model(), utility):
        for ordering in (node.ordering, None):
            assert estimate(h(node.state, node.tasks, ordering)) <= node.remaining_cost * (1 + SLACK)


@pytest.mark.parametrize("heuristic", OTHERS)
@given(problem=problems(), utility=utilities())
def test_dead_ends_are_dead_ends(heuristic: str, problem: Problem, utility: Utility) -> None:
    grounding = ground(problem)
    assume(grounding.to_model().methods)
    h = HeuristicEvaluator(grounding, utility, heuristic)
    for node in explore(grounding.to_model(), utility):
        assert h(node.state, node.tasks, node.ordering) is not None or node.remaining_cost == math.inf


@pytest.mark.parametrize("heuristic", CONSISTENT)
@HALF
@given(problem=problems(), utility=utilities())
def test_f_never_falls(heuristic: str, problem: Problem, utility: Utility) -> None:
    grounding = ground(problem)
    assume(grounding.to_model().methods)
    h = HeuristicEvaluator(grounding, utility, heuristic)
    for node in explore(grounding.to_model(), utility, most_nodes=60):
        for cost, successor in node.steps:
            bound = cost + estimate(h(successor.state, successor.tasks, successor.ordering))
            assert estimate(h(node.state, node.tasks, node.ordering)) <= bound * (1 + SLACK) + SLACK


@given(problem=problems(), utility=utilities())
def test_hmax_is_that_of_the_reference(problem: Problem, utility: Utility) -> None:
    grounding = ground(problem)
    model = grounding.to_model()
    assume(model.methods)
    h = HeuristicEvaluator(grounding, utility, "hmax")
    for node in explore(model, utility, most_nodes=40):
        expected = compute_rc_ad_heur(node.state, node.tasks, model, utility, hmax)
        assert estimate(h(node.state, node.tasks, node.ordering)) == close_to(expected)


@given(problem=problems(), utility=utilities())
def test_lmcut_lies_between_hmax_and_the_relaxed_optimum(problem: Problem, utility: Utility) -> None:
    grounding = ground(problem)
    model = grounding.to_model()
    assume(model.methods)
    h = HeuristicEvaluator(grounding, utility, "lmcut")
    for node in explore(model, utility, most_nodes=15):
        value = estimate(h(node.state, node.tasks, node.ordering))
        # hmax pays for each effect of an action that needs another one of it, a cut only once for the action.
        if all(len(action.effects) <= 1 for action in model.actions):
            assert value >= compute_rc_ad_heur(node.state, node.tasks, model, utility, hmax) * (1 - SLACK)
        assert value <= compute_rc_ad_heur(node.state, node.tasks, model, utility, relaxed_optimum) * (1 + SLACK)


def relaxed_optimum(task: RelaxedTask) -> float:
    """The least cost of actions and parts, each paid for once, that make the goals reachable; by trying all sets."""
    cost_of = {(operator.action, operator.part): operator.cost for operator in task.operators if operator.cost > 0}
    if 2 ** len(cost_of) > MOST_SUBSETS:
        raise GaveUp
    sets = itertools.chain.from_iterable(itertools.combinations(cost_of, size) for size in range(len(cost_of) + 1))
    best = math.inf
    for chosen in sorted(sets, key=lambda paid: sum(cost_of[one] for one in paid)):
        usable = [
            operator for operator in task.operators if operator.cost == 0 or (operator.action, operator.part) in chosen
        ]
        reached = set(task.initial_state)
        while new := {fact for o in usable if o.preconditions <= reached for fact in o.add_effects} - reached:
            reached |= new
        if task.goals <= reached:
            best = sum(cost_of[one] for one in chosen)
            break
    return best


@given(problem=problems(), utility=utilities())
def test_tdg_is_the_least_cost_of_a_decomposition(problem: Problem, utility: Utility) -> None:
    grounding = ground(problem)
    model = grounding.to_model()
    assume(model.methods)
    least = decomposition_costs(model, utility)
    h = HeuristicEvaluator(grounding, utility, "tdg")
    for node in explore(model, utility, most_nodes=40):
        assert estimate(h(node.state, node.tasks, node.ordering)) == close_to(sum(least[task] for task in node.tasks))


def decomposition_costs(problem: GroundProblem, utility: Utility) -> list[float]:
    """For every task the least cost of its decompositions, whatever the state: by repetition until nothing changes."""
    values = [shifted_prices(a.cost, a.cost_parts, utility)[0] for a in problem.actions]
    values += [math.inf] * len(problem.tasks)
    changed = True
    while changed:
        changed = False
        for method in problem.methods:
            value = sum(values[subtask] for subtask in method.subtasks)
            if value < values[method.task]:
                values[method.task] = value
                changed = True
    return values
