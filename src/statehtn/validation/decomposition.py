"""Matches a plan's decomposition with the lifted methods: which network stands where, and under which bindings.

A long plan repeats few ground methods: each is matched once. What a match depends on is the node's task, its method,
the given bindings, and the tasks of its children.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from statehtn.counted import counted
from statehtn.model.formula import TRUE, And, Formula
from statehtn.model.plan import Decomposition, Step
from statehtn.model.problem import Method, TaskNetwork
from statehtn.model.types import Parameter
from statehtn.semantics.actions import wrong_arguments
from statehtn.semantics.condition import NOWHERE, Condition, GroundCondition
from statehtn.semantics.world import World, substitute
from statehtn.validation.tree import PlanTree


class LiftedNetwork:
    """A method or the initial network, with its formulas compiled and its order prepared.

    Args:
        parameters: its variables.
        network: its tasks.
        precondition: the method's.
        world: the objects and their types.
    """

    def __init__(
        self, parameters: tuple[Parameter, ...], network: TaskNetwork, precondition: Formula, world: World
    ) -> None:
        self.parameters = parameters
        self.subtasks = network.subtasks
        self.constraints = Condition(network.constraints, world)
        self.precondition = None if precondition == TRUE else Condition(And((network.constraints, precondition)), world)
        self.predecessors = network.predecessors()
        self.order = network.topological_order()


@dataclass(frozen=True, slots=True)
class MatchedNetwork:
    """A ground network that stands in the decomposition, perhaps in many places.

    Args:
        title: what to call it in a message.
        lifted: what it is an instance of.
        bindings: the objects of its variables, as far as the plan tells.
        unbound: the variables that nothing in the plan binds: any objects do that satisfy constraints and precondition.
        precondition: what it needs before its first subtask, where no variable is unbound; None where there is nothing.
        reasons: what is wrong with it.
    """

    title: str
    lifted: LiftedNetwork
    bindings: dict[str, str]
    unbound: tuple[Parameter, ...]
    precondition: GroundCondition | None
    reasons: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Matching:
    """The network of every node of the tree, where it has one, and what is wrong with them."""

    networks: list[MatchedNetwork | None]
    reasons: tuple[str, ...]


def match_networks(tree: PlanTree, world: World) -> Matching:
    """Match every node of the decomposition with its method, and check that the nodes use every step exactly once."""
    return _Matcher(tree, world).run()


class _Matcher:
    def __init__(self, tree: PlanTree, world: World) -> None:
        self.tree = tree
        self.world = world
        self.lifted: dict[str, LiftedNetwork] = {}

    def run(self) -> Matching:
        tree = self.tree
        tasks: dict[tuple[str, tuple[str, ...]] | Step, int] = {}
        of_steps = [tasks.setdefault(step, len(tasks)) for step in tree.plan.steps]
        of_steps.append(-1)  # of a step that the plan does not have
        of_nodes = [tasks.setdefault((node.task, node.arguments), len(tasks)) if node else -1 for node in tree.nodes]
        known: dict[tuple[object, ...], MatchedNetwork | str] = {}
        networks: list[MatchedNetwork | None] = []
        reasons: list[str] = []
        for number, node in enumerate(self.world.limited(tree.nodes)):
            children = tree.children[number]
            below = [of_steps[child] if child >= 0 else of_nodes[~child] for child in children]
            matched: MatchedNetwork | str | None
            if node is None:
                matched = self.match_root()
            else:
                key = (of_nodes[number], node.method, node.bindings, *below)
                matched = known.get(key)
                if matched is None:
                    matched = self.match(node)
                    if -1 not in below:  # messages tell the numbers of missing steps
                        known[key] = matched
            if isinstance(matched, str):
                reasons.append(matched)
                networks.append(None)
            else:
                reasons += matched.reasons
                networks.append(matched)
        return Matching(networks, (*reasons, *self.usage()))

    def match_root(self) -> MatchedNetwork:
        """Match the initial network."""
        problem, plan = self.world.problem, self.tree.plan
        lifted = LiftedNetwork(problem.parameters, problem.network, TRUE, self.world)
        return self.bind("the initial network", lifted, {}, plan.root_bindings, plan.roots)

    def match(self, node: Decomposition) -> MatchedNetwork | str:
        """Match a compound node with its method; if they are not right for each other, say why."""
        method = self.method_of(node)
        if isinstance(method, str):
            return method
        title = f"method '{node.method}' of {_text(node.task, node.arguments)}"
        bindings: dict[str, str] = {}
        if not self.world.unify(method.arguments, node.arguments, bindings):
            return f"{title}: the method is for {_text(method.task, method.arguments)}"
        lifted = self.lifted.get(method.name)
        if lifted is None:
            lifted = LiftedNetwork(method.parameters, method.network, method.precondition, self.world)
            self.lifted[method.name] = lifted
        return self.bind(title, lifted, bindings, node.bindings, node.children)

    def method_of(self, node: Decomposition) -> Method | str:
        """Return the node's method if the task and the method are right for each other, otherwise why they are not."""
        title = f"task {_text(node.task, node.arguments)}"
        domain = self.world.problem.domain
        task = domain.tasks.get(node.task)
        if task is None:
            return f"{title}: there is no compound task '{node.task}'"
        wrong = wrong_arguments(task.parameters, node.arguments, self.world)
        if wrong:
            return f"{title}: {wrong}"
        method = domain.methods.get(node.method)
        if method is None:
            return f"{title}: there is no method '{node.method}'"
        if method.task != node.task:
            return f"{title}: method '{node.method}' is for task '{method.task}'"
        return method

    def bind(
        self,
        title: str,
        lifted: LiftedNetwork,
        bindings: dict[str, str],
        given: tuple[str, ...] | None,
        children: tuple[int | Decomposition, ...],
    ) -> MatchedNetwork:
        """Bind the network's variables by what the plan says of them, and find what is wrong.

        The plan tells them by the task's arguments (`bindings`), by the given bindings and by the children's arguments.
        """
        reasons = [
            *self.given_bindings(title, lifted, bindings, given),
            *self.bind_children(title, lifted, bindings, children),
        ]
        for parameter in lifted.parameters:
            value = bindings.get(parameter.name)
            if value is not None and not self.world.is_of_type(value, parameter.types):
                reasons.append(f"{title}: {parameter.name} is '{value}', which is not of the type of {parameter}")
        unbound = tuple(parameter for parameter in lifted.parameters if parameter.name not in bindings)
        if not lifted.constraints.is_satisfiable(unbound, bindings, NOWHERE):
            values = ", ".join(f"{variable} = {value}" for variable, value in bindings.items())
            reasons.append(f"{title}: its constraints do not hold for {values or 'any objects'}")
        is_ground = lifted.precondition is not None and not unbound
        precondition = lifted.precondition.ground(bindings) if lifted.precondition and is_ground else None
        return MatchedNetwork(title, lifted, bindings, unbound, precondition, tuple(reasons))

    def given_bindings(
        self, title: str, lifted: LiftedNetwork, bindings: dict[str, str], given: tuple[str, ...] | None
    ) -> Iterator[str]:
        """Bind the variables as the plan says explicitly; yield what is wrong with that."""
        if given is None:
            return
        wrong = wrong_arguments(lifted.parameters, given, self.world)
        if wrong:
            yield f"{title}: its bindings are wrong: {wrong}"
        elif not self.world.unify(tuple(parameter.name for parameter in lifted.parameters), given, bindings):
            yield f"{title}: its bindings ({' '.join(given)}) contradict the task's arguments"

    def bind_children(
        self,
        title: str,
        lifted: LiftedNetwork,
        bindings: dict[str, str],
        children: tuple[int | Decomposition, ...],
    ) -> Iterator[str]:
        """Bind the variables by the arguments of the children; yield what is wrong with them."""
        steps, actions = self.tree.plan.steps, self.world.problem.domain.actions
        if len(children) != len(lifted.subtasks):
            yield f"{title}: expected {len(lifted.subtasks)} subtasks, found {len(children)}"
        for subtask, child in zip(lifted.subtasks, children, strict=False):
            expected = _text(subtask.task, substitute(subtask.arguments, bindings))
            if isinstance(child, int) and not 0 <= child < len(steps):
                there_are = counted(len(steps), "step")
                yield f"{title}: for subtask {expected} there is no step {child + 1}; the plan has {there_are}"
                continue
            if isinstance(child, int):
                task, arguments, fits = steps[child].action, steps[child].arguments, subtask.task in actions
            else:
                task, arguments, fits = child.task, child.arguments, subtask.task not in actions
            if task != subtask.task or not fits or not self.world.unify(subtask.arguments, arguments, bindings):
                yield f"{title}: expected subtask {expected}, found {_text(task, arguments)}"

    def usage(self) -> Iterator[str]:
        """Yield what is wrong with how often the steps stand in the decomposition."""
        steps = self.tree.plan.steps
        used = [0] * (len(steps) + 1)
        for children in self.tree.children:
            for child in children:
                if child >= 0:
                    used[child] += 1
        for index, step in enumerate(steps):
            if used[index] != 1:
                times = f"stands {used[index]} times in" if used[index] else "is not part of"
                yield f"step {index + 1} {step}: it {times} the decomposition; it must stand there exactly once"


def _text(name: str, arguments: tuple[str, ...]) -> str:
    return f"({' '.join((name, *arguments))})"
