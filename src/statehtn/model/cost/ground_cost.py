"""The cost law of a ground action: what its cost blocks mean once parameters, state and function values are known.

Everything is computed with exact fractions and turned into floating point once, at the end. Costs are positive, in the
domain's unit.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from fractions import Fraction
from typing import TYPE_CHECKING

from statehtn.errors import InputError, StateHtnError
from statehtn.expected import shown_number
from statehtn.model.cost.blocks import CostBlock, FunctionValues, Number
from statehtn.model.cost.distribution import CostDistribution
from statehtn.model.cost.expressions import evaluate
from statehtn.model.cost.law import CostLaw, is_of_scipy
from statehtn.model.cost.probabilities import completed
from statehtn.model.cost.scenario_cost import by_scenario
from statehtn.model.cost.sum import CostSum
from statehtn.model.formula import TRUE, Fact
from statehtn.model.fraction import fraction_of

if TYPE_CHECKING:
    from statehtn.model.problem import Action, Problem

UNIT_COST = CostDistribution.certain(1.0)
"""What every action costs where the domain states no costs at all."""
LARGEST_COST = 1e290
"""Of an action, in the domain's unit: a plan of a billion billion steps still has a finite cost."""

MOST_OUTCOMES = 256
MOST_PAIRS = 1024
"""An action whose parts together have more outcomes, or more combinations, has a sum of laws as its law."""

Blocks = Iterable[tuple[int, tuple[str, ...]]]
"""Some cost blocks of a ground action: (index in `Action.all_costs`, objects of the block's variables)."""

ExactLaw = dict[Fraction, Fraction]
"""A cost distribution in exact numbers: the probability of every cost; the probabilities sum to exactly 1."""
FREE: ExactLaw = {Fraction(0): Fraction(1)}
FREE_BRANCH = Fraction(1), Fraction(0)


def block_law(
    block: CostBlock,
    action: Action,
    arguments: tuple[str, ...],
    objects: tuple[str, ...],
    values: FunctionValues,
    hidden: frozenset[Fact] = frozenset(),
) -> CostLaw:
    """Return the law of one cost block of a ground action, in a state where its condition holds.

    Args:
        block: one of `action.all_costs`.
        action: the lifted action.
        arguments: one object for each parameter of the action; an external cost is called with them.
        objects: one object for each of the block's own parameters.
        values: the function values of `:init`.
        hidden: the hidden facts that hold.

    Raises:
        MissingNumber: a function value is missing.
        InputError: a cost or probability is negative, or the probabilities sum to more than 1. The messages name the
            ground action.
    """
    part = _block(block, action, arguments, objects, values, hidden)
    return part if isinstance(part, CostLaw) else _rounded(part, action, arguments)


def action_law(
    action: Action,
    arguments: tuple[str, ...],
    active_parts: Sequence[Blocks],
    problem: Problem,
) -> CostLaw:
    """Return the law of a ground action's whole cost: the sum of its independent parts, in each scenario.

    Args:
        action: the lifted action.
        arguments: one object for each parameter.
        active_parts: the conditional parts that are due in each scenario, once where there are none. Blocks without
            condition and parameters are always due and not listed.
        problem: the problem; where its domain states no costs at all, every action costs 1.

    Raises:
        InputError: as `block_law`.
    """
    if problem.domain.has_unit_costs:
        return UNIT_COST
    always = [(index, ()) for index, block in enumerate(action.costs) if is_unconditional(block)]
    return sum_of_blocks(action, arguments, [(*always, *parts) for parts in active_parts], problem)


def sum_of_blocks(
    action: Action,
    arguments: tuple[str, ...],
    blocks: Sequence[Blocks],
    problem: Problem,
) -> CostLaw:
    """Return the law of the sum of some of a ground action's cost blocks, which are independent in each scenario.

    Args:
        action: the lifted action.
        arguments: one object for each parameter.
        blocks: which, for each scenario of the problem, once where it has none.
        problem: has the scenarios, and the function values of `:init`.

    Raises:
        InputError: as `block_law`.
    """
    if not problem.scenarios:
        (only,) = blocks
        return sum_in_scenario(action, arguments, only, problem.function_values)
    known: dict[object, CostLaw] = {}
    laws: list[CostLaw] = []
    for scenario, given in zip(problem.scenarios, blocks, strict=True):
        due = tuple(given)
        decided = [index for index, _ in due if action.all_costs[index].cases]
        key = due, tuple(action.all_costs[index].case(scenario.facts) for index in decided)
        if key not in known:
            known[key] = sum_in_scenario(action, arguments, due, problem.function_values, scenario.facts)
        laws.append(known[key])
    return by_scenario(problem.scenarios, laws)


def sum_in_scenario(
    action: Action,
    arguments: tuple[str, ...],
    blocks: Blocks,
    values: FunctionValues,
    hidden: frozenset[Fact] = frozenset(),
) -> CostLaw:
    """Return the law of the sum of some of a ground action's independent cost blocks where these hidden facts hold.

    Args:
        action: the lifted action.
        arguments: one object for each parameter.
        blocks: which.
        values: the function values of `:init`.
        hidden: the hidden facts that hold.

    Raises:
        InputError: as `block_law`.
    """
    blocks = list(blocks)
    exact: list[ExactLaw] = []
    others: list[CostLaw] = []
    for index, objects in blocks:
        part = _block(action.all_costs[index], action, arguments, objects, values, hidden)
        if isinstance(part, CostLaw):
            others.append(part)
        else:
            exact.append(part)
    parts = others + [_rounded(law, action, arguments) for law in _merged(exact) if law != FREE or not others]
    law = CostSum(tuple(parts)) if len(parts) > 1 else parts[0]
    largest = max((part.most for part in parts if math.isfinite(part.most)), default=0.0)
    if max(largest, max(part.mean for part in parts)) > LARGEST_COST:
        raise InputError(
            f"the cost of {_name(action, arguments)} can be {max(largest, law.mean):g}, and numbers above "
            f"{LARGEST_COST:g} become too large when the costs of a plan are added up; state costs in a larger unit",
            next((place for index, _ in blocks if (place := action.all_costs[index].place) is not None), None),
        )
    return law


