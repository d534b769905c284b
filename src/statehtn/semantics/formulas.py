"""Formulas as syntax: their parts, their predicates, and their text."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from statehtn.model.formula import And, Atom, Equals, Exists, Forall, Formula, Not, OfType, Or
from statehtn.semantics.world import substitute

Bindings = Mapping[str, str]


def is_timeless(formula: Formula) -> bool:
    """Tell whether a formula is about objects only, so that it is true in every state or in none."""
    match formula:
        case Equals() | OfType():
            return True
        case Not(operand):
            return is_timeless(operand)
    return False


def conjuncts(formula: Formula) -> Iterator[Formula]:
    """Yield formulas whose conjunction is the formula; negations move inwards where that gives more of them."""
    match formula:
        case And(operands):
            for operand in operands:
                yield from conjuncts(operand)
        case Not(Or(operands)):
            for operand in operands:
                yield from conjuncts(Not(operand))
        case Not(Not(operand)):
            yield from conjuncts(operand)
        case _:
            yield formula


def text(formula: Formula, bindings: Bindings) -> str:
    """Print a formula as in HDDL, its bound variables replaced by their objects."""
    match formula:
        case Atom(name, terms):
            return f"({' '.join((name, *substitute(terms, bindings)))})"
        case Equals(left, right):
            return f"(= {bindings.get(left, left)} {bindings.get(right, right)})"
        case OfType(term, types):
            return f"(sortof {bindings.get(term, term)} - {' or '.join(types)})"
        case Not(operand):
            return f"(not {text(operand, bindings)})"
        case And(operands) | Or(operands):
            word = "and" if isinstance(formula, And) else "or"
            return f"({' '.join([word, *(text(operand, bindings) for operand in operands)])})"
        case Exists(parameters, body) | Forall(parameters, body):
            word = "exists" if isinstance(formula, Exists) else "forall"
            names = {parameter.name for parameter in parameters}
            outer = {name: value for name, value in bindings.items() if name not in names}
            return f"({word} ({' '.join(map(str, parameters))}) {text(body, outer)})"
