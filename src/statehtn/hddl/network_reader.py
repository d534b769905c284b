"""Task networks: subtasks with labels, their order, and constraints on variables."""

from __future__ import annotations

from collections.abc import Iterator

from statehtn.hddl.cycles import find_cycle
from statehtn.hddl.diagnostics import Reporter, unknown
from statehtn.hddl.expressions import Group, Node, Word, describe
from statehtn.hddl.formula_reader import FormulaReader
from statehtn.hddl.sections import Fields
from statehtn.hddl.vocabulary import Scope, Vocabulary
from statehtn.model import TRUE, Subtask, TaskNetwork

UNORDERED = (":subtasks", ":tasks")
ORDERED = (":ordered-subtasks", ":ordered-tasks")
ORDERING = (":ordering", ":order")
NETWORK_KEYWORDS = (*UNORDERED, *ORDERED, *ORDERING, ":constraints")


def read_network(fields: Fields, scope: Scope, vocabulary: Vocabulary, reporter: Reporter) -> TaskNetwork:
    """Return the network that a method or `:htn` states.

    Raises:
        InputError: a task or label is unknown, a label stands twice, or the order is cyclic.
    """
    nodes = list(_conjuncts(fields.get(*UNORDERED, *ORDERED)))
    subtasks = _subtasks(nodes, scope, vocabulary, reporter)
    ordering: dict[tuple[int, int], None] = {}
    if any(keyword in fields.values for keyword in ORDERED):
        ordering = {(i, i + 1): None for i in range(len(subtasks) - 1)}
    order = fields.get(*ORDERING)
    if order is not None:
        ordering |= dict.fromkeys(_pairs(order, subtasks, reporter))
        after: dict[int, list[int]] = {}
        for i, j in ordering:
            after.setdefault(i, []).append(j)
        if cycle := find_cycle(after):
            labels = " < ".join(subtasks[i].label for i in cycle)
            raise reporter.error(f"the ordering of the subtasks is cyclic: {labels}", order)
    constraints = fields.get(":constraints")
    formula = TRUE if constraints is None else FormulaReader(vocabulary, reporter, True).read(constraints, scope)
    return TaskNetwork(subtasks, tuple(ordering), formula)


def _conjuncts(group: Group | None) -> Iterator[Node]:
    """Yield the parts of `(and ...)`, of nothing, or of a single thing."""
    if group is None or not group.items:
        return
    if group.head == "and":
        yield from group.items[1:]
    else:
        yield group


def _subtasks(nodes: list[Node], scope: Scope, vocabulary: Vocabulary, reporter: Reporter) -> tuple[Subtask, ...]:
    parts = [_label_and_task(node, reporter) for node in nodes]
    labels: set[str] = set()
    for label, _ in parts:
        if label is not None:
            if label.text in labels:
                raise reporter.error(f"label '{label.text}' stands twice in one network", label)
            labels.add(label.text)
    fresh = (name for name in map("task{}".format, range(len(parts) + len(labels))) if name not in labels)
    return tuple(
        _subtask(next(fresh) if label is None else label.text, task, scope, vocabulary, reporter)
        for label, task in parts
    )


def _label_and_task(node: Node, reporter: Reporter) -> tuple[Word | None, Group]:
    """Split `(label (task ...))`; a bare `(task ...)` has no label."""
    if isinstance(node, Word):
        raise reporter.error(f"expected a subtask in parentheses, found {describe(node)}", node)
    if not node.items:
        raise reporter.error("expected a subtask, found '()'", node)
    label = node.items[0]
    if isinstance(label, Group):
        raise reporter.error(f"expected a task or a label, found {describe(label)}", label)
    task = node.items[1] if len(node.items) == 2 else None
    if isinstance(task, Group):
        return label, task
    return None, node


def _subtask(label: str, node: Group, scope: Scope, vocabulary: Vocabulary, reporter: Reporter) -> Subtask:
    signature = vocabulary.tasks.get(node.head) or vocabulary.actions.get(node.head)
    if signature is None:
        if not node.head:
            raise reporter.error(f"expected '(<task> <arguments>)', found {describe(node)}", node)
        raise reporter.error(unknown("task", node.head, (*vocabulary.tasks, *vocabulary.actions)), node.items[0])
    kind = "task" if node.head in vocabulary.tasks else "action"
    return Subtask(label, node.head, vocabulary.terms(kind, signature, node, node.items[1:], scope, reporter))


def _pairs(group: Group, subtasks: tuple[Subtask, ...], reporter: Reporter) -> Iterator[tuple[int, int]]:
    """Yield the indices of `(< a b)` and `(> b a)`."""
    index_of = {subtask.label: index for index, subtask in enumerate(subtasks)}
    for node in _conjuncts(group):
        if isinstance(node, Word) or len(node.items) != 3:
            raise reporter.error(f"expected '(< <label> <label>)', found {describe(node)}", node)
        sign, first, second = node.items
        if isinstance(first, Word) and first.text in ("<", ">"):  # (a < b) is written, too
            sign, first = first, sign
        if isinstance(sign, Group) or sign.text not in ("<", ">"):
            raise reporter.error(f"expected '(< <label> <label>)', found {describe(node)}", node)
        before, after = (_index(label, index_of, reporter) for label in (first, second))
        yield (before, after) if sign.text == "<" else (after, before)


def _index(label: Node, index_of: dict[str, int], reporter: Reporter) -> int:
    if isinstance(label, Group):
        raise reporter.error(f"expected a label, found {describe(label)}", label)
    if label.text not in index_of:
        raise reporter.error(unknown("label", label.text, index_of), label)
    return index_of[label.text]
