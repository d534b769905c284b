"""Cost-variable HTN problems as problems of unified-planning (UP)."""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from typing import Any

from unified_planning.environment import get_environment
from unified_planning.exceptions import UPException
from unified_planning.model import Fluent, InstantaneousAction, Object
from unified_planning.model.htn import HierarchicalProblem, ParameterizedTask, Task
from unified_planning.model.htn import Method as UpMethod
from unified_planning.model.metrics import MinimizeActionCosts, MinimizeSequentialPlanLength

from statehtn.errors import UnsupportedError
from statehtn.interop.costs import expected_cost
from statehtn.interop.names import Vocabulary, vocabulary_of
from statehtn.interop.write_formulas import Things, Writer, plain
from statehtn.interop.write_types import up_types
from statehtn.model import Action, Method, Parameter, Problem, TaskNetwork
from statehtn.model.formula import conjuncts, is_variable


def write_up_problem(problem: Problem) -> tuple[HierarchicalProblem, Vocabulary]:
    """Return a problem as one of UP, and the names of its things on both sides.

    Raises:
        UnsupportedError: it has something that UP cannot hold; the message says where.
    """
    if problem.chances:
        raise UnsupportedError(
            "facts that are decided by chance and never seen cannot be a part of a problem of unified-planning"
        )
    names = vocabulary_of(problem)
    environment = get_environment()  # UP's task networks know no other
    up = HierarchicalProblem(problem.name, environment)
    things = Things(problem, environment.expression_manager, up_types(problem, names.types, environment), {}, {})
    _declare_objects(up, things, names)
    _declare_fluents(up, things, names)
    tasks: dict[str, Any] = {}
    for name, action in problem.domain.actions.items():
        with _placed(f"action '{name}'"):
            tasks[name] = _action(names.tasks.theirs(name), action, things)
            up.add_action(tasks[name])
    for name, task in problem.domain.tasks.items():
        with _placed(f"task '{name}'"):
            tasks[name] = Task(names.tasks.theirs(name), _parameters(task.parameters, things))
            up.add_task(tasks[name])
    for method in problem.domain.methods.values():
        with _placed(f"method '{method.name}'"):
            up.add_method(_method(names.methods.theirs(method.name), method, tasks, things))
    with _placed("the initial network"):
        variables = [up.task_network.add_variable(plain(p.name), things.type_of(p)) for p in problem.parameters]
        _fill(up.task_network, problem.network, tasks, things.scope(problem.parameters, variables))
    with _placed("the goal"):
        for goal in conjuncts(problem.goal):
            up.add_goal(things.scope((), ()).formula(goal))
    up.add_quality_metric(_metric(problem, tasks, things))
    return up, names


@contextmanager
def _placed(where: str) -> Iterator[None]:
    """Say where something went wrong, and turn UP's exceptions into ours."""
    try:
        yield
    except UnsupportedError as error:
        raise UnsupportedError(f"{where}: {error.message}", error.place) from None
    except (UPException, AssertionError) as error:
        raise UnsupportedError(f"{where} cannot be a part of a problem of unified-planning: {error}") from None


def _declare_objects(up: HierarchicalProblem, things: Things, names: Vocabulary) -> None:
    for name, kind in things.problem.all_objects.items():
        things.objects[name] = Object(names.objects.theirs(name), things.types[kind])
        up.add_object(things.objects[name])


def _declare_fluents(up: HierarchicalProblem, things: Things, names: Vocabulary) -> None:
    """Declare predicates and functions with their initial values; a function without one has none in UP either."""
    problem, types = things.problem, up.environment.type_manager
    scope = things.scope((), ())
    fractional = {function for (function, *_), value in problem.function_values.items() if value.denominator != 1}
    for name, signature in problem.domain.predicates.items():
        with _placed(f"predicate '{name}'"):
            kind = types.BoolType()
            fluent = Fluent(names.fluents.theirs(name), kind, _parameters(signature.parameters, things), up.environment)
            things.fluents[name] = up.add_fluent(fluent, default_initial_value=False)
    for name, signature in problem.domain.functions.items():
        with _placed(f"function '{name}'"):
            kind = types.RealType() if name in fractional else types.IntType()
            fluent = Fluent(names.fluents.theirs(name), kind, _parameters(signature.parameters, things), up.environment)
            things.fluents[name] = up.add_fluent(fluent)
    with _placed("the initial state"):
        for predicate, *arguments in sorted(problem.initial_state):
            up.set_initial_value(scope.fluent(predicate, arguments), True)
        for (function, *arguments), value in problem.function_values.items():
            up.set_initial_value(scope.fluent(function, arguments), value)


def _parameters(parameters: Iterable[Parameter], things: Things) -> OrderedDict[str, Any]:
    return OrderedDict((plain(parameter.name), things.type_of(parameter)) for parameter in parameters)


def _action(name: str, action: Action, things: Things) -> InstantaneousAction:
    if action.outcomes:
        raise UnsupportedError(
            "it changes facts by chance, and actions of unified-planning have one effect", action.outcomes[0].place
        )
    up = InstantaneousAction(name, _parameters(action.parameters, things))
    scope = things.scope(action.parameters, up.parameters)
    for condition in conjuncts(action.precondition):
        up.add_precondition(scope.formula(condition))
    for effect in action.effects:
        inner, bound = scope.binding(effect.parameters)
        fluent = inner.fluent(effect.atom.predicate, effect.atom.arguments)
        up.add_effect(fluent, effect.positive, inner.formula(effect.condition), bound)
    return up


def _method(name: str, method: Method, tasks: dict[str, Any], things: Things) -> UpMethod:
    up = UpMethod(name, _parameters(method.parameters, things))
    if not all(map(is_variable, method.arguments)):
        shown = f"({' '.join((method.task, *method.arguments))})"
        raise UnsupportedError(f"it is for {shown}; UP's methods have parameters there, no objects")
    scope = things.scope(method.parameters, up.parameters)
    # As one object: of a task without arguments UP would otherwise take the parameters by name.
    up.set_task(ParameterizedTask(tasks[method.task], *(scope.variables[term] for term in method.arguments)))
    for condition in conjuncts(method.precondition):
        up.add_precondition(scope.formula(condition))
    _fill(up, method.network, tasks, scope)
    return up


def _fill(up: Any, network: TaskNetwork, tasks: dict[str, Any], scope: Writer) -> None:
    """Put subtasks, their order and the constraints into a task network of UP."""
    added = [
        up.add_subtask(tasks[subtask.task], *map(scope.term, subtask.arguments), ident=subtask.label)
        for subtask in network.subtasks
    ]
    for first, second in network.ordering:
        up.set_strictly_before(added[first], added[second])
    for constraint in conjuncts(network.constraints):
        up.add_constraint(scope.formula(constraint))


def _metric(problem: Problem, tasks: dict[str, Any], things: Things) -> Any:
    if problem.domain.has_unit_costs:
        return MinimizeSequentialPlanLength()
    costs = {}
    for name, action in problem.domain.actions.items():
        cost = expected_cost(action)
        if cost is not None:
            with _placed(f"the cost of action '{name}'"):
                costs[tasks[name]] = things.scope(action.parameters, tasks[name].parameters).cost(cost)
    return MinimizeActionCosts(costs, default=0)
