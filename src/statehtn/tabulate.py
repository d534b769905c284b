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
    if not any(block.external for action in problem.domain.actions.values() for block in action.all_costs):
        return problem
    tables = _Tables(problem, _reached(ground(problem)))
    actions = {name: tables.action(action) for name, action in problem.domain.actions.items()}
    domain = replace(problem.domain, functions=tables.functions, actions=actions)
    return replace(problem, domain=domain, function_values=tables.values)


class _Tables:
    """Functions in the place of callables, and their values.

    Args:
        problem: the problem with callables.
        reached: for every action the arguments of its instances.
    """

    def __init__(self, problem: Problem, reached: dict[str, dict[Arguments, None]]) -> None:
        self.functions = dict(problem.domain.functions)
        self.values = dict(problem.function_values)
        self._problem = problem
        self._reached = reached

    def action(self, action: Action) -> Action:
        """Return an action whose costs, and those of its outcomes, read functions."""
        index = 0

        def tabulated(blocks: tuple[CostBlock, ...]) -> tuple[CostBlock, ...]:
            nonlocal index
            found = []
            for block in blocks:
                found.append(self._block(block, action, index))
                index += 1
            return tuple(found)

        costs = tabulated(action.costs)
        blocks = []
        for block in action.outcomes:
            outcomes = tuple(replace(outcome, costs=tabulated(outcome.costs)) for outcome in block.outcomes)
            blocks.append(replace(block, outcomes=outcomes))
        return replace(action, costs=costs, outcomes=tuple(blocks))

    def _block(self, block: CostBlock, action: Action, index: int) -> CostBlock:
        if block.external is None:
            return block
        instances = self._reached.get(action.name, ())
        laws = {arguments: _law(block, action, arguments, self._problem) for arguments in instances}
        return replace(block, external=None, branches=_tabulated(action, index, laws, self.functions, self.values))


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
