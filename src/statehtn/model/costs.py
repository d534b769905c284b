"""Costs of actions: distributions of ground actions, and the expressions that lifted actions state them by.

Costs are positive and minimised, in the domain's own unit (hours, say). Numbers of the input are exact fractions.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from decimal import Decimal
from fractions import Fraction
from numbers import Rational, Real
from typing import cast

from statehtn.errors import InputError, Place, UsageError
from statehtn.model.formula import TRUE, Formula
from statehtn.model.types import Parameter

PROBABILITY_TOLERANCE = 1e-9


@dataclass(frozen=True, slots=True)
class CostDistribution:
    """The probability distribution of an action's cost: pairs (probability, cost), sorted by cost.

    Probabilities are positive and sum to 1 within 1e-9; costs are finite, at least 0 and distinct.
    Make one by `CostDistribution.of` (which merges and checks) or `CostDistribution.certain`.
    Source: the `c(o)` of the paper's Definition 4.4 (cost-variable operator), with the sign turned.
    """

    outcomes: tuple[tuple[float, float], ...]

    @staticmethod
    def certain(cost: float) -> CostDistribution:
        """Return the distribution of a cost that is known."""
        return CostDistribution.of([(1.0, cost)])

    @staticmethod
    def of(outcomes: Iterable[tuple[float, float]]) -> CostDistribution:
        """Merge outcomes of equal cost, drop impossible ones, and check the rest.

        Raises:
            InputError: a probability is negative or not finite, a cost is negative or not finite,
                or the probabilities do not sum to 1.
        """
        merged: dict[float, float] = {}
        for probability, cost in outcomes:
            if not (math.isfinite(probability) and probability >= 0):
                raise InputError(f"a probability must be between 0 and 1, found {probability:g}")
            if not (math.isfinite(cost) and cost >= 0):
                raise InputError(f"a cost must be a finite number and at least 0, found {cost:g}")
            if probability > 0:
                merged[cost] = merged.get(cost, 0.0) + probability
        total = math.fsum(merged.values())
        if abs(total - 1) > PROBABILITY_TOLERANCE:
            raise InputError(f"the probabilities of a cost must sum to 1, found {total:.12g}")
        return CostDistribution(tuple((merged[cost], float(cost)) for cost in sorted(merged)))

    @property
    def mean(self) -> float:
        """The expected cost, in the domain's unit."""
        return math.fsum(probability * cost for probability, cost in self.outcomes)

    def convolve(self, other: CostDistribution) -> CostDistribution:
        """Return the distribution of the sum of two independent costs."""
        return CostDistribution.of((p * q, c + d) for p, c in self.outcomes for q, d in other.outcomes)

    def __str__(self) -> str:
        if len(self.outcomes) == 1:
            return f"{self.outcomes[0][1]:g}"
        return ", ".join(f"{cost:g} w.p. {probability:g}" for probability, cost in self.outcomes)


Amount = float | Fraction | Decimal
"""A number as Python has it; numbers of numpy will do, too."""


def exact(number: Amount) -> Fraction:
    """Return a number as a fraction; a float means the decimal that it prints as.

    Raises:
        UsageError: it is not finite, or no number.
    """
    if not isinstance(number, Real | Decimal) or isinstance(number, bool):
        raise UsageError(f"expected a number, found {number!r}")
    try:
        return Fraction(number) if isinstance(number, Rational | Decimal) else Fraction(repr(float(number)))
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
ExternalCost = Callable[..., "float | CostDistribution"]


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
    """

    branches: tuple[tuple[Expression, Expression], ...]
    condition: Formula = TRUE
    parameters: tuple[Parameter, ...] = ()
    external: ExternalCost | None = None
    place: Place | None = field(default=None, compare=False, repr=False)


FunctionValues = Mapping[tuple[str, ...], Fraction]
"""Values of functions in the initial state; the key is (function, *arguments)."""
