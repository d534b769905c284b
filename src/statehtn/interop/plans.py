"""Plans with decompositions, here and in unified-planning (UP)."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

from unified_planning.plans import ActionInstance, HierarchicalPlan, SequentialPlan
from unified_planning.plans.hierarchical_plan import Decomposition as UpDecomposition
from unified_planning.plans.hierarchical_plan import MethodInstance

from statehtn.counted import with_article
from statehtn.errors import InputError, UsageError
from statehtn.interop.names import Vocabulary
from statehtn.model import Decomposition, Plan, Step

Child = int | Decomposition


def write_up_plan(plan: Plan, problem: Any, names: Vocabulary) -> HierarchicalPlan:
    """Return a plan as one of UP, for UP's form of the problem.

    UP's plans do not tell the objects of the initial network's variables; they are lost.

    Raises:
        UsageError: the plan does not tell the arguments of its methods, as one that was read from a file.
    """
    manager = problem.environment.expression_manager

    def objects(ours: Iterable[str]) -> tuple[Any, ...]:
        return tuple(manager.ObjectExp(problem.object(names.objects.theirs(name))) for name in ours)

    actions = [
        ActionInstance(problem.action(names.tasks.theirs(step.action)), objects(step.arguments)) for step in plan.steps
    ]
    methods: dict[int, MethodInstance] = {}

    def decomposition(subtasks: Iterable[Any], children: Iterable[Child]) -> UpDecomposition:
        return UpDecomposition(
            {
                subtask.identifier: actions[child] if isinstance(child, int) else methods[id(child)]
                for subtask, child in zip(subtasks, children, strict=True)
            }
        )

    for node in reversed(list(plan.decompositions())):  # children first
        if node.bindings is None:
            raise UsageError("the plan does not tell the arguments of its methods; take one that statehtn.plan returns")
        method = problem.method(names.methods.theirs(node.method))
        below = decomposition(method.subtasks, node.children)
        methods[id(node)] = MethodInstance(method, objects(node.bindings), below)
    return HierarchicalPlan(SequentialPlan(actions), decomposition(problem.task_network.subtasks, plan.roots))


def read_up_plan(plan: Any, problem: Any, names: Vocabulary) -> Plan:
    """Return a hierarchical plan of UP as one of ours; the objects of the initial network's variables stay open.

    The actions of its decomposition are those of its sequence, as the same Python objects; where they are not, they are
    taken to be in the order of the decomposition.

    Raises:
        UsageError: it is no hierarchical plan over a sequence of actions.
        InputError: it is of another problem, or its decomposition misses something.
    """
    if not isinstance(plan, HierarchicalPlan) or not isinstance(plan.action_plan, SequentialPlan):
        found = with_article(type(plan).__name__)
        raise UsageError(f"expected a HierarchicalPlan over a SequentialPlan, found {found}")
    try:
        return _Reader(plan, problem, names).read()
    except KeyError as error:
        raise InputError(f"the plan has {error}, which the problem does not know") from None


class _Reader:
    def __init__(self, plan: HierarchicalPlan, problem: Any, names: Vocabulary) -> None:
        self.plan = plan
        self.problem = problem
        self.names = names
        self.steps = tuple(self._step(action) for action in plan.action_plan.actions)
        self.positions = {id(action): position for position, action in enumerate(plan.action_plan.actions)}
        same = {id(instance) for _, instance in plan.actions()}
        self.others = [p for p, action in enumerate(plan.action_plan.actions) if id(action) not in same]

    def read(self) -> Plan:
        pending = [self.plan.decomposition]
        found: list[Any] = []
        while pending:
            for below in pending.pop().subtasks.values():
                if isinstance(below, MethodInstance):
                    found.append(below)
                    pending.append(below.decomposition)
        for _, action in self.plan.actions():
            if id(action) not in self.positions:
                self.positions[id(action)] = self._claim(self._step(action))
        methods: dict[int, Decomposition] = {}
        for instance in reversed(found):  # children first
            method = self.problem.method(instance.method.name)
            task = method.achieved_task
            bindings = self._objects(instance.parameters)
            if len(bindings) != len(method.parameters):
                raise InputError(f"method '{method.name}' has {len(method.parameters)} parameters, found {instance}")
            values = dict(zip((one.name for one in method.parameters), bindings, strict=True))
            methods[id(instance)] = Decomposition(
                self.names.tasks.ours(task.task.name),
                tuple(values[parameter.name] for parameter in task.parameters),
                self.names.methods.ours(method.name),
                self._children(method.subtasks, instance.decomposition.subtasks, methods),
                bindings,
            )
        roots = self._children(self.problem.task_network.subtasks, self.plan.decomposition.subtasks, methods)
        return Plan(self.steps, roots, None if self.problem.task_network.variables else ())

    def _children(
        self, subtasks: Iterable[Any], below: Mapping[str, Any], methods: Mapping[int, Decomposition]
    ) -> tuple[Child, ...]:
        children: list[Child] = []
        for subtask in subtasks:
            if subtask.identifier not in below:
                raise InputError(f"the plan's decomposition has nothing for subtask '{subtask.identifier}'")
            one = below[subtask.identifier]
            children.append(methods[id(one)] if isinstance(one, MethodInstance) else self.positions[id(one)])
        return tuple(children)

    def _step(self, action: Any) -> Step:
        return Step(self.names.tasks.ours(action.action.name), self._objects(action.actual_parameters))

    def _objects(self, terms: Iterable[Any]) -> tuple[str, ...]:
        return tuple(self.names.objects.ours(term.object().name) for term in terms)

    def _claim(self, step: Step) -> int:
        """Return the position of an equal action that no other one of the decomposition is."""
        for position in self.others:
            if self.steps[position] == step:
                self.others.remove(position)
                return position
        raise InputError(f"the plan's decomposition has an action {step} that its sequence has not")
