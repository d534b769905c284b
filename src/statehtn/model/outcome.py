"""What an action does by chance: blocks of outcomes, of which one comes, with its facts and its costs.

Blocks of one action are independent. All that is chosen happens at once: facts are deleted first, then added. Source:
Definition 4.4 of the paper, an operator with several effects; the syntax is that of PPDDL (Younes and Littman,
*PPDDL1.0*, 2004).
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from fractions import Fraction
from functools import cached_property

from statehtn.errors import Place
from statehtn.model.cost.blocks import PROBABILITY_TOLERANCE, Arithmetic, CostBlock, Expression, Number
from statehtn.model.cost.expressions import sum_of_constants
from statehtn.model.effect import Effect
from statehtn.model.formula import TRUE, And, Formula
from statehtn.model.types import Parameter


@dataclass(frozen=True, slots=True)
class Outcome:
    """One of the outcomes of a block.

    Args:
        probability: a number, or an expression of the parameters.
        effects: what becomes true and false then, each perhaps under a condition of its own and for all objects.
        costs: what it costs then, on top of the action's other costs: independent parts that add up.
    """

    probability: Expression
    effects: tuple[Effect, ...] = ()
    costs: tuple[CostBlock, ...] = ()


@dataclass(frozen=True)
class OutcomeBlock:
    """Outcomes of an action of which exactly one comes, in the states where the block's condition holds.

    Args:
        outcomes: as stated; with the rest of probability 1 nothing happens.
        condition: a `when` around the block; constant true where there is none.
        parameters: variables of a `forall` around the block: for each binding under which the condition holds, an
            outcome is chosen independently.
        place: where the block stands in a file, for errors that only show in a ground action.
    """

    outcomes: tuple[Outcome, ...]
    condition: Formula = TRUE
    parameters: tuple[Parameter, ...] = ()
    place: Place | None = field(default=None, compare=False, repr=False)

    @cached_property
    def branches(self) -> tuple[Outcome, ...]:
        """The outcomes, and last that nothing happens, unless the probabilities are known to sum to 1."""
        total = sum_of_constants(outcome.probability for outcome in self.outcomes)
        if total is not None and total >= 1 - PROBABILITY_TOLERANCE:
            return self.outcomes
        rest = Arithmetic("-", (Number(Fraction(1)), *(outcome.probability for outcome in self.outcomes)))
        return (*self.outcomes, Outcome(rest))

    def effects_of(self, outcome: Outcome) -> tuple[Effect, ...]:
        """Return effects of an outcome as those of the action, under the condition and for the variables around."""
        return tuple(
            replace(
                effect,
                condition=_both(self.condition, effect.condition),
                parameters=(*self.parameters, *effect.parameters),
            )
            for effect in outcome.effects
        )

    def costs_of(self, outcome: Outcome) -> tuple[CostBlock, ...]:
        """Return costs of an outcome as those of the action, under the condition and for the variables around."""
        return tuple(
            replace(
                block,
                condition=_both(self.condition, block.condition),
                parameters=(*self.parameters, *block.parameters),
            )
            for block in outcome.costs
        )


def _both(outer: Formula, inner: Formula) -> Formula:
    return inner if outer == TRUE else outer if inner == TRUE else And((outer, inner))
