"""Type hierarchies as types of unified-planning (UP), where a type has one father at most."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from statehtn.errors import UnsupportedError
from statehtn.interop.names import Names
from statehtn.model import And, Exists, Forall, Formula, Not, Or, Parameter, Problem, TypeHierarchy
from statehtn.model.types import ROOT_TYPE


def up_types(problem: Problem, names: Names, environment: Any) -> dict[str, Any]:
    """Return UP's types by our names; `object` is among them where something is of that type.

    Raises:
        UnsupportedError: a type has several supertypes.
    """
    hierarchy = problem.domain.types
    found: dict[str, Any] = {}
    root = None
    if ROOT_TYPE in problem.all_objects.values() or any(ROOT_TYPE in one.types for one in variables(problem)):
        root = found[ROOT_TYPE] = environment.type_manager.UserType(names.theirs(ROOT_TYPE))

    def declare(name: str) -> Any:
        if name not in found:
            above = _father(name, hierarchy)
            father = root if above == ROOT_TYPE else declare(above)
            found[name] = environment.type_manager.UserType(names.theirs(name), father)
        return found[name]

    for name in hierarchy.parents:
        declare(name)
    return found


def _father(name: str, hierarchy: TypeHierarchy) -> str:
    """Return the supertype just above a type."""
    above = [parent for parent in hierarchy.parents[name] if parent != ROOT_TYPE]
    lowest = [one for one in above if not any(one in hierarchy.supertypes(other) for other in above if other != one)]
    if len(lowest) > 1:
        raise UnsupportedError(f"type '{name}' has several supertypes ({', '.join(lowest)}); in UP a type has one")
    return lowest[0] if lowest else ROOT_TYPE


def variables(problem: Problem) -> Iterator[Parameter]:
    """Yield all variables of a problem."""
    domain = problem.domain
    yield from problem.parameters
    yield from _bound(problem.goal)
    for signature in (*domain.predicates.values(), *domain.functions.values(), *domain.tasks.values()):
        yield from signature.parameters
    for action in domain.actions.values():
        yield from action.parameters
        yield from _bound(action.precondition)
        for effect in action.all_effects:
            yield from effect.parameters
            yield from _bound(effect.condition)
    for method in domain.methods.values():
        yield from method.parameters
        yield from _bound(method.precondition)


def _bound(formula: Formula) -> Iterator[Parameter]:
    """Yield the variables of a formula's quantifiers."""
    match formula:
        case Exists(parameters, body) | Forall(parameters, body):
            yield from parameters
            yield from _bound(body)
        case And(operands) | Or(operands):
            for operand in operands:
                yield from _bound(operand)
        case Not(operand):
            yield from _bound(operand)
