"""From the core's decomposition tree to a plan of the lifted problem: what was compiled in is taken out again."""

from __future__ import annotations

from statehtn import _relax
from statehtn.core.grounding import Grounding
from statehtn.model import Decomposition, Plan, Step


def read_trace(grounding: Grounding, result: _relax.SearchResult) -> Plan:
    """Return the plan of a search result; the result must have one.

    Artificial actions vanish, and a choice between cases of an action becomes the action.
    """
    encoding, handle = grounding.encoding, grounding.handle
    nodes = result.decomposition
    action_count = handle.action_count

    steps: list[Step] = []
    step_of: dict[int, int] = {}  # by tree node
    for number in result.plan:
        task = nodes[number].task
        action = encoding.actions[handle.action_schema[task]]
        if action is not None:
            step_of[number] = len(steps)
            steps.append(Step(action.name, grounding.objects(handle.action_arguments(task))))

    children: list[list[tuple[int, int | Decomposition]]] = [[] for _ in nodes]  # (position in the lifted method, child)
    # Children come after their parents, so that going backwards every node's children are complete.
    for number in range(len(nodes) - 1, 0, -1):
        node = nodes[number]
        child: int | Decomposition
        if node.task < action_count:
            if number not in step_of:
                continue
            child = step_of[number]
        elif handle.method_is_choice(node.method):
            child = children[number][0][1]
        else:
            child = _decomposition(grounding, node, children[number])
        position = handle.method_positions(nodes[node.parent].method)[node.subtask]
        children[node.parent].append((position, child))
    root = nodes[0].method
    return Plan(
        tuple(steps), tuple(child for _, child in sorted(children[0], key=_position)), grounding.objects(handle.method_arguments(root))
    )


def _decomposition(
    grounding: Grounding, node: _relax.DecompositionNode, children: list[tuple[int, int | Decomposition]]
) -> Decomposition:
    handle = grounding.handle
    method = grounding.encoding.methods[handle.method_schema[node.method]]
    assert method is not None
    bindings = grounding.objects(handle.method_arguments(node.method))
    return Decomposition(
        method.task,
        grounding.objects(handle.compound_arguments(node.task - handle.action_count)),
        method.name,
        tuple(child for _, child in sorted(children, key=_position)),
        bindings,
    )


def _position(child: tuple[int, int | Decomposition]) -> int:
    return child[0]
