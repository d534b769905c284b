"""From the core's decomposition tree to a plan of the lifted problem: what was compiled in is taken out again."""

from __future__ import annotations

from operator import itemgetter

import statehtn._relax as _relax
from statehtn.core.grounding import Grounding
from statehtn.model import Decomposition, Plan, Step

Child = tuple[int, int | Decomposition]
"""Which of the lifted method's subtasks it is, and the step of the plan or the decomposition that became of it."""


def read_trace(grounding: Grounding, result: _relax.SearchResult) -> Plan:
    """Return the plan of a search result; the result must have one.

    Artificial actions vanish, and a choice between cases of an action becomes the action.
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

    children: list[list[Child]] = [[] for _ in nodes]
    # Children come after their parents, so that going backwards every node's children are complete.
    for number in range(len(nodes) - 1, -1, -1):
        node = nodes[number]
        if node.parent is None:
            break
        child: int | Decomposition
        if node.method is None:
            if number not in step_of:
                continue
            child = step_of[number]
        elif handle.method_is_choice(node.method):
            if not children[number]:  # a case of a method precondition or the goal
                continue
            child = children[number][0][1]
        else:
            child = _decomposition(grounding, node.task, node.method, children[number])
        parent_method = nodes[node.parent].method
        assert parent_method is not None
        children[node.parent].append((handle.method_positions(parent_method)[node.subtask], child))
    root = nodes[0].method
    assert root is not None
    return Plan(tuple(steps), _in_order(children[0]), grounding.objects(handle.method_arguments(root)))


def _decomposition(grounding: Grounding, task: int, method: int, children: list[Child]) -> Decomposition:
    handle = grounding.handle
    lifted = grounding.encoding.methods[handle.method_schema(method)]
    assert lifted is not None
    arguments = grounding.objects(handle.compound_arguments(task - handle.action_count))
    bindings = grounding.objects(handle.method_arguments(method))
    return Decomposition(lifted.task, arguments, lifted.name, _in_order(children), bindings)


def _in_order(children: list[Child]) -> tuple[int | Decomposition, ...]:
    return tuple(child for _, child in sorted(children, key=itemgetter(0)))
