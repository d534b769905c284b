"""How likely the outcomes of a ground action are: exact numbers, once parameters and function values are known."""

from __future__ import annotations

import warnings
from fractions import Fraction

from statehtn.errors import InputError
from statehtn.model.cost.blocks import PROBABILITY_TOLERANCE, FunctionValues, Number
from statehtn.model.cost.expressions import evaluate
from statehtn.model.cost.ground_cost import LARGEST_SHOWN, CostWarning
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
        least = _shown(min(stated))
        raise InputError(f"the outcomes of {name}: a probability must not be negative, found {least}", block.place)
    total = sum(stated, Fraction(0))
    rest = (Fraction(0),) * (len(block.branches) - len(stated))
    if total == 1:
        return (*stated, *rest)
    if total > 1 + PROBABILITY_TOLERANCE:
        raise InputError(
            f"the probabilities of the outcomes of {name} sum to {_shown(total)}, more than 1; those of one block must "
            f"sum to 1",
            block.place,
        )
    if total >= 1 - PROBABILITY_TOLERANCE:  # what is off by rounding only is spread over all branches
        return (*(probability / total for probability in stated), *rest)
    if not all(isinstance(outcome.probability, Number) for outcome in block.outcomes):  # the reader saw the others
        # Names the lifted action only, so that Python shows it once and not for every ground action.
        warnings.warn(
            f"some probabilities of the outcomes of action '{action.name}' sum to less than 1; with the rest nothing "
            f"happens",
            CostWarning,
            stacklevel=2,
        )
    return (*stated, 1 - total)


def _shown(value: Fraction) -> str:
    return f"{float(value):.12g}" if abs(value) < LARGEST_SHOWN else "a very large number"
