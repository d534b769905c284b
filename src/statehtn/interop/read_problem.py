"""Problems of unified-planning (UP) as cost-variable HTN problems."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from statehtn.errors import UnsupportedError
from statehtn.hddl.spelling import Spellings
from statehtn.interop.names import Vocabulary, our_name, vocabulary_of_up
from statehtn.interop.read_actions import read_actions
from statehtn.interop.read_formulas import Scope, conjunction, our_type
from statehtn.interop.read_initial_state import read_initial_state
from statehtn.model import Domain, Method, Parameter, Problem, Signature, Subtask, TaskNetwork, TypeHierarchy
from statehtn.model.types import ROOT_TYPE

OTHER_PARTS = ("timed_effects", "timed_goals", "trajectory_constraints", "state_invariants", "processes", "events")


def read_up_problem(problem: Any) -> tuple[Problem, Vocabulary]:
    """Return a `HierarchicalProblem` of UP as one of ours, and the names of its things on both sides.

    Raises:
        UnsupportedError: it has numbers that matter, times, undefined facts, or another metric.
    """
    for part in OTHER_PARTS:
        if getattr(problem, part, None):
            raise UnsupportedError(f"the problem has {part.replace('_', ' ')}, which this planner does not know")
    vocabulary = vocabulary_of_up(problem)
    named: set[str] = set()
    name = our_name(problem.name or "problem", Spellings())
    actions = read_actions(problem, vocabulary, named)
    methods = [_method(method, vocabulary, named) for method in problem.methods]
    tasks = [_signature(vocabulary.tasks.ours(task.name), task.parameters, vocabulary) for task in problem.tasks]
    predicates, functions = _fluents(problem, vocabulary)
    kinds = {vocabulary.objects.ours(one.name): our_type(one.type, vocabulary) for one in problem.all_objects}
    facts, values = read_initial_state(problem, vocabulary)
    scope = Scope.of(vocabulary, problem.task_network.variables)
    goal = conjunction(map(Scope.of(vocabulary).formula, problem.goals))
    domain = Domain(
        name,
        TypeHierarchy(dict(_types(vocabulary))),
        {one: kind for one, kind in kinds.items() if one in named},
        predicates,
        functions,
        {task.name: task for task in tasks},
        actions,
        {method.name: method for method in methods},
    )
    read = Problem(
        name,
        domain,
        {one: kind for one, kind in kinds.items() if one not in named},
        scope.parameters("parameter", problem.task_network.variables),
        _network(problem.task_network, scope),
        facts,
        values,
        goal,
    )
    return read, vocabulary


def _types(vocabulary: Vocabulary) -> Iterator[tuple[str, tuple[str, ...]]]:
    for kind in vocabulary.up_types:
        yield vocabulary.our_type(kind), (ROOT_TYPE if kind.father is None else vocabulary.our_type(kind.father),)


def _signature(name: str, parameters: Any, vocabulary: Vocabulary) -> Signature:
    return Signature(name, Scope.of(vocabulary, parameters).parameters("parameter", parameters))


def _fluents(problem: Any, vocabulary: Vocabulary) -> tuple[dict[str, Signature], dict[str, Signature]]:
    """Return the predicates and the functions; a fluent with objects as values is a predicate of one more argument."""
    predicates: dict[str, Signature] = {}
    functions: dict[str, Signature] = {}
    for fluent in problem.fluents:
        signature = _signature(vocabulary.fluents.ours(fluent.name), fluent.signature, vocabulary)
        if fluent.type.is_user_type():
            taken = Spellings(parameter.name[1:] for parameter in signature.parameters)
            value = Parameter(f"?{our_name('value', taken)}", (our_type(fluent.type, vocabulary),))
            signature = Signature(signature.name, (*signature.parameters, value))
        (predicates if not _is_number(fluent) else functions)[signature.name] = signature
    return predicates, functions


def _is_number(fluent: Any) -> bool:
    return bool(fluent.type.is_int_type() or fluent.type.is_real_type())


def _method(method: Any, vocabulary: Vocabulary, named: set[str]) -> Method:
    scope = Scope.of(vocabulary, method.parameters, named)
    task = method.achieved_task
    return Method(
        vocabulary.methods.ours(method.name),
        scope.parameters("parameter", method.parameters),
        vocabulary.tasks.ours(task.task.name),
        tuple(parameter.name for parameter in scope.parameters("parameter", task.parameters)),
        _network(method, scope),
        conjunction(map(scope.formula, method.preconditions)),
    )


def _network(network: Any, scope: Scope) -> TaskNetwork:
    """Return the task network of a method, or the initial one."""
    labels = Spellings()
    positions: dict[str, int] = {}
    subtasks = []
    for position, subtask in enumerate(network.subtasks):
        label = our_name(subtask.identifier, labels)
        labels.add((label,))
        positions[subtask.identifier] = position
        name = scope.vocabulary.tasks.ours(subtask.task.name)
        subtasks.append(Subtask(label, name, tuple(map(scope.term, subtask.parameters))))
    ordering = tuple(dict.fromkeys(_pair(one, positions) for one in network.temporal_constraints()))
    return TaskNetwork(tuple(subtasks), ordering, conjunction(map(scope.formula, network.non_temporal_constraints())))


def _pair(constraint: Any, positions: dict[str, int]) -> tuple[int, int]:
    """Return the positions of two subtasks of which the first ends before the second starts.

    Raises:
        UnsupportedError: the constraint says something else.
    """
    sides = [side.timing() for side in constraint.args if side.is_timing_exp()]
    if constraint.is_lt() and len(sides) == 2 and not any(side.delay for side in sides):
        first, second = (side.timepoint for side in sides)
        is_order = (first.kind.name, second.kind.name) == ("END", "START")
        if is_order and {first.container, second.container} <= set(positions):
            return positions[first.container], positions[second.container]
    raise UnsupportedError(f"subtasks are ordered by 'one ends before another starts' alone, found '{constraint}'")
