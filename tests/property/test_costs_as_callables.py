"""Costs as callables, and as tables of their answers, are the costs that they say."""

from __future__ import annotations

from dataclasses import replace
from functools import partial

from hypothesis import given

import statehtn
from statehtn.build import ExternalFunction
from statehtn.core.grounding import ground
from statehtn.model import Action, CostBlock, CostDistribution, CostLaw, Problem
from statehtn.model.cost.ground_cost import block_law
from tests.strategies import problems


def with_callables(problem: Problem, calls: list[tuple[str, ...]]) -> Problem:
    """The problem with callables that say what the blocks said; blocks for all objects of a kind stay as they are."""

    def answer(action: Action, block: CostBlock, index: int, *arguments: str) -> CostLaw:
        calls.append((action.name, str(index), *arguments))
        return block_law(block, action, arguments, (), problem.function_values)

    def external(action: Action, index: int, block: CostBlock) -> CostBlock:
        if block.parameters:
            return block
        function = ExternalFunction(action.name, partial(answer, action, block, index))
        return replace(block, branches=(), external=function)

    actions = {
        action.name: replace(
            action, costs=tuple(external(action, index, block) for index, block in enumerate(action.costs))
        )
        for action in problem.domain.actions.values()
    }
    return replace(problem, domain=replace(problem.domain, actions=actions))


def laws(problem: Problem) -> list[tuple[tuple[str, ...], list[tuple[float, float]]]]:
    """The name and the cost of every ground action; floats to the digits that rounding leaves."""
    model = ground(problem).to_model()
    return sorted(((action.name, *action.arguments), rounded(action.cost)) for action in model.actions)


def rounded(law: CostLaw) -> list[tuple[float, float]]:
    assert isinstance(law, CostDistribution)
    return [(round(p, 12), round(cost, 9)) for p, cost in law.outcomes]


@given(problems())
def test_callables_and_tables_cost_what_expressions_cost(problem: Problem) -> None:
    calls: list[tuple[str, ...]] = []
    changed = with_callables(problem, calls)
    expected = laws(problem)
    assert laws(changed) == expected
    tables = statehtn.tabulate_costs(changed)
    assert laws(tables) == expected
    assert len(calls) == len(set(calls))  # once for each block of each ground action
    assert not any(block.external for action in tables.domain.actions.values() for block in action.costs)
