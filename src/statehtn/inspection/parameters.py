"""Parameters that nothing mentions, and arguments whose types allow more than what takes them."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from statehtn.hddl.vocabulary import ANY_TYPE
from statehtn.inspection.finding import Finding, Level
from statehtn.inspection.subject import Subject, written
from statehtn.model import Action, Arithmetic, Expression, FunctionTerm, Method, Parameter
from statehtn.model.formula import Formula, free_variables
from statehtn.model.types import ROOT_TYPE


def check_parameters(subject: Subject) -> Iterator[Finding]:
    """Yield unused parameters of actions and methods, and subtasks whose arguments are of wider types."""
    for kind, schema in subject.schemas:
        used = _used(schema)
        for parameter in schema.parameters:
            if parameter.name not in used:
                yield _unused(subject, kind, schema, parameter)
        if isinstance(schema, Method):
            yield from _wide_arguments(subject, schema)


def _unused(subject: Subject, kind: str, schema: Action | Method, parameter: Parameter) -> Finding:
    place = subject.places.inside(
        "method" if kind == "method" else "task", schema.name, (":parameters",), (parameter.name,)
    )
    message = f"parameter '{parameter.name}' of {kind} '{schema.name}' is not used: nothing else there mentions it"
    advice = "leave it out, or use it where another variable stands by mistake"
    return Finding(Level.NOTE, place, message, advice, "unused-parameter", (kind, schema.name))


def _used(schema: Action | Method) -> set[str]:
    """Return the variables that stand anywhere but in the list of parameters."""
    found = set(free_variables(schema.precondition))
    if isinstance(schema, Method):
        found.update(schema.arguments, free_variables(schema.network.constraints))
        found.update(term for subtask in schema.network.subtasks for term in subtask.arguments)
        return found
    for effect in schema.all_effects:
        found.update((*effect.atom.arguments, *free_variables(effect.condition)))
    for block in schema.all_costs:
        found.update(free_variables(block.condition))
    found.update(term for expression in schema.expressions for term in _terms(expression))
    return found


def _terms(expression: Expression) -> Iterator[str]:
    """Yield the arguments of the functions in an expression."""
    if isinstance(expression, FunctionTerm):
        yield from expression.arguments
    elif isinstance(expression, Arithmetic):
        for operand in expression.operands:
            yield from _terms(operand)


def _wide_arguments(subject: Subject, method: Method) -> Iterator[Finding]:
    """Yield the variables of a method that stand for an argument of a narrower type."""
    domain = subject.domain
    declared = {parameter.name: parameter.types for parameter in method.parameters}
    for subtask in method.network.subtasks:
        action = domain.actions.get(subtask.task)
        wanted = (action or domain.tasks[subtask.task]).parameters
        for term, parameter in zip(subtask.arguments, wanted, strict=True):
            types = declared.get(term, ())
            if _fit(subject, types, parameter.types) or _is_restricted(term, method.network.constraints):
                continue
            kind = "action" if action else "task"
            message = (
                f"'{term}' of method '{method.name}' is of type {_alternatives(types)}, and {kind} '{subtask.task}' "
                f"takes only {_alternatives(parameter.types)} for '{parameter.name}': with other objects the method "
                "cannot be used"
            )
            place = subject.places.inside("method", method.name, written(subtask))
            advice = f"give '{term}' the narrower type, if this is meant"
            yield Finding(Level.NOTE, place, message, advice, "wide-type", ("method", method.name))


def _fit(subject: Subject, types: Iterable[str], wanted: tuple[str, ...]) -> bool:
    hierarchy = subject.domain.types
    return ROOT_TYPE in wanted or all(kind == ANY_TYPE or hierarchy.is_subtype(kind, wanted) for kind in types)


def _is_restricted(term: str, constraints: Formula) -> bool:
    """Tell whether the constraints of a network mention a variable: they may narrow its type."""
    return term in free_variables(constraints)


def _alternatives(types: Iterable[str]) -> str:
    return " or ".join(f"'{kind}'" for kind in types)
