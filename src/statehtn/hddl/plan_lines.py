"""The lines of a plan in the IPC 2020 format, before they are a tree."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, field

from statehtn.errors import InputError, Place
from statehtn.hddl.spelling import UNSEEN, Spellings
from statehtn.model.plan import Step
from statehtn.model.problem import Problem

_UNSEEN = re.compile(f"[{UNSEEN}]")
_NO_BRACKETS = str.maketrans("()[],", "     ")
PIECE = 2**16  # characters
TOP_TASK = "__top"  # some planners print the initial network as a method of a task of this name


def lines_of(text: str) -> Iterator[str]:
    """Yield the lines of a text without making all of them at once, which would take no look at any limit."""
    start = 0
    while start < len(text):
        end = text.find("\n", start + PIECE) + 1 or len(text)
        yield from text[start:end].splitlines()
        start = end


class Line:
    """A line of a plan, in words."""

    __slots__ = ("_text", "file", "number", "words")

    def __init__(self, file: str, number: int, text: str) -> None:
        self.file = file
        self.number = number
        self._text = text.translate(_NO_BRACKETS)
        self.words = self._text.split()

    def place(self, index: int = 0) -> Place:
        """Return where a word stands."""
        starts = [match.start() for match in re.finditer(r"\S+", self._text)]
        return Place(self.file, self.number, starts[index] + 1 if starts else 1)

    def number_at(self, index: int) -> int:
        """Return a word that is the number of a task."""
        word = self.words[index]
        if not (word.isascii() and word.isdigit()):
            raise InputError(f"expected the number of a task (0, 1, ...), found '{word}'", self.place(index))
        return int(word)

    def numbers_from(self, index: int) -> list[int]:
        """Return the words to the end of the line as numbers of tasks."""
        return [self.number_at(position) for position in range(index, len(self.words))]

    def place_of(self, number: int) -> Place:
        """Return where the number of a subtask stands."""
        numbers = [index for index, word in enumerate(self.words) if word.isdigit() and int(word) == number]
        return self.place(numbers[-1] if numbers else 0)


@dataclass(slots=True)
class Node:
    """A line of a compound task."""

    line: Line
    task: str
    arguments: tuple[str, ...]
    method: str
    children: list[int]


@dataclass(slots=True)
class Lines:
    """What the lines of a plan say; tasks are called by their numbers."""

    steps: dict[int, Step] = field(default_factory=dict)
    nodes: dict[int, Node] = field(default_factory=dict)
    roots: list[int] = field(default_factory=list)
    root_line: Line | None = None

    def unwrap_top(self) -> None:
        """Replace a root task that is not the domain's by its subtasks."""
        top = self.nodes.get(self.roots[0]) if len(self.roots) == 1 else None
        if top is not None and top.task == TOP_TASK:
            del self.nodes[self.roots[0]]
            self.roots, self.root_line = top.children, top.line

    def children_first(self) -> list[int]:
        """Return the numbers of the compound tasks below the roots, children before parents.

        Raises:
            InputError: a number is unknown or used twice, or a compound task is not below the roots.
        """
        assert self.root_line is not None
        seen: set[int] = set()
        order: list[int] = []
        pending = [(number, self.root_line) for number in reversed(self.roots)]
        while pending:
            number, line = pending.pop()
            if number in seen:
                message = f"task {number} stands in two places of the decomposition; expected one"
                raise InputError(message, line.place_of(number))
            seen.add(number)
            node = self.nodes.get(number)
            if node is not None:
                order.append(number)
                pending += [(child, node.line) for child in reversed(node.children)]
            elif number not in self.steps:
                raise InputError(f"there is no task of number {number} in the plan", line.place_of(number))
        for number, node in self.nodes.items():
            if number not in seen:
                raise InputError(f"task {number} ({node.task}) is not below the root tasks", node.line.place())
        return order[::-1]


class Names:
    """The problem's own spelling of names that a plan may write in other letters; unknown names stay as they are."""

    def __init__(self, problem: Problem) -> None:
        self._tasks = Spellings((*problem.domain.tasks, *problem.domain.actions))
        self._methods = Spellings(problem.domain.methods)
        self._objects = Spellings(problem.all_objects)
        self._steps: dict[tuple[str, ...], Step] = {}

    def task(self, words: tuple[str, ...]) -> Step:
        """Return a task, primitive or not, by the words of its name and its arguments; long plans repeat few."""
        found = self._steps.get(words)
        if found is None:
            name, *arguments = words
            objects = tuple(self._objects.find(word) or word for word in arguments)
            found = self._steps[words] = Step(self._tasks.find(name) or name, objects)
        return found

    def method(self, name: str) -> str:
        """Return the name of a method."""
        return self._methods.find(name) or name

    def is_of_pandapi(self, name: str, is_method: bool = False) -> bool:
        """Tell whether a name is one of those that pandaPI makes up while it compiles and grounds a problem."""
        known = self._methods if is_method else self._tasks
        return name.startswith(("__", "_!", "%", "<")) and not name.startswith(TOP_TASK) and known.find(name) is None


def read_lines(text: str, problem: Problem, file: str) -> Lines:
    """Take the lines between `==>` and `<==` apart.

    Raises:
        InputError: there are none, or one is malformed.
    """
    lines, names = Lines(), Names(problem)
    inside = False
    last = Place(file, 1, 1)
    for number, content in enumerate(lines_of(text), start=1):
        line = Line(file, number, content)
        if not line.words:
            continue
        last = Place(file, number, 1)
        if inside and (found := _UNSEEN.search(content)):
            message = f"the character U+{ord(found[0]):04X} cannot be seen and is a part of no name"
            raise InputError(message, Place(file, number, found.start() + 1))
        if not inside:
            inside = line.words[0] == "==>"
        elif line.words[0] == "<==":
            break
        elif line.words[0].lower() == "root":
            if lines.root_line is not None:
                raise InputError("a second line 'root'; expected one", line.place())
            lines.roots, lines.root_line = line.numbers_from(1), line
        else:
            _read_task(line, lines, names)
    if lines.root_line is None:
        missing = (
            "the plan has no decomposition: expected a line 'root ...'"
            if inside
            else "there is no plan: expected a line '==>'"
        )
        raise InputError(missing, last)
    return lines


def _read_task(line: Line, lines: Lines, names: Names) -> None:
    words = line.words
    number = line.number_at(0)
    if number in lines.steps or number in lines.nodes:
        raise InputError(f"the number {number} stands before two tasks; expected another number", line.place())
    if len(words) < 2:
        raise InputError(f"expected the name of a task after the number {number}", line.place())
    if names.is_of_pandapi(words[1]):
        raise _raw(line, 1)
    if "->" not in words:
        if lines.root_line is not None:
            raise InputError("expected '->' and a method: actions stand before the line 'root'", line.place(1))
        lines.steps[number] = names.task(tuple(words[1:]))
        return
    arrow = words.index("->")
    if arrow < 2 or len(words) < arrow + 2:
        raise InputError("expected '<number> <task> <arguments> -> <method> <numbers>'", line.place(arrow))
    if names.is_of_pandapi(words[arrow + 1], is_method=True):
        raise _raw(line, arrow + 1)
    task, method = names.task(tuple(words[1:arrow])), names.method(words[arrow + 1])
    lines.nodes[number] = Node(line, task.action, task.arguments, method, line.numbers_from(arrow + 2))


def _raw(line: Line, index: int) -> InputError:
    return InputError(
        f"'{line.words[index]}' is a name that the planner pandaPI makes up: this is its raw output, which "
        f"'pandaPIparser -c {line.file} PLAN' turns into a plan",
        line.place(index),
    )
