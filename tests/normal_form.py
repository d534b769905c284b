"""A normal form of problems, for comparing what went through another representation.

It forgets what does not matter: nested and repeated operands of `and` and `or`, whether an object is a constant, types
that nothing has, how often an order is stated, the domain's name, and labels of subtasks.
"""

from __future__ import annotations

from dataclasses import replace

from statehtn.interop.write_types import variables
from statehtn.model import (
    Action,
    And,
    CostBlock,
    Effect,
    Exists,
    Forall,
    Formula,
    Method,
    Not,
    Or,
    Problem,
    Subtask,
    TaskNetwork,
    TypeHierarchy,
)
from statehtn.model.formula import free_variables
from statehtn.model.types import ROOT_TYPE


def normal_form(problem: Problem) -> Problem:
    domain = problem.domain
    used = {*problem.all_objects.values(), *(kind for variable in variables(problem) for kind in variable.types)}
    kept = {kind for one in used for kind in domain.types.supertypes(one)}
    normal = replace(
        domain,
        name="domain",
        types=TypeHierarchy({name: _parents(name, domain.types) for name in sorted(kept - {ROOT_TYPE})}),
        constants={},
        actions={name: _action(action) for name, action in domain.actions.items()},
        methods={name: _method(method) for name, method in domain.methods.items()},
    )
    return replace(
        problem,
        domain=normal,
        objects=dict(problem.all_objects),
        network=_network(problem.network),
        goal=normal_formula(problem.goal),
    )


def _parents(name: str, hierarchy: TypeHierarchy) -> tuple[str, ...]:
    above = [parent for parent in hierarchy.parents[name] if parent != ROOT_TYPE]
    lowest = [one for one in above if not any(one in hierarchy.supertypes(other) for other in above if other != one)]
    return tuple(sorted(lowest)) or (ROOT_TYPE,)


def _action(action: Action) -> Action:
    effects = tuple(dict.fromkeys(_effect(effect) for effect in action.effects))
    return replace(
        action,
        precondition=normal_formula(action.precondition),
        effects=tuple(sorted(effects, key=repr)),
        costs=tuple(CostBlock(block.branches) for block in action.costs),
    )


def _effect(effect: Effect) -> Effect:
    used = {*effect.atom.arguments, *free_variables(effect.condition)}
    return replace(
        effect,
        condition=normal_formula(effect.condition),
        parameters=tuple(parameter for parameter in effect.parameters if parameter.name in used),
    )


def _method(method: Method) -> Method:
    return replace(method, network=_network(method.network), precondition=normal_formula(method.precondition))


def _network(network: TaskNetwork) -> TaskNetwork:
    return TaskNetwork(
        tuple(Subtask(str(i), one.task, one.arguments) for i, one in enumerate(network.subtasks)),
        tuple(sorted(set(network.ordering))),
        normal_formula(network.constraints),
    )


def normal_formula(formula: Formula) -> Formula:
    match formula:
        case And(operands):
            return _joined(And, operands)
        case Or(operands):
            return _joined(Or, operands)
        case Not(operand):
            return Not(normal_formula(operand))
        case Exists(parameters, body) | Forall(parameters, body):
            return type(formula)(parameters, normal_formula(body))
    return formula


def _joined(kind: type[And] | type[Or], operands: tuple[Formula, ...]) -> Formula:
    found: list[Formula] = []
    for operand in map(normal_formula, operands):
        found += operand.operands if isinstance(operand, kind) else (operand,)
    found = sorted(dict.fromkeys(found), key=repr)
    return found[0] if len(found) == 1 else kind(tuple(found))
