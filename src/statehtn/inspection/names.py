"""Predicates, functions and types that nothing mentions."""

from __future__ import annotations

from collections.abc import Iterator

from statehtn.hddl.vocabulary import ANY_TYPE
from statehtn.inspection.finding import Finding, Level
from statehtn.inspection.subject import Subject, whole_condition
from statehtn.model import (
    And,
    Arithmetic,
    Exists,
    Expression,
    Forall,
    Formula,
    FunctionTerm,
    Not,
    OfType,
    Or,
    Parameter,
)
from statehtn.model.formula import predicates

LEAVE_OUT = "leave it out, or use it where another name stands by mistake"


def check_names(subject: Subject) -> Iterator[Finding]:
    """Yield the declared names that nothing makes use of."""
    yield from _predicates(subject)
    used = functions_used(subject)
    for name in subject.domain.functions:
        if name not in used:
            message = f"function '{name}' is declared, and no cost or probability mentions it"
            place = subject.places.declared("function", name)
            yield Finding(Level.NOTE, place, message, LEAVE_OUT, "unused-function", ("function", name))
    if subject.problem is not None:
        yield from _types(subject)


def _predicates(subject: Subject) -> Iterator[Finding]:
    domain, problem = subject.domain, subject.problem
    read = {name for _, schema in subject.schemas for name in predicates(whole_condition(schema))}
    for action in domain.actions.values():
        conditions = [effect.condition for effect in action.all_effects]
        conditions += [block.condition for block in action.all_costs]
        read.update(name for condition in conditions for name in predicates(condition))
    changed = {effect.atom.predicate for action in domain.actions.values() for effect in action.all_effects}
    if problem is not None:
        read.update(predicates(problem.goal))
    for name in domain.predicates:
        if name in read:
            continue
        if name not in changed:
            message = f"predicate '{name}' is declared, and no action or method mentions it"
        elif problem is not None:
            message = f"predicate '{name}' is changed by actions, but no condition and no goal reads it"
        else:
            continue  # a goal may
        place = subject.places.declared("predicate", name)
        yield Finding(Level.NOTE, place, message, LEAVE_OUT, "unused-predicate", ("predicate", name))


def functions_used(subject: Subject) -> set[str]:
    """Return the functions in costs and probabilities."""
    actions = subject.domain.actions.values()
    return {name for action in actions for expression in action.expressions for name in functions_in(expression)}


def functions_in(expression: Expression) -> Iterator[str]:
    """Yield the functions in an expression."""
    if isinstance(expression, FunctionTerm):
        yield expression.function
    elif isinstance(expression, Arithmetic):
        for operand in expression.operands:
            yield from functions_in(operand)


def _types(subject: Subject) -> Iterator[Finding]:
    """Yield the types of no object, no parameter and no other type."""
    assert subject.problem is not None
    domain = subject.domain
    used = {parent for above in domain.types.parents.values() for parent in above}
    used.update(subject.problem.all_objects.values())
    used.update(kind for parameter in _parameters(subject) for kind in parameter.types)
    for name in domain.types.parents:
        if name not in used and name != ANY_TYPE and "+" not in name:
            message = f"type '{name}' is declared, and nothing is of it"
            place = subject.places.declared("type", name)
            yield Finding(Level.NOTE, place, message, LEAVE_OUT, "unused-type", ("type", name))


def _parameters(subject: Subject) -> Iterator[Parameter]:
    """Yield all typed variables of the model, and types in constraints as if they were of one."""
    domain, problem = subject.domain, subject.problem
    for table in (domain.predicates, domain.functions, domain.tasks):
        for signature in table.values():
            yield from signature.parameters
    for _, schema in subject.schemas:
        yield from schema.parameters
        yield from _quantified(whole_condition(schema))
    for action in domain.actions.values():
        for effect in action.all_effects:
            yield from (*effect.parameters, *_quantified(effect.condition))
        for block in action.all_costs:
            yield from (*block.parameters, *_quantified(block.condition))
    if problem is not None:
        yield from problem.parameters
        yield from _quantified(problem.goal)


def _quantified(formula: Formula) -> Iterator[Parameter]:
    match formula:
        case Not(operand):
            yield from _quantified(operand)
        case And(operands) | Or(operands):
            for operand in operands:
                yield from _quantified(operand)
        case Exists(parameters, body) | Forall(parameters, body):
            yield from parameters
            yield from _quantified(body)
        case OfType(term, types):
            yield Parameter(term, types)
