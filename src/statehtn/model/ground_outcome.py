"""How likely the outcomes of a ground action are: exact numbers, once parameters and function values are known."""

from __future__ import annotations

from fractions import Fraction

from statehtn.errors import InputError
from statehtn.expected import shown_number
from statehtn.model.cost.blocks import FunctionValues, Number
from statehtn.model.cost.expressions import evaluate
from statehtn.model.cost.probabilities import completed
from statehtn.model.outcome import OutcomeBlock
from statehtn.model.problem import Action


def branch_probabilities(
    block: OutcomeBlock, action: Action, arguments: tuple[str, ...], objects: tuple[str, ...], values: FunctionValues
) -> tuple[Fraction, ...]:
    """Return the probability of each of a block's branches, exactly; they sum to 1.

    Args:
        block: one of `action.outcomes`.
        action: the lifted action.
        arguments: one object for each parameter of the action.
        objects: one object for each of the block's own parameters.
        values: the function values of `:init`.

    Raises:
        InputError: a function value is missing, a probability is negative, or they sum to more than 1. The messages
            name the ground action.
    """
    bindings = {parameter.name: name for parameter, name in zip(action.parameters, arguments, strict=True)}
    bindings.update((parameter.name, name) for parameter, name in zip(block.parameters, objects, strict=True))
    name = f"({' '.join((action.name, *arguments))})"
    stated: list[Fraction] = []
    for outcome in block.outcomes:
        try:
            stated.append(evaluate(outcome.probability, bindings, values))
        except InputError as error:
            raise InputError(f"the outcomes of {name}: {error.message}", block.place) from None
    if any(probability < 0 for probability in stated):
        least = shown_number(min(stated))
        raise InputError(f"the outcomes of {name}: a probability must not be negative, found {least}", block.place)
    is_computed = not all(isinstance(outcome.probability, Number) for outcome in block.outcomes)
    what = "outcomes", "with the rest nothing happens"
    shares, rest = completed(stated, what, (name, action.name), block.place, is_computed)
    return (*shares, rest) if len(block.branches) > len(shares) else shares
