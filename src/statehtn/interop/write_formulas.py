"""Formulas and cost expressions as expressions of unified-planning (UP)."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from typing import Any

from unified_planning.model import Variable

from statehtn.errors import UnsupportedError
from statehtn.model import (
    And,
    Arithmetic,
    Atom,
    Equals,
    Exists,
    Expression,
    Forall,
    Formula,
    FunctionTerm,
    Not,
    Number,
    OfType,
    Or,
    Parameter,
    Problem,
)
from statehtn.model.formula import is_variable


@dataclass(frozen=True)
class Things:
    """What a UP problem has declared so far, by our names."""

    problem: Problem
    manager: Any
    types: dict[str, Any]
    fluents: dict[str, Any]
    objects: dict[str, Any]

    def type_of(self, parameter: Parameter) -> Any:
        """Return UP's type of a variable.

        Raises:
            UnsupportedError: the variable has several types.
        """
        if len(parameter.types) > 1:
            raise UnsupportedError(f"UP has no variables of several types, found '{parameter}'; give it one type")
        return self.types[parameter.types[0]]

    def scope(self, parameters: Iterable[Parameter], theirs: Iterable[Any]) -> Writer:
        """Return a writer of expressions that may use the parameters, which UP has as `theirs`."""
        variables = {ours.name: their for ours, their in zip(parameters, theirs, strict=True)}
        return Writer(self, variables)


def plain(variable: str) -> str:
    """Return the name of a variable as UP writes it, without the question mark."""
    return variable.removeprefix("?")


@dataclass(frozen=True)
class Writer:
    """Writes the expressions of an action, a method or the problem."""

    things: Things
    variables: Mapping[str, Any]

    def formula(self, formula: Formula) -> Any:
        """Return a formula as an expression of UP.

        Raises:
            UnsupportedError: a variable has several types, or does not fit where it is used.
        """
        manager = self.things.manager
        match formula:
            case Atom(predicate, terms):
                return self.fluent(predicate, terms)
            case Equals(left, right):
                return self.equality(left, right)
            case OfType(term, types):
                members = self.things.problem.objects_of(types)
                return manager.Or(*(self.equality(term, name) for name in members))
            case Not(operand):
                return manager.Not(self.formula(operand))
            case And(operands):
                return manager.And(*map(self.formula, operands))
            case Or(operands):
                return manager.Or(*map(self.formula, operands))
            case Exists(parameters, body) | Forall(parameters, body):
                inner, bound = self.binding(parameters)
                quantifier = manager.Exists if isinstance(formula, Exists) else manager.Forall
                return quantifier(inner.formula(body), *bound)

    def equality(self, left: str, right: str) -> Any:
        """Return the formula that two terms are equal: false where their types share no object.

        UP compares terms of one tree of types only. Its types have one father each, as ours must have to become types
        of UP, so that two types without a common ancestor have no common subtype, and no object either.
        """
        manager = self.things.manager
        terms = self.term(left), self.term(right)
        trees = [set(term.type.ancestors) for term in terms]
        return manager.FALSE() if trees[0].isdisjoint(trees[1]) else manager.Equals(*terms)

    def binding(self, parameters: Iterable[Parameter]) -> tuple[Writer, tuple[Any, ...]]:
        """Return the writer within a quantifier, and UP's variables that it binds."""
        bound = {p.name: Variable(plain(p.name), self.things.type_of(p)) for p in parameters}
        return replace(self, variables={**self.variables, **bound}), tuple(bound.values())

    def fluent(self, name: str, terms: Iterable[str]) -> Any:
        """Return a predicate or a function of terms.

        Raises:
            UnsupportedError: UP does not allow terms of such types.
        """
        fluent = self.things.fluents[name]
        found = tuple(map(self.term, terms))
        # UP finds that out by itself, but late, and keeps wrong answers where problems share names.
        if not all(one.type.is_compatible(term.type) for one, term in zip(fluent.signature, found, strict=True)):
            shown = f"({' '.join((name, *terms))})"
            raise UnsupportedError(f"in {shown} a term's type is wider than the declaration's; UP forbids it")
        return fluent(*found)

    def term(self, term: str) -> Any:
        """Return a variable or an object."""
        if is_variable(term):
            return self.things.manager.auto_promote(self.variables[term])[0]
        return self.things.manager.ObjectExp(self.things.objects[term])

    def cost(self, expression: Expression) -> Any:
        """Return a cost expression."""
        manager = self.things.manager
        match expression:
            case Number(value):
                return manager.Int(int(value)) if value.denominator == 1 else manager.Real(value)
            case FunctionTerm(function, terms):
                return self.fluent(function, terms)
            case Arithmetic("+", operands):
                return manager.Plus(*map(self.cost, operands))
            case Arithmetic("*", operands):
                return manager.Times(*map(self.cost, operands))
            case Arithmetic("-", (operand,)):
                return manager.Minus(0, self.cost(operand))
            case Arithmetic("-", (first, *rest)):
                subtrahend = self.cost(rest[0]) if len(rest) == 1 else manager.Plus(*map(self.cost, rest))
                return manager.Minus(self.cost(first), subtrahend)
        raise UnsupportedError(
            f"a cost is a number, a function of the parameters, or + - * of them, found {expression}"
        )
