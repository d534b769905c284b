"""Matches a plan's decomposition with the lifted methods: which network stands where, and under which bindings."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass, field

from statehtn.model.formula import TRUE, Formula
from statehtn.model.plan import Decomposition, Plan
from statehtn.model.problem import Method, TaskNetwork
from statehtn.model.types import Parameter
from statehtn.validate.execution import wrong_arguments
from statehtn.validate.formulas import is_satisfiable
from statehtn.validate.world import History, World, substitute


@dataclass(frozen=True, slots=True)
class MatchedNetwork:
    """A lifted network and the part of the decomposition that stands for it.

    Args:
        title: what to call it in a message.
        parameters: its variables.
        children: what the plan has in the place of its subtasks.
        precondition: the method's.
        bindings: the objects of its variables, as far as the plan tells.
    """

    title: str
    parameters: tuple[Parameter, ...]
    network: TaskNetwork
    children: tuple[int | Decomposition, ...]
    precondition: Formula = TRUE
    bindings: dict[str, str] = field(default_factory=dict)

    @property
    def unbound(self) -> tuple[Parameter, ...]:
        """The variables that nothing in the plan binds: any objects do that satisfy constraints and precondition."""
        return tuple(parameter for parameter in self.parameters if parameter.name not in self.bindings)


@dataclass(frozen=True, slots=True)
class Matching:
    """The initial network and those of all compound nodes (by `id` of the node), and what is wrong with them."""

    root: MatchedNetwork
    nodes: dict[int, MatchedNetwork]
    reasons: tuple[str, ...]


def match_networks(plan: Plan, world: World, history: History) -> Matching:
    """Match every node of the decomposition with its method, and check that the nodes use every step exactly once."""
    problem = world.problem
    root = MatchedNetwork("the initial network", problem.parameters, problem.network, plan.roots)
    reasons = list(_bind(root, plan.root_bindings, plan, world, history))
    nodes: dict[int, MatchedNetwork] = {}
    used = Counter(child for child in plan.roots if isinstance(child, int))
    for node in plan.decompositions():
        used.update(child for child in node.children if isinstance(child, int))
        method = _method_of(node, world)
        if isinstance(method, str):
            reasons.append(method)
            continue
        title = f"method '{node.method}' of {_text(node.task, node.arguments)}"
        matched = MatchedNetwork(title, method.parameters, method.network, node.children, method.precondition)
        if not world.unify(method.arguments, node.arguments, matched.bindings):
            reasons.append(f"{title}: the method is for {_text(method.task, method.arguments)}")
            continue
        reasons += _bind(matched, node.bindings, plan, world, history)
        nodes[id(node)] = matched
    reasons += _usage(plan, used)
    return Matching(root, nodes, tuple(reasons))


def _method_of(node: Decomposition, world: World) -> Method | str:
    """Return the node's method if the task and the method are right for each other, otherwise why they are not."""
    title = f"task {_text(node.task, node.arguments)}"
    task = world.problem.domain.tasks.get(node.task)
    if task is None:
        return f"{title}: there is no compound task '{node.task}'"
    wrong = wrong_arguments(task.parameters, node.arguments, world)
    if wrong:
        return f"{title}: {wrong}"
    method = world.problem.domain.methods.get(node.method)
    if method is None:
        return f"{title}: there is no method '{node.method}'"
    if method.task != node.task:
        return f"{title}: method '{node.method}' is for task '{method.task}'"
    return method


def _bind(
    matched: MatchedNetwork, given: tuple[str, ...] | None, plan: Plan, world: World, history: History
) -> Iterator[str]:
    """Bind the network's variables by what the plan says of them, and yield what is wrong.

    The plan tells them by the task's arguments (bound before), by the given bindings and by the children's arguments.
    """
    title, bindings = matched.title, matched.bindings
    if given is not None:
        wrong = wrong_arguments(matched.parameters, given, world)
        if wrong:
            yield f"{title}: its bindings are wrong: {wrong}"
        elif not world.unify(tuple(parameter.name for parameter in matched.parameters), given, bindings):
            yield f"{title}: its bindings ({' '.join(given)}) contradict the task's arguments"
    yield from _bind_children(matched, plan, world)
    for parameter in matched.parameters:
        value = bindings.get(parameter.name)
        if value is not None and not world.is_of_type(value, parameter.types):
            yield f"{title}: {parameter.name} is '{value}', which is not of the type of {parameter}"
    if not is_satisfiable(matched.network.constraints, matched.unbound, bindings, history.at(0), world):
        values = ", ".join(f"{variable} = {value}" for variable, value in bindings.items())
        yield f"{title}: its constraints do not hold for {values or 'any objects'}"


def _bind_children(matched: MatchedNetwork, plan: Plan, world: World) -> Iterator[str]:
    title, subtasks, children = matched.title, matched.network.subtasks, matched.children
    if len(children) != len(subtasks):
        yield f"{title}: expected {len(subtasks)} subtasks, found {len(children)}"
    for subtask, child in zip(subtasks, children, strict=False):
        expected = _text(subtask.task, substitute(subtask.arguments, matched.bindings))
        if isinstance(child, int) and not 0 <= child < len(plan.steps):
            yield f"{title}: for subtask {expected} there is no step {child + 1}; the plan has {len(plan.steps)} steps"
            continue
        if isinstance(child, int):
            task, arguments, fits = plan.steps[child].action, plan.steps[child].arguments, "action"
        else:
            task, arguments, fits = child.task, child.arguments, "compound"
        kind = "action" if subtask.task in world.problem.domain.actions else "compound"
        if (task, fits) != (subtask.task, kind) or not world.unify(subtask.arguments, arguments, matched.bindings):
            yield f"{title}: expected subtask {expected}, found {_text(task, arguments)}"


def _usage(plan: Plan, used: Counter[int]) -> Iterator[str]:
    for index, step in enumerate(plan.steps):
        if used[index] != 1:
            times = f"stands {used[index]} times in" if used[index] else "is not part of"
            yield f"step {index + 1} {step}: it {times} the decomposition; it must stand there exactly once"


def _text(name: str, arguments: tuple[str, ...]) -> str:
    return f"({' '.join((name, *arguments))})"
