"""Methods as the grounder takes them: only what can change is left in preconditions, and unrelated choices are parted.

Each step keeps the set of decompositions. What stands in a precondition but can never change becomes a constraint. What
can change becomes a task of its own before all subtasks (an action without effects). A subtask whose other variables
nothing else mentions is handed over to a new task, so that the instances of a method are not the product of choices
that have nothing to do with each other, as pandaPIparser does before it grounds.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace

from statehtn.model import TRUE, And, Atom, Exists, Forall, Formula, Method, Not, Or, Parameter, Problem, TaskNetwork
from statehtn.model.formula import free_variables

Ordering = tuple[tuple[int, int], ...]


@dataclass(frozen=True)
class Guard:
    """A task that only tests a condition."""

    name: str
    parameters: tuple[Parameter, ...]
    condition: Formula


@dataclass(frozen=True)
class SchemeSubtask:
    """A subtask; `position` is its index in the lifted network, None for what the lifted network does not have."""

    task: str
    arguments: tuple[str, ...]
    position: int | None


@dataclass(frozen=True)
class Scheme:
    """A method as the grounder takes it.

    Args:
        method: what it comes from; None for the initial network.
        task: the compound task that it decomposes; artificial names have a space in them.
        parameters: those that are left here; a part has the rest.
        constraints: whatever can never change.
        is_part: whether this scheme is a part of another one of the same method, with parameters of the same names.
    """

    method: Method | None
    task: str
    arguments: tuple[str, ...]
    parameters: tuple[Parameter, ...]
    constraints: Formula
    subtasks: tuple[SchemeSubtask, ...]
    ordering: Ordering
    is_part: bool = False


INITIAL_TASK = "initial network"


def method_schemes(problem: Problem, split: bool) -> tuple[list[Guard], list[Scheme]]:
    """Return the guards and the methods of a problem; the last guard is the goal, the last whole scheme the network.

    Args:
        problem: the lifted problem.
        split: whether to part unrelated choices.
    """
    fluents = {effect.atom.predicate for action in problem.domain.actions.values() for effect in action.effects}
    guards: list[Guard] = []
    schemes: list[Scheme] = []
    for method in problem.domain.methods.values():
        static, changing = _partition(conjuncts(method.precondition), fluents)
        subtasks = _own_subtasks(method.network)
        ordering = method.network.ordering
        if changing:
            guard = _guard(f"precondition of {method.name}", method.parameters, changing)
            guards.append(guard)
            first = SchemeSubtask(guard.name, tuple(p.name for p in guard.parameters), None)
            subtasks = (first, *subtasks)
            ordering = (
                *((earlier + 1, later + 1) for earlier, later in ordering),
                *((0, position) for position in range(1, len(subtasks))),
            )
        constraints = And((*conjuncts(method.network.constraints), *static))
        schemes.append(
            Scheme(method, method.task, method.arguments, method.parameters, constraints, subtasks, ordering)
        )
    schemes.append(_initial_scheme(problem, guards))
    return guards, [part for scheme in schemes for part in (_split(scheme) if split else [scheme])]


def _initial_scheme(problem: Problem, guards: list[Guard]) -> Scheme:
    subtasks = _own_subtasks(problem.network)
    ordering = problem.network.ordering
    if problem.goal != TRUE:
        guards.append(Guard("goal", (), problem.goal))
        ordering = (*ordering, *((position, len(subtasks)) for position in range(len(subtasks))))
        subtasks = (*subtasks, SchemeSubtask("goal", (), None))
    return Scheme(None, INITIAL_TASK, (), problem.parameters, problem.network.constraints, subtasks, ordering)


def _own_subtasks(network: TaskNetwork) -> tuple[SchemeSubtask, ...]:
    return tuple(
        SchemeSubtask(subtask.task, subtask.arguments, position) for position, subtask in enumerate(network.subtasks)
    )


def conjuncts(formula: Formula) -> Iterator[Formula]:
    """Yield the parts of a conjunction, of nested ones too."""
    if isinstance(formula, And):
        for operand in formula.operands:
            yield from conjuncts(operand)
    else:
        yield formula


def _partition(formulas: Iterable[Formula], fluents: set[str]) -> tuple[list[Formula], list[Formula]]:
    """Part formulas into those that can never change and the others."""
    static: list[Formula] = []
    changing: list[Formula] = []
    for formula in formulas:
        (static if fluents.isdisjoint(_predicates(formula)) else changing).append(formula)
    return static, changing


def _predicates(formula: Formula) -> Iterator[str]:
    match formula:
        case Atom(predicate, _):
            yield predicate
        case Not(operand):
            yield from _predicates(operand)
        case And(operands) | Or(operands):
            yield from itertools.chain.from_iterable(map(_predicates, operands))
        case Exists(_, body) | Forall(_, body):
            yield from _predicates(body)


def _guard(name: str, parameters: Sequence[Parameter], condition: Sequence[Formula]) -> Guard:
    whole = condition[0] if len(condition) == 1 else And(tuple(condition))
    names = set(free_variables(whole))
    return Guard(name, tuple(parameter for parameter in parameters if parameter.name in names), whole)


def _split(scheme: Scheme) -> list[Scheme]:
    """Hand subtasks with variables of their own over to new tasks, as long as other choices are left beside them."""
    parts: list[Scheme] = []
    free = {parameter.name for parameter in scheme.parameters} - set(scheme.arguments)
    own = _own_variables(scheme, free) if len(free) > 1 else {}
    # From the last subtask to the first: what is chosen late need not be chosen at once.
    for index in sorted(own, reverse=True):
        subtask = scheme.subtasks[index]
        moved = [formula for formula in conjuncts(scheme.constraints) if own[index] & set(free_variables(formula))]
        shared = _variables(subtask).union(*map(free_variables, moved)) - own[index]
        if free <= own[index] | shared:
            continue
        free -= own[index]
        handed = tuple(parameter.name for parameter in scheme.parameters if parameter.name in shared)
        part = Scheme(
            scheme.method,
            f"part {len(parts) + 1} of {scheme.method.name if scheme.method else scheme.task}",
            handed,
            tuple(parameter for parameter in scheme.parameters if parameter.name in own[index] | shared),
            And(tuple(moved)),
            (subtask,),
            (),
            is_part=True,
        )
        parts.append(part)
        scheme = replace(
            scheme,
            parameters=tuple(parameter for parameter in scheme.parameters if parameter.name not in own[index]),
            constraints=And(tuple(formula for formula in conjuncts(scheme.constraints) if formula not in moved)),
            subtasks=(
                *scheme.subtasks[:index],
                SchemeSubtask(part.task, handed, None),
                *scheme.subtasks[index + 1 :],
            ),
        )
    return [*parts, scheme]


def _variables(subtask: SchemeSubtask) -> set[str]:
    return {argument for argument in subtask.arguments if argument.startswith("?")}


def _own_variables(scheme: Scheme, free: set[str]) -> dict[int, set[str]]:
    """Return by index of a subtask the variables on which nothing else depends, not even through constraints.

    A constraint ties variables to each other, but for those that are given anyway: by the decomposed task, or since
    several subtasks share them.
    """
    users: dict[str, list[int]] = {name: [] for name in free}
    for index, subtask in enumerate(scheme.subtasks):
        for name in _variables(subtask) & free:
            users[name].append(index)
    single = {name for name, indices in users.items() if len(indices) <= 1}
    tied = [names for formula in conjuncts(scheme.constraints) if (names := set(free_variables(formula)) & single)]
    own: dict[int, set[str]] = {}
    while single:
        group = {min(single)}
        while grown := {name for names in tied if names & group for name in names} - group:
            group |= grown
        single -= group
        indices = {index for name in group for index in users[name]}
        if len(indices) == 1:
            own.setdefault(indices.pop(), set()).update(group)
    return own
