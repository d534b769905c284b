"""Plans with their decompositions in the format of the International Planning Competition 2020.

    ==>
    0 start av                                   actions in the order of execution: a number, the name, the arguments
    1 stop av
    root 2                                       the numbers of the initial network's tasks
    2 travel av -> drive-there 0 1               a compound task -> its method and the numbers of the method's subtasks
    <==

Source: G. Behnke et al., the plan format of the IPC 2020 track on hierarchical planning, as pandaPIparser verifies it.
"""

from __future__ import annotations

from collections.abc import Sequence

from statehtn.collector import without_collector
from statehtn.expected import expect
from statehtn.hddl.plan_lines import Lines, read_lines
from statehtn.hddl.plan_matching import Child, ChildrenMatcher
from statehtn.model.expect import expect_plan, expect_problem
from statehtn.model.plan import Decomposition, Plan, Step
from statehtn.model.problem import Problem


def write_plan(plan: Plan, problem: Problem) -> str:
    """Return a plan in the IPC 2020 format; subtasks stand in a topological order of their network.

    Args:
        plan: the plan; each of its steps belongs to one place in the decomposition.
        problem: the problem that it solves.
    """
    expect_plan(plan)
    expect_problem(problem)
    texts: dict[Step, str] = {}  # a long plan repeats few ground actions
    for step in plan.steps:
        if step not in texts:
            texts[step] = " ".join((step.action, *step.arguments))
    nodes = list(plan.decompositions())
    numbers = {id(node): str(number) for number, node in enumerate(nodes, len(plan.steps))}
    orders: dict[str, list[int]] = {}

    def listed(children: tuple[int | Decomposition, ...], order: list[int]) -> list[str]:
        found = [children[index] for index in order] if len(order) == len(children) else children
        return [str(child) if isinstance(child, int) else numbers[id(child)] for child in found]

    lines = ["==>", *(f"{number} {texts[step]}" for number, step in enumerate(plan.steps))]
    lines.append(" ".join(("root", *listed(plan.roots, problem.network.topological_order()))))
    for node in nodes:
        if node.method not in orders:
            method = problem.domain.methods.get(node.method)
            orders[node.method] = method.network.topological_order() if method else []
        subtasks = listed(node.children, orders[node.method])
        lines.append(" ".join((numbers[id(node)], node.task, *node.arguments, "->", node.method, *subtasks)))
    return "\n".join([*lines, "<==", ""])


def read_plan(text: str, problem: Problem, file: str = "<plan>") -> Plan:
    """Read a plan in the IPC 2020 format, as any planner prints it.

    Blank lines, text before `==>` and after `<==` (which may be missing), and brackets around arguments do not matter;
    nor does the case of letters, the order of the decompositions, or that of the subtasks: they are matched with the
    method's subtasks by their names, arguments and order. Names that the problem does not have are left for the
    validator to report. The bindings of methods are not part of the format (None in the result). A raw plan of the
    planner pandaPI, which speaks of its own ground names, is an error that says how to make a plan of it.

    Args:
        text: the output of a planner.
        problem: the problem that the plan is for.
        file: what to call the text in errors.

    Raises:
        InputError: the text holds no plan, a line is malformed, or the numbers do not make a tree.
    """
    expect(text, str, "the plan must be a text in the IPC 2020 format", "write_plan(plan, problem) makes one")
    expect_problem(problem)
    with without_collector():
        lines = read_lines(text, problem, file)
        lines.unwrap_top()
        order = lines.children_first()
        return _Builder(lines, problem).build(order)


class _Builder:
    """Builds a plan from its lines, children before parents."""

    def __init__(self, lines: Lines, problem: Problem) -> None:
        self._lines = lines
        self._problem = problem
        self._built: dict[int, Child] = {}
        for index, (number, step) in enumerate(lines.steps.items()):
            self._built[number] = Child(index, step.action, step.arguments, index, index)

    def build(self, children_first: list[int]) -> Plan:
        """Return the plan."""
        problem, lines, built = self._problem, self._lines, self._built
        matchers: dict[str, ChildrenMatcher] = {}
        for number in children_first:
            node = lines.nodes[number]
            children: Sequence[Child] = [built[child] for child in node.children]
            method = problem.domain.methods.get(node.method)
            if method is not None and method.task == node.task and len(method.arguments) == len(node.arguments):
                if method.name not in matchers:
                    matchers[method.name] = ChildrenMatcher(method.network, method.arguments)
                children = matchers[method.name].match(children, node.arguments)
            subtree = Decomposition(node.task, node.arguments, node.method, tuple([child.value for child in children]))
            first = min([child.first for child in children if child.first is not None], default=None)
            last = max([child.last for child in children if child.last is not None], default=None)
            built[number] = Child(subtree, node.task, node.arguments, first, last)
        roots = ChildrenMatcher(problem.network).match([built[number] for number in lines.roots or []])
        return Plan(
            tuple(lines.steps.values()),
            tuple(child.value for child in roots),
            None if problem.parameters else (),
        )
