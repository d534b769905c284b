"""The parts of an action: effects and costs, under conditions and for all objects.

`when` and `forall` nest around effects and around costs alike, as in HDDL.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from decimal import Decimal
from fractions import Fraction
from numbers import Real
from typing import Any, TypeGuard, cast, overload

from statehtn.build.declarations import Declarations, Scope
from statehtn.build.external import external
from statehtn.build.terms import checked_formula, checked_variables
from statehtn.errors import UsageError
from statehtn.expected import shown_number
from statehtn.model import (
    TRUE,
    And,
    Atom,
    CostBlock,
    CostDistribution,
    CostLaw,
    Effect,
    Expression,
    Forall,
    Formula,
    Not,
    Number,
    Parameter,
)
from statehtn.model.cost.blocks import PROBABILITY_TOLERANCE, Amount, Computable, ExternalCost, block_of, exact
from statehtn.model.cost.expressions import constant_value
from statehtn.model.cost.law import is_of_scipy
from statehtn.model.formula import Combinable


@dataclass(frozen=True, slots=True)
class Chance:
    """An uncertain cost of expressions: pairs (probability, cost); `chance` makes it."""

    branches: tuple[tuple[Expression, Expression], ...]


@dataclass(frozen=True, slots=True)
class When:
    """Effects or costs that are due in the states in which a condition holds; `when` makes it."""

    condition: Formula
    parts: tuple[Any, ...]


@dataclass(frozen=True, slots=True)
class Quantified:
    """Effects or costs that are due once for all objects of the variables' types; `forall` makes it."""

    parameters: tuple[Parameter, ...]
    parts: tuple[Any, ...]


EffectPart = Combinable | When | Quantified
"""Atoms that become true, negated ones that become false, conjunctions of both; under `when` and `forall`."""
CostPart = Amount | CostLaw | Computable | Chance | Callable[..., Any] | When | Quantified
"""A number, a law, an expression, `chance(...)` or a Python callable; also under `when` and `forall`.

A frozen distribution of `scipy.stats` is taken as its law.
"""


def when(condition: Combinable, *parts: EffectPart | CostPart) -> When:
    """Return effects or costs that are due in the states in which a condition holds, before the action.

    Args:
        condition: a formula.
        parts: effects, or costs. Costs of several conditions that hold at once add up.

    Raises:
        UsageError: the condition is no formula, or nothing is due under it.
    """
    if not parts:
        raise UsageError("'when' has a condition and what is due under it, found the condition alone")
    return When(checked_formula(condition, "the condition of 'when'"), parts)


@overload
def forall(variables: Iterable[Parameter], part: Combinable) -> Forall: ...
@overload
def forall(variables: Iterable[Parameter], part: CostPart, *parts: EffectPart | CostPart) -> Quantified: ...
def forall(
    variables: Iterable[Parameter], part: EffectPart | CostPart, *parts: EffectPart | CostPart
) -> Forall | Quantified:
    """Return what holds, or is due, for all objects of the variables' types.

    Args:
        variables: of one type or several, such as `place.variables("a", "b")`.
        part: one formula makes a formula (which may be an effect); anything else stands in `effects` or `cost`.
        parts: more of these.

    Raises:
        UsageError: a variable is none, or the body is no formula.
    """
    if not parts and isinstance(part, Combinable):
        return Forall(checked_variables(variables), checked_formula(part, "the body of 'forall'"))
    return Quantified(checked_variables(variables), (part, *parts))


def chance(*branches: tuple[Computable | Amount, Computable | Amount]) -> Chance:
    """Return a cost that is uncertain: pairs (probability, cost) of numbers or expressions.

    Args:
        branches: the pairs, such as `(0.8, 2), (0.2, 3 * hours(a, b))`; costs are positive and minimised, in the
            domain's own unit.

    Raises:
        UsageError: a number is negative, or constant probabilities do not sum to 1.
    """
    if not branches:
        raise UsageError("expected pairs (probability, cost), found none")
    found = []
    for branch in branches:
        if not isinstance(branch, tuple | list) or len(branch) != 2:
            raise UsageError(f"expected a pair (probability, cost), found {branch!r}")
        probability, cost = branch
        found.append((expression_of(probability, "a probability"), expression_of(cost, "a cost")))
    values = [constant_value(probability) for probability, _ in found]
    total = sum((value for value in values if value is not None), Fraction(0))
    off = total - 1
    if off > PROBABILITY_TOLERANCE or (off < -PROBABILITY_TOLERANCE and None not in values):
        raise UsageError(f"the probabilities of a cost must sum to 1, found {shown_number(total)}")
    return Chance(tuple(found))


