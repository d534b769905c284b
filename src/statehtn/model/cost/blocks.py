"""Costs of lifted actions, as they are stated: by expressions, laws and Python callables.

Costs are positive and minimised, in the domain's own unit (hours, say). Numbers of the input are exact fractions.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from decimal import Decimal
from fractions import Fraction
from numbers import Rational, Real
from typing import cast

from statehtn.errors import Place, UsageError
from statehtn.model.cost.distribution import PROBABILITY_TOLERANCE as PROBABILITY_TOLERANCE
from statehtn.model.cost.distribution import CostDistribution as CostDistribution
from statehtn.model.cost.law import CostLaw
from statehtn.model.formula import TRUE, Atom, Fact, Formula
from statehtn.model.fraction import fraction_of
from statehtn.model.types import Parameter

Amount = float | Fraction | Decimal
"""A number as Python has it; numbers of numpy will do, too."""


def exact(number: Amount) -> Fraction:
    """Return a number as a fraction; what a float stands for is said at `fraction_of`.

    Raises:
        UsageError: it is not finite, or no number.
    """
    if not isinstance(number, Real | Decimal) or isinstance(number, bool):
        raise UsageError(f"expected a number, found {number!r}")
    try:
        return Fraction(number) if isinstance(number, Rational | Decimal) else fraction_of(float(number))
    except (ValueError, OverflowError):
        raise UsageError(f"expected a finite number, found {number}") from None


class Computable:
    """What all expressions can do: `e + f`, `e - f`, `e * f` and `-e`, where one side may be a number."""

    __slots__ = ()

    def __add__(self, other: Computable | Amount) -> Arithmetic:
        return _arithmetic("+", self, other)

    def __radd__(self, other: Amount) -> Arithmetic:
        return _arithmetic("+", other, self)

    def __sub__(self, other: Computable | Amount) -> Arithmetic:
        return _arithmetic("-", self, other)

    def __rsub__(self, other: Amount) -> Arithmetic:
        return _arithmetic("-", other, self)

    def __mul__(self, other: Computable | Amount) -> Arithmetic:
        return _arithmetic("*", self, other)

    def __rmul__(self, other: Amount) -> Arithmetic:
        return _arithmetic("*", other, self)

    def __neg__(self) -> Arithmetic:
        return Arithmetic("-", (cast("Expression", self),))


def _arithmetic(operator: str, *operands: object) -> Arithmetic:
    return Arithmetic(
        operator,
        tuple(
            cast("Expression", operand) if isinstance(operand, Computable) else Number(exact(cast("Amount", operand)))
            for operand in operands
        ),
    )


@dataclass(frozen=True, slots=True)
class Number(Computable):
    """A constant, exactly as written."""

    value: Fraction


@dataclass(frozen=True, slots=True)
class FunctionTerm(Computable):
    """A function of the parameters whose value stands in the problem's `:init`."""

    function: str
    arguments: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class Arithmetic(Computable):
    """A sum, difference or product of expressions; `operator` is one of `+ - *`.

    A difference of one operand negates it.
    """

    operator: str
    operands: tuple[Expression, ...]


Expression = Number | FunctionTerm | Arithmetic
ExternalCost = Callable[..., "float | CostLaw"]


NO_COST = CostDistribution.certain(0.0)


@dataclass(frozen=True, slots=True)
class CostBlock:
    """One independent part of an action's cost, due in the states where its condition holds.

    Args:
        branches: pairs (probability, cost); what is missing to probability 1 costs 0. An `increase` of its own is one
            branch of probability 1.
        condition: a `when` around the block; constant true where there is none.
        parameters: variables of a `forall` around the block: it is due once for each binding under which the condition
            holds.
        external: a Python callable that gives the cost instead of the branches; it gets the action's arguments (object
            names).
        place: where the block stands in a file, for errors that only show in a ground action; None where there is none.
        law: the cost where no short list of outcomes states it, instead of the branches.
        cases: the cost instead of the branches where it depends on which one of several hidden facts holds, at most one
            of them in each scenario; without any of them it is 0.
    """

    branches: tuple[tuple[Expression, Expression], ...]
    condition: Formula = TRUE
    parameters: tuple[Parameter, ...] = ()
    external: ExternalCost | None = None
    place: Place | None = field(default=None, compare=False, repr=False)
    law: CostLaw | None = None
    cases: Mapping[Fact, CostLaw] = field(default_factory=dict, hash=False)

    def case(self, hidden: frozenset[Fact]) -> CostLaw:
        """Return the law of the case whose fact is one of the hidden facts that hold."""
        return next((self.cases[fact] for fact in hidden if fact in self.cases), NO_COST)

    @property
    def by_conditions(self) -> tuple[CostBlock, ...]:
        """The block itself; in the place of cases a block for each of them, due where its fact holds."""
        if not self.cases:
            return (self,)
        return tuple(
            replace(self, cases={}, law=law, condition=self.condition & Atom(fact[0], fact[1:]))
            for fact, law in self.cases.items()
        )

    @property
    def listed(self) -> CostBlock:
        """The block with branches in the place of a law that is a list of outcomes."""
        if not isinstance(self.law, CostDistribution):
            return self
        return replace(self, branches=branches_of(self.law), law=None)


MOST_BRANCHES = 100
"""A law with more outcomes is kept as a law: nobody reads so many branches, and exact fractions take their time."""


def block_of(law: CostLaw) -> CostBlock:
    """Return a law as a cost that is always due: by its outcomes where it is a list of few of them."""
    if isinstance(law, CostDistribution) and len(law.outcomes) <= MOST_BRANCHES:
        return CostBlock(branches_of(law))
    return CostBlock((), law=law)


def branches_of(law: CostDistribution) -> tuple[tuple[Expression, Expression], ...]:
    """Return the outcomes of a law as exact branches."""
    return tuple((Number(exact(probability)), Number(exact(cost))) for probability, cost in law.outcomes)


FunctionValues = Mapping[tuple[str, ...], Fraction]
"""Values of functions in the initial state; the key is (function, *arguments)."""
