"""From the core's decomposition tree to a plan of the lifted problem: what was compiled in is taken out again."""

from __future__ import annotations

from dataclasses import dataclass, field
from operator import itemgetter

import statehtn._relax as _relax
from statehtn.core.grounding import Grounding
from statehtn.core.schemes import Scheme
from statehtn.model import Decomposition, Plan, Step


@dataclass
class _Application:
    """A scheme that was applied, and what has become of it: the lifted method's subtasks with their positions."""

    scheme: Scheme
    bindings: dict[str, str]
    children: list[tuple[int, int | Decomposition]] = field(default_factory=list)

    def add(self, index: int, child: int | _Application) -> None:
        """Add what has become of the scheme's subtask of this index; a part of the same method is taken up."""
        if isinstance(child, _Application) and child.scheme.is_part:
            self.bindings |= child.bindings
            self.children += child.children
            return
        position = self.scheme.subtasks[index].position
        assert position is not None
        self.children.append((position, child.decomposition() if isinstance(child, _Application) else child))

    def decomposition(self) -> Decomposition:
        """Return the decomposition by the whole method, once everything is there."""
        scheme, method = self.scheme, self.scheme.method
        assert method is not None
        arguments = tuple(self.bindings.get(term, term) for term in scheme.arguments)
        bindings = tuple(self.bindings[parameter.name] for parameter in method.parameters)
        return Decomposition(scheme.task, arguments, method.name, self.in_order(), bindings)

    def in_order(self) -> tuple[int | Decomposition, ...]:
        """Return the children in the order of the lifted network."""
        return tuple(child for _, child in sorted(self.children, key=itemgetter(0)))


def read_trace(grounding: Grounding, result: _relax.SearchResult) -> Plan:
    """Return the plan of a search result; the result must have one.

    Artificial actions vanish, a choice between cases of an action becomes the action, and methods that were split or
    applied at once stand as in the domain.
    """
    handle, nodes = grounding.handle, result.decomposition
    actions, schemas = grounding.encoding.actions, handle.action_schema
    steps: list[Step] = []
    step_of: dict[int, int] = {}  # by tree node
    for number in result.plan:
        task = nodes[number].task
        action = actions[schemas[task]]
        if action is not None:
            step_of[number] = len(steps)
            steps.append(Step(action.name, grounding.objects(handle.action_arguments(task))))

    children: list[list[tuple[int, int | _Application]]] = [[] for _ in nodes]  # with the subtask's index
    # Children come after their parents, so that going backwards every node's children are complete.
    for number in range(len(nodes) - 1, 0, -1):
        node = nodes[number]
        assert node.parent is not None
        if node.method is None:
            if number in step_of:
                children[node.parent].append((node.subtask, step_of[number]))
        elif parts := range(*handle.method_parts(node.method)):
            children[node.parent].append((node.subtask, _apply(grounding, node.method, parts, children[number])))
        else:  # a choice; nothing is left of it where the chosen case is artificial
            children[node.parent] += ((node.subtask, child) for _, child in children[number])
    initial = nodes[0].method
    assert initial is not None
    root = _apply(grounding, initial, range(*handle.method_parts(initial)), children[0])
    parameters = grounding.problem.parameters
    return Plan(tuple(steps), root.in_order(), tuple(root.bindings[parameter.name] for parameter in parameters))


def _apply(
    grounding: Grounding, method: int, parts: range, children: list[tuple[int, int | _Application]]
) -> _Application:
    """Return what the parts of a ground method, and what has become of its subtasks, make together."""
    handle = grounding.handle
    applications = []
    for part in parts:
        scheme = grounding.encoding.schemes[handle.part_schema(part)]
        names = (parameter.name for parameter in scheme.parameters)
        objects = grounding.objects(handle.part_arguments(part))
        applications.append(_Application(scheme, dict(zip(names, objects, strict=True))))
    positions = handle.method_positions(method)
    for subtask, child in children:
        part, index = positions[subtask]
        applications[part].add(index, child)
    # Parts come after the parts whose subtasks they decompose.
    for number in range(len(applications) - 1, 0, -1):
        parent, index = handle.part_origin(parts[number])
        applications[parent].add(index, applications[number])
    return applications[0]
