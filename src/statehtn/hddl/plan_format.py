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
from dataclasses import dataclass, field

from statehtn.errors import InputError, Place
from statehtn.expected import expect
from statehtn.hddl.plan_matching import Child, ChildrenMatcher, topological_order
from statehtn.hddl.spelling import Spellings
from statehtn.model.expect import expect_plan, expect_problem
from statehtn.model.plan import Decomposition, Plan, Step
from statehtn.model.problem import Problem

TOP_TASK = "__top"  # some planners print the initial network as a method of a task of this name


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
    lines.append(" ".join(("root", *listed(plan.roots, topological_order(problem.network)))))
    for node in nodes:
        if node.method not in orders:
            method = problem.domain.methods.get(node.method)
            orders[node.method] = topological_order(method.network) if method else []
        subtasks = listed(node.children, orders[node.method])
        lines.append(" ".join((numbers[id(node)], node.task, *node.arguments, "->", node.method, *subtasks)))
    return "\n".join([*lines, "<==", ""])


def read_plan(text: str, problem: Problem, file: str = "<plan>") -> Plan:
    """Read a plan in the IPC 2020 format, as any planner prints it.

    Blank lines, text before `==>` and after `<==` (which may be missing), and brackets around arguments do not matter;
    nor does the case of letters, the order of the decompositions, or that of the subtasks: they are matched with the
    method's subtasks by their names, arguments and order. Names that the problem does not have are left for the
    validator to report. The bindings of methods are not part of the format (None in the result).

    Args:
        text: the output of a planner.
        problem: the problem that the plan is for.
        file: what to call the text in errors.

    Raises:
        InputError: the text holds no plan, a line is malformed, or the numbers do not make a tree.
    """
    expect(text, str, "the plan must be a text in the IPC 2020 format", "write_plan(plan, problem) makes one")
    expect_problem(problem)
    lines = _read_lines(text, _Names(problem), file)
    lines.unwrap_top()
    order = lines.children_first()
    return _Builder(lines, problem).build(order)


@dataclass(slots=True)
class _Node:
    """A line of a compound task."""

    place: Place
    task: str
    arguments: tuple[str, ...]
    method: str
    children: list[int]


@dataclass(slots=True)
class _Lines:
    """What the lines of a plan say; tasks are called by their numbers."""

    file: str
    steps: dict[int, Step] = field(default_factory=dict)
    nodes: dict[int, _Node] = field(default_factory=dict)
    roots: list[int] | None = None
    root_place: Place | None = None

    def unwrap_top(self) -> None:
        """Replace an artificial root task by its subtasks."""
        if self.roots is not None and len(self.roots) == 1:
            top = self.nodes.get(self.roots[0])
            if top is not None and top.task == TOP_TASK:
                del self.nodes[self.roots[0]]
                self.roots, self.root_place = top.children, top.place

    def children_first(self) -> list[int]:
        """Return the numbers of the compound tasks below the roots, children before parents.

        Raises:
            InputError: a number is unknown or used twice, or a compound task is not below the roots.
        """
        roots, root_place = self.roots or [], self.root_place
        seen: set[int] = set()
        order: list[int] = []
        pending = [(number, root_place) for number in reversed(roots)]
        while pending:
            number, place = pending.pop()
            if number in seen:
                raise InputError(f"task {number} stands in two places of the decomposition; expected one", place)
            seen.add(number)
            node = self.nodes.get(number)
            if node is not None:
                order.append(number)
                pending += [(child, node.place) for child in reversed(node.children)]
            elif number not in self.steps:
                raise InputError(f"there is no task of number {number} in the plan", place)
        for number, node in self.nodes.items():
            if number not in seen:
                raise InputError(f"task {number} ({node.task}) is not below the root tasks", node.place)
        return order[::-1]


class _Names:
    """The problem's own spelling of names that a plan may write in other letters; unknown names stay as they are."""

    def __init__(self, problem: Problem) -> None:
        self._tasks = Spellings((*problem.domain.tasks, *problem.domain.actions))
        self._methods = Spellings(problem.domain.methods)
        self._objects = Spellings(problem.all_objects)

    def task(self, name: str, *arguments: str) -> tuple[str, tuple[str, ...]]:
        """Return the name of a task and those of its arguments."""
        return self._tasks.find(name) or name, tuple(self._objects.find(word) or word for word in arguments)

    def method(self, name: str) -> str:
        """Return the name of a method."""
        return self._methods.find(name) or name


_NO_BRACKETS = str.maketrans("()[],", "     ")


def _read_lines(text: str, names: _Names, file: str) -> _Lines:
    """Take the lines between `==>` and `<==` apart."""
    lines = _Lines(file)
    inside = False
    place = Place(file, 1, 1)
    for number, line in enumerate(text.splitlines(), start=1):
        words = line.translate(_NO_BRACKETS).split()
        if not words:
            continue
        place = Place(file, number, len(line) - len(line.lstrip()) + 1)
        if not inside:
            inside = words[0] == "==>"
        elif words[0] == "<==":
            break
        elif words[0].lower() == "root":
            if lines.roots is not None:
                raise InputError("a second line 'root'; expected one", place)
            lines.roots, lines.root_place = [_number(word, place) for word in words[1:]], place
        else:
            _read_task(words, lines, names, place)
    if lines.roots is None:
        missing = (
            "the plan has no decomposition: expected a line 'root ...'"
            if inside
            else "there is no plan: expected a line '==>'"
        )
        raise InputError(missing, place)
    return lines


def _read_task(words: list[str], lines: _Lines, names: _Names, place: Place) -> None:
    number = _number(words[0], place)
    if number in lines.steps or number in lines.nodes:
        raise InputError(f"the number {number} stands before two tasks; expected another number", place)
    if "->" not in words:
        if len(words) < 2:
            raise InputError(f"expected the name of a task after the number {number}", place)
        if lines.roots is not None:
            raise InputError("expected '->' and a method: actions stand before the line 'root'", place)
        lines.steps[number] = Step(*names.task(*words[1:]))
        return
    arrow = words.index("->")
    if arrow < 2 or len(words) < arrow + 2:
        raise InputError("expected '<number> <task> <arguments> -> <method> <numbers>'", place)
    children = [_number(word, place) for word in words[arrow + 2 :]]
    lines.nodes[number] = _Node(place, *names.task(*words[1:arrow]), names.method(words[arrow + 1]), children)


def _number(word: str, place: Place) -> int:
    if not (word.isascii() and word.isdigit()):
        raise InputError(f"expected the number of a task (0, 1, ...), found '{word}'", place)
    return int(word)


class _Builder:
    """Builds a plan from its lines, children before parents."""

    def __init__(self, lines: _Lines, problem: Problem) -> None:
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
