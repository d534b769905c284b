"""Costs that are Python callables, turned into tables of numbers."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from fractions import Fraction

from statehtn.core.grounding import Grounding, ground
from statehtn.errors import UnsupportedError
from statehtn.model import Action, CostBlock, CostDistribution, Expression, FunctionTerm, Number, Problem, Signature
from statehtn.model.cost.blocks import exact
from statehtn.model.cost.ground_cost import block_law
from statehtn.model.expect import expect_problem

Arguments = tuple[str, ...]


def tabulate_costs(problem: Problem) -> Problem:
    """Return an equivalent problem whose costs are numbers instead of Python callables.

    Every callable is asked for the instances of its action that can be reached, and its answers become values of new
    functions, one for each cost and each probability; the problem can then be written by `write_hddl`. All plans cost
    what they did before (probabilities to the rounding of their last digit). Other costs stay as they are.

    Raises:
        InputError: a callable fails, or its answer is no cost.
        UnsupportedError: the problem asks for something that the planner does not do, or an answer is no list of
            outcomes.
    """
    expect_problem(problem)
    if not any(block.external for action in problem.domain.actions.values() for block in action.costs):
        return problem
    reached = _reached(ground(problem))
    functions = dict(problem.domain.functions)
    values = dict(problem.function_values)
    actions = {}
    for name, action in problem.domain.actions.items():
        blocks = []
        for index, block in enumerate(action.costs):
            if block.external is not None:
                laws = {arguments: _law(block, action, arguments, problem) for arguments in reached.get(name, ())}
                block = replace(block, external=None, branches=_tabulated(action, index, laws, functions, values))
            blocks.append(block)
        actions[name] = replace(action, costs=tuple(blocks))
    domain = replace(problem.domain, functions=functions, actions=actions)
    return replace(problem, domain=domain, function_values=values)


def _reached(grounding: Grounding) -> dict[str, dict[Arguments, None]]:
    """For every action the arguments of its instances."""
    found: dict[str, dict[Arguments, None]] = {}
    for number, schema in enumerate(grounding.handle.action_schema):
        action = grounding.encoding.actions[schema]
        if action is not None:
            found.setdefault(action.name, {})[grounding.objects(grounding.handle.action_arguments(number))] = None
    return found


def _law(block: CostBlock, action: Action, arguments: Arguments, problem: Problem) -> CostDistribution:
    law = block_law(block, action, arguments, (), problem.function_values)
    if isinstance(law, CostDistribution):
        return law
    raise UnsupportedError(
        f"the external cost of ({' '.join((action.name, *arguments))}) is {law}, which is no list of outcomes; let the "
        f"callable return law.discretised(20), say"
    )


def _tabulated(
    action: Action,
    index: int,
    laws: dict[Arguments, CostDistribution],
    functions: dict[str, Signature],
    values: dict[tuple[str, ...], Fraction],
) -> tuple[tuple[Expression, Expression], ...]:
    """Add functions with the outcomes of one block as their values; return the branches that read them.

    An instance with fewer outcomes than others has some of probability 0.
    """
    count = max((len(law.outcomes) for law in laws.values()), default=0)
    terms = tuple(parameter.name for parameter in action.parameters)

    def table(what: str, entries: Iterator[Fraction]) -> FunctionTerm:
        name = f"{action.name}-{what}"
        while name in functions:
            name += "+"
        functions[name] = Signature(name, action.parameters)
        values.update(zip(((name, *arguments) for arguments in laws), entries, strict=True))
        return FunctionTerm(name, terms)

    branches: list[tuple[Expression, Expression]] = []
    for branch in range(count):
        outcomes = [law.outcomes[branch] if branch < len(law.outcomes) else (0.0, 0.0) for law in laws.values()]
        suffix = f"{index}-{branch}"
        cost = table(f"cost-{suffix}", (exact(cost) for _, cost in outcomes))
        probability: Expression = Number(Fraction(1))
        if count > 1:
            probability = table(f"probability-{suffix}", (exact(probability) for probability, _ in outcomes))
        branches.append((probability, cost))
    return tuple(branches) or ((Number(Fraction(1)), Number(Fraction(0))),)
