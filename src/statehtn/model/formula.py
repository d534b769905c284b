"""Formulas of preconditions, goals, constraints and conditions; implication is read as a disjunction.

A term is a string: a variable where it starts with a question mark, otherwise the name of an object. Formulas combine
by `&`, `|` and `~`.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import NoReturn, cast

from statehtn.errors import UsageError
from statehtn.model.types import Parameter

Fact = tuple[str, ...]
"""A ground atom: (predicate, *objects)."""


class Combinable:
    """What all formulas can do: `f & g`, `f | g` and `~f`, which flatten what was combined by the same sign before."""

    __slots__ = ()

    def __and__(self, other: Combinable) -> And:
        if not isinstance(other, Combinable):
            return NotImplemented
        return And((*_operands(self, And), *_operands(other, And)))

    def __or__(self, other: Combinable) -> Or:
        if not isinstance(other, Combinable):
            return NotImplemented
        return Or((*_operands(self, Or), *_operands(other, Or)))

    def __invert__(self) -> Not:
        return Not(cast("Formula", self))

    def __bool__(self) -> NoReturn:
        """Refuse: `f and g` would silently be `g`."""
        raise UsageError(f"a formula is neither true nor false by itself; combine formulas by &, | and ~: {self!r}")


def _operands(formula: Combinable, kind: type[And] | type[Or]) -> tuple[Formula, ...]:
    return formula.operands if isinstance(formula, kind) else (cast("Formula", formula),)


@dataclass(frozen=True, slots=True)
class Atom(Combinable):
    """A predicate over terms, such as `(at ?v l1)`."""

    predicate: str
    arguments: tuple[str, ...] = ()

    def __str__(self) -> str:
        return f"({' '.join((self.predicate, *self.arguments))})"


@dataclass(frozen=True, slots=True)
class Equals(Combinable):
    """Two terms name the same object."""

    left: str
    right: str


@dataclass(frozen=True, slots=True)
class OfType(Combinable):
    """A term names an object of one of the types (HDDL's sort constraint)."""

    term: str
    types: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Not(Combinable):
    """The operand does not hold."""

    operand: Formula


@dataclass(frozen=True, slots=True)
class And(Combinable):
    """All operands hold; without operands it is true."""

    operands: tuple[Formula, ...]


@dataclass(frozen=True, slots=True)
class Or(Combinable):
    """One of the operands holds; without operands it is false."""

    operands: tuple[Formula, ...]


@dataclass(frozen=True, slots=True)
class Exists(Combinable):
    """The body holds for some objects."""

    parameters: tuple[Parameter, ...]
    body: Formula


@dataclass(frozen=True, slots=True)
class Forall(Combinable):
    """The body holds for all objects."""

    parameters: tuple[Parameter, ...]
    body: Formula


Formula = Atom | Equals | OfType | Not | And | Or | Exists | Forall
TRUE = And(())


def is_variable(term: str) -> bool:
    """Tell whether a term is a variable."""
    return term.startswith("?")


def free_variables(formula: Formula) -> Iterator[str]:
    """Yield the variables that no quantifier of the formula binds, in order of appearance, with repetitions."""
    match formula:
        case Atom(_, terms):
            yield from filter(is_variable, terms)
        case Equals(left, right):
            yield from filter(is_variable, (left, right))
        case OfType(term, _):
            yield from filter(is_variable, (term,))
        case Not(operand):
            yield from free_variables(operand)
        case And(operands) | Or(operands):
            for operand in operands:
                yield from free_variables(operand)
        case Exists(parameters, body) | Forall(parameters, body):
            bound = {parameter.name for parameter in parameters}
            yield from (name for name in free_variables(body) if name not in bound)


def predicates(formula: Formula) -> Iterator[str]:
    """Yield the predicates of a formula, with repetitions."""
    match formula:
        case Atom(predicate):
            yield predicate
        case Not(operand):
            yield from predicates(operand)
        case And(operands) | Or(operands):
            for operand in operands:
                yield from predicates(operand)
        case Exists(_, body) | Forall(_, body):
            yield from predicates(body)


def conjuncts(formula: Formula) -> Iterator[Formula]:
    """Yield the parts of a conjunction, of nested ones too."""
    if isinstance(formula, And):
        for operand in formula.operands:
            yield from conjuncts(operand)
    else:
        yield formula