def _merged(laws: list[ExactLaw]) -> list[ExactLaw]:
    """Return laws with the same sum: one with all outcomes of it where these are few, else the given ones.

    Independent parts need not be multiplied out: their prices add up.
    """
    total = FREE
    for law in laws:
        if len(total) * len(law) > MOST_PAIRS:
            break
        total = _convolution(total, law)
        if len(total) > MOST_OUTCOMES:
            break
    else:
        return [total]
    certain = sum((min(law) for law in laws if len(law) == 1), Fraction(0))
    return [*([{certain: Fraction(1)}] if certain else []), *(law for law in laws if len(law) > 1)]


def is_unconditional(block: CostBlock) -> bool:
    """Tell whether a block is due exactly once in every state."""
    return block.condition == TRUE and not block.parameters


def _block(
    block: CostBlock,
    action: Action,
    arguments: tuple[str, ...],
    objects: tuple[str, ...],
    values: FunctionValues,
    hidden: frozenset[Fact],
) -> ExactLaw | CostLaw:
    """Return one block's cost: exact outcomes, or the law where it is no list of outcomes."""
    if block.cases:
        return block.case(hidden)
    if block.law is not None:
        return block.law
    if block.external is not None:
        return _external_law(block.external(*arguments), action, arguments)
    bindings = {parameter.name: name for parameter, name in zip(action.parameters, arguments, strict=True)}
    bindings.update((parameter.name, name) for parameter, name in zip(block.parameters, objects, strict=True))
    stated: list[tuple[Fraction, Fraction]] = []
    for probability_expression, cost_expression in block.branches:
        try:
            probability = evaluate(probability_expression, bindings, values)
            cost = evaluate(cost_expression, bindings, values) if probability else Fraction(0)
            _check("a probability", probability)
            _check("a cost", cost)
        except InputError as error:
            raise type(error)(f"the cost of {_name(action, arguments)}: {error.message}", block.place) from None
        stated.append((probability, cost))
    is_computed = not all(isinstance(probability, Number) for probability, _ in block.branches)
    what, names = ("cost", "the rest costs 0"), (_name(action, arguments), action.name)
    shares, rest = completed([probability for probability, _ in stated], what, names, block.place, is_computed)
    law: ExactLaw = {}
    for share, (_, cost) in zip((*shares, rest), (*stated, FREE_BRANCH), strict=True):
        if share:
            law[cost] = law.get(cost, Fraction(0)) + share
    return law


def _external_law(answer: object, action: Action, arguments: tuple[str, ...]) -> ExactLaw | CostLaw:
    """Read what a callable returned. A float stands for a fraction, so that equal costs stay equal."""
    if is_of_scipy(answer):
        try:
            answer = CostDistribution.from_scipy(answer)
        except StateHtnError as error:
            raise type(error)(f"the external cost of {_name(action, arguments)}: {error.message}") from None
    if isinstance(answer, CostLaw) and not (
        isinstance(answer, CostDistribution) and len(answer.outcomes) <= MOST_OUTCOMES
    ):
        return answer
    outcomes = answer.outcomes if isinstance(answer, CostDistribution) else ((1.0, answer),)
    law: ExactLaw = {}
    for probability, cost in outcomes:
        if isinstance(cost, CostDistribution | str) or not hasattr(cost, "__float__"):
            raise InputError(
                f"the external cost of {_name(action, arguments)} must be a number or CostDistribution, found {cost!r}"
            )
        number = float(cost)
        if not math.isfinite(number):
            raise InputError(f"the external cost of {_name(action, arguments)} must be finite, found {number}")
        exact = fraction_of(number)
        try:
            _check("a cost", exact)
        except InputError as error:
            raise InputError(f"the external cost of {_name(action, arguments)}: {error.message}") from None
        law[exact] = law.get(exact, Fraction(0)) + fraction_of(probability)
    total = sum(law.values(), Fraction(0))
    return law if total == 1 else {cost: probability / total for cost, probability in law.items()}


def _convolution(left: ExactLaw, right: ExactLaw) -> ExactLaw:
    law: ExactLaw = {}
    for cost, probability in left.items():
        for other_cost, other_probability in right.items():
            total = cost + other_cost
            law[total] = law.get(total, Fraction(0)) + probability * other_probability
    return law


def _rounded(law: ExactLaw, action: Action, arguments: tuple[str, ...]) -> CostDistribution:
    try:
        outcomes = [(float(probability), float(cost)) for cost, probability in law.items()]
    except OverflowError:
        raise InputError(f"the cost of {_name(action, arguments)} is too large for a floating-point number") from None
    return CostDistribution.of(outcomes)


def _check(what: str, value: Fraction) -> None:
    if value < 0:
        raise InputError(f"{what} must not be negative, found {shown_number(value)}")


def _name(action: Action, arguments: tuple[str, ...]) -> str:
    return f"({' '.join((action.name, *arguments))})"
