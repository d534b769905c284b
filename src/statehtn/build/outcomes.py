"""Outcomes of actions from Python objects: what one of them changes and costs, and how likely it is."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from typing import Any

from statehtn.build.declarations import Declarations, Scope
from statehtn.build.parts import (
    CostPart,
    EffectPart,
    Quantified,
    When,
    costs_of,
    effects_of,
    expression_of,
    joined,
    listed,
)
from statehtn.errors import UsageError
from statehtn.expected import shown_number
from statehtn.model import TRUE, And, Expression, Formula, OutcomeBlock, Parameter
from statehtn.model.cost.blocks import PROBABILITY_TOLERANCE, Amount, Computable
from statehtn.model.cost.expressions import sum_of_constants
from statehtn.model.outcome import Outcome as ModelOutcome


@dataclass(frozen=True, slots=True)
class Outcome:
    """One of the outcomes of an action: what becomes true and false and what it costs then, on top of the rest.

    Args:
        probability: a number or an expression of functions; those of all outcomes of a block sum to 1.
        effects: as in `ProblemBuilder.action`; none where nothing changes.
        cost: likewise; independent parts that add up.

    Raises:
        UsageError: the probability is none.
    """

    probability: Computable | Amount
    effects: EffectPart | Iterable[EffectPart] = ()
    cost: CostPart | Iterable[CostPart] = ()
    expression: Expression = field(init=False, repr=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "expression", expression_of(self.probability, "a probability"))


OutcomePart = Outcome | Sequence[Outcome] | When | Quantified
"""Outcomes that stand side by side are a block, of which one comes; lists of them, and what is under `when` and
`forall`, are blocks of their own, independent of each other."""


def outcomes_of(
    parts: OutcomePart | Iterable[OutcomePart],
    action: str,
    parameters: tuple[Parameter, ...],
    scope: Scope,
    declared: Declarations,
) -> tuple[OutcomeBlock, ...]:
    """Return the blocks of outcomes that the parts of an action stand for.

    Raises:
        UsageError: a part is no outcome, a name in it is wrong, constant probabilities do not sum to 1, or no outcome
            of a block changes a fact.
    """

    def block(found: list[Outcome], condition: Formula, bound: tuple[Parameter, ...], inner: Scope) -> OutcomeBlock:
        outcomes = []
        for outcome in found:
            declared.check_expression(outcome.expression, inner)
            effects = effects_of(outcome.effects, inner, declared)
            outcomes.append(
                ModelOutcome(outcome.expression, effects, costs_of(outcome.cost, action, parameters, inner, declared))
            )
        if not any(outcome.effects for outcome in outcomes):
            raise UsageError(
                f"no outcome of action '{action}' changes a fact; state an uncertain cost by cost=chance(...)"
            )
        _check_sum(outcomes, action)
        return OutcomeBlock(tuple(outcomes), condition, bound)

    def blocks(
        given: Sequence[Any], condition: Formula, bound: tuple[Parameter, ...], inner: Scope
    ) -> Iterator[OutcomeBlock]:
        side_by_side = [part for part in given if isinstance(part, Outcome)]
        if side_by_side:
            yield block(side_by_side, condition, bound, inner)
        for part in given:
            match part:
                case Outcome():
                    pass
                case When(formula, nested):
                    declared.check_formula(formula, inner)
                    both = formula if condition == TRUE else And((condition, formula))
                    yield from blocks(nested, both, bound, inner)
                case Quantified(variables, nested):
                    yield from blocks(nested, condition, (*bound, *variables), joined(inner, variables, declared))
                case list() | tuple():
                    yield from blocks(part, condition, bound, inner)
                case _:
                    raise UsageError(f"an outcome is Outcome(probability, effects, cost), found {part!r}")

    return tuple(blocks(listed(parts), TRUE, (), scope))


def _check_sum(outcomes: Sequence[ModelOutcome], action: str) -> None:
    total = sum_of_constants(outcome.probability for outcome in outcomes)
    if total is not None and abs(total - 1) > PROBABILITY_TOLERANCE:
        write = f"; Outcome({shown_number(1 - total)}) is one in which nothing happens" if total < 1 else ""
        raise UsageError(
            f"the probabilities of the outcomes of action '{action}' must sum to 1, found {shown_number(total)}{write}"
        )
