"""The values of cost and probability expressions, in exact numbers."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from fractions import Fraction

from statehtn.errors import InputError
from statehtn.model.cost.blocks import Arithmetic, Expression, FunctionTerm, FunctionValues, Number
from statehtn.model.cost.unknown import MissingNumber


def evaluate(expression: Expression, bindings: Mapping[str, str], values: FunctionValues) -> Fraction:
    """Return the exact value of a cost or probability expression.

    Args:
        expression: numbers, functions and sums, differences and products of them.
        bindings: the object of every variable in the expression.
        values: the function values of `:init`.

    Raises:
        MissingNumber: `:init` does not define the value of a function that is needed.
    """
    match expression:
        case Number(value):
            return value
        case FunctionTerm(function, arguments):
            key = (function, *(bindings.get(term, term) for term in arguments))
            if key not in values:
                term = f"({' '.join(key)})"
                raise MissingNumber(f"the value of {term} is not defined; add (= {term} <number>) to :init")
            return values[key]
        case Arithmetic("+", operands):
            return sum((evaluate(operand, bindings, values) for operand in operands), Fraction(0))
        case Arithmetic("*", operands):
            return math.prod((evaluate(operand, bindings, values) for operand in operands), start=Fraction(1))
        case Arithmetic("-", operands) if operands:
            first, *rest = (evaluate(operand, bindings, values) for operand in operands)
            return first - sum(rest, Fraction(0)) if rest else -first
    raise InputError(f"a cost is a number, a function of the parameters, or + - * of them, found {expression}")


def constant_value(expression: Expression) -> Fraction | None:
    """Return the value of an expression without functions, None for one with functions."""
    return None if _has_function(expression) else evaluate(expression, {}, {})


def sum_of_constants(expressions: Iterable[Expression]) -> Fraction | None:
    """Return the sum of expressions where it is the same whatever the functions' values are, as of `p` and `1 - p`."""
    form = _linear(Arithmetic("+", tuple(expressions)))
    return None if any(weight for term, weight in form.items() if term is not None) else form.get(None, Fraction(0))


def _linear(expression: Expression) -> dict[Expression | None, Fraction]:
    """Return an expression as a weighted sum of terms, None for 1; a product of terms is a term of its own."""
    match expression:
        case Number(value):
            return {None: value}
        case Arithmetic("*", operands):
            factor, others = Fraction(1), []
            for form in map(_linear, operands):
                if form.keys() <= {None}:
                    factor *= form.get(None, Fraction(0))
                else:
                    others.append(form)
            if len(others) > 1:
                return {expression: Fraction(1)}
            return {term: factor * weight for term, weight in (others[0] if others else {None: Fraction(1)}).items()}
        case Arithmetic(operator, operands):
            total: dict[Expression | None, Fraction] = {}
            for number, operand in enumerate(operands):
                sign = -1 if operator == "-" and (number or len(operands) == 1) else 1
                for term, weight in _linear(operand).items():
                    total[term] = total.get(term, Fraction(0)) + sign * weight
            return total
    return {expression: Fraction(1)}


def _has_function(expression: Expression) -> bool:
    if isinstance(expression, Arithmetic):
        return any(_has_function(operand) for operand in expression.operands)
    return isinstance(expression, FunctionTerm)