def effects_of(parts: object, scope: Scope, declared: Declarations) -> tuple[Effect, ...]:
    """Return the effects that the parts of an action stand for.

    Raises:
        UsageError: a part is no effect, or a name in it is wrong.
    """
    found = []
    for part, condition, parameters, inner in _parts(listed(parts), TRUE, (), scope, declared):
        match part:
            case Atom():
                effect = Effect(part, True, condition, parameters)
            case Not(Atom() as atom):
                effect = Effect(atom, False, condition, parameters)
            case _:
                raise UsageError(f"an effect is an atom such as at(x), or ~at(x), found {part!r}")
        declared.check_formula(effect.atom, inner)
        found.append(effect)
    return tuple(found)


def costs_of(
    parts: object, action: str, parameters: tuple[Parameter, ...], scope: Scope, declared: Declarations
) -> tuple[CostBlock, ...]:
    """Return the cost blocks that the parts of an action stand for; they are independent and add up.

    Raises:
        UsageError: a part is no cost, or a name in it is wrong.
    """
    found = []
    for part, condition, bound, inner in _parts(listed(parts), TRUE, (), scope, declared):
        if _is_external(part):
            found.append(CostBlock((), condition, bound, external(action, parameters, part)))
            continue
        law = CostDistribution.from_scipy(part) if is_of_scipy(part) else part
        if isinstance(law, CostLaw):
            found.append(replace(block_of(law), condition=condition, parameters=bound))
            continue
        branches = _branches(part)
        for branch in branches:
            for expression in branch:
                declared.check_expression(expression, inner)
        found.append(CostBlock(branches, condition, bound))
    return tuple(found)


def _parts(
    parts: Sequence[object], condition: Formula, parameters: tuple[Parameter, ...], scope: Scope, declared: Declarations
) -> Iterator[tuple[object, Formula, tuple[Parameter, ...], Scope]]:
    """Yield every part with the condition, the variables and the scope around it."""
    for part in parts:
        match part:
            case And(operands):
                yield from _parts(operands, condition, parameters, scope, declared)
            case When(inner, nested):
                declared.check_formula(inner, scope)
                both = inner if condition == TRUE else And((condition, inner))
                yield from _parts(nested, both, parameters, scope, declared)
            case Quantified(bound, nested):
                yield from _parts(nested, condition, (*parameters, *bound), joined(scope, bound, declared), declared)
            case Forall(bound, body):
                yield from _parts((body,), condition, (*parameters, *bound), joined(scope, bound, declared), declared)
            case _:
                yield part, condition, parameters, scope


def joined(scope: Scope, bound: tuple[Parameter, ...], declared: Declarations) -> Scope:
    """Return a scope with the variables of a `forall`.

    Raises:
        UsageError: one of them is a variable around it, too.
    """
    around = {name.lower() for name in scope.variables}
    for parameter in bound:
        if parameter.name.lower() in around:
            raise UsageError(f"variable '{parameter.name}' of 'forall' is a variable around it, too; use another name")
    return declared.extended(scope, bound)


def listed(parts: object) -> Sequence[object]:
    """Return parts as a list, in which a part that is given alone is the only one."""
    if isinstance(parts, Iterable) and not isinstance(parts, str | Mapping) and not callable(parts):
        return list(parts)
    return [parts]


def _is_external(part: object) -> TypeGuard[ExternalCost]:
    return callable(part) and not isinstance(part, CostLaw) and not is_of_scipy(part)


def _branches(part: object) -> tuple[tuple[Expression, Expression], ...]:
    if isinstance(part, Chance):
        return part.branches
    if isinstance(part, Computable | Real | Decimal) and not isinstance(part, bool):
        return ((Number(Fraction(1)), expression_of(part, "a cost")),)
    raise UsageError(
        f"a cost is a number, a CostDistribution, an expression of functions, chance(...) or a callable, found {part!r}"
    )


def expression_of(value: object, what: str) -> Expression:
    """Return a number or an expression as an expression.

    Raises:
        UsageError: it is neither, or negative for sure.
    """
    if isinstance(value, Computable):
        expression: Expression = value  # type: ignore[assignment]
    elif isinstance(value, Real | Decimal):
        expression = Number(exact(cast("Amount", value)))
    else:
        raise UsageError(f"{what} is a number or an expression of functions, found {value!r}")
    constant = constant_value(expression)
    if constant is not None and constant < 0:
        raise UsageError(f"{what} must not be negative, found {float(constant):g}")
    return expression
