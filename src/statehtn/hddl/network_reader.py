"""Task networks: subtasks with labels, their order, and constraints on variables."""

from __future__ import annotations

import re
from collections.abc import Iterator
from itertools import count, pairwise

from statehtn.hddl.cycles import find_cycle
from statehtn.hddl.diagnostics import Reporter, unknown
from statehtn.hddl.expressions import Group, Node, Word, consumed, describe
from statehtn.hddl.formula_reader import FormulaReader
from statehtn.hddl.sections import Fields, is_empty
from statehtn.hddl.tokens import shortened
from statehtn.hddl.vocabulary import Scope, Vocabulary, words
from statehtn.model import TRUE, Subtask, TaskNetwork

UNORDERED = (":subtasks", ":tasks")
ORDERED = (":ordered-subtasks", ":ordered-tasks")
ORDERING = (":ordering", ":order")
CAUSAL_LINKS = (":causal-links", ":causallinks")
_WITHOUT_SPACES = re.compile(r"(?P<first>[<>])? ?(?P<left>[^<> ]+) ?(?(first) |(?P<middle>[<>])) ?(?P<right>[^<> ]+)")
NETWORK_KEYWORDS = (*UNORDERED, *ORDERED, *ORDERING, ":constraints", *CAUSAL_LINKS)


def read_network(fields: Fields, scope: Scope, vocabulary: Vocabulary, reporter: Reporter) -> TaskNetwork:
    """Return the network that a method or `:htn` states.

    Raises:
        InputError: a task or label is unknown, a label stands twice, or the order is cyclic.
    """
    subtasks = _subtasks(fields.get(*UNORDERED, *ORDERED), scope, vocabulary, reporter)
    is_chain = any(keyword in fields.values for keyword in ORDERED)
    ordering = tuple(pairwise(range(len(subtasks)))) if is_chain else ()
    order = fields.get(*ORDERING)
    if order is not None:
        ordering = tuple(dict.fromkeys((*ordering, *_pairs(order, subtasks, reporter))))
        after: dict[int, list[int]] = {}
        for i, j in ordering:
            after.setdefault(i, []).append(j)
        if cycle := find_cycle(after):
            labels = " < ".join(subtasks[i].label for i in cycle)
            raise reporter.error(f"the ordering of the subtasks is cyclic: {labels}", order)
    constraints = fields.get(":constraints")
    formula = TRUE if constraints is None else FormulaReader(vocabulary, reporter, True).read(constraints, scope)
    links = fields.get(*CAUSAL_LINKS)
    if links is not None and not is_empty(links):
        reporter.warn("causal links are not a part of HTN planning and are ignored", links)
    return TaskNetwork(subtasks, ordering, formula)


def _conjuncts(group: Group | None) -> Iterator[Node]:
    """Yield the parts of `(and ...)`, of nothing, or of a single thing."""
    if group is not None and group.items:
        yield from group.items[1:] if group.head == "and" else (group,)


def _subtasks(group: Group | None, scope: Scope, vocabulary: Vocabulary, reporter: Reporter) -> tuple[Subtask, ...]:
    labels: set[str] = set()
    for node in _conjuncts(group):
        label, _ = _label_and_task(node, reporter)
        if label is not None:
            if label.lower in labels:
                raise reporter.error(f"label '{label.text}' stands twice in one network", label)
            labels.add(label.lower)
    fresh = (name for name in map("task{}".format, count()) if name not in labels)
    found = []
    for node in consumed(group) if group is not None and group.head == "and" else _conjuncts(group):
        label, task = _label_and_task(node, reporter)
        name = next(fresh) if label is None else label.text
        found.append(_subtask(name, task, scope, vocabulary, reporter))
    return tuple(found)


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
    signature = vocabulary.task(node.name)
    if signature is None:
        if not node.name:
            raise reporter.error(f"expected '(<task> <arguments>)', found {describe(node)}", node)
        raise reporter.error(unknown("task", node.name, (*vocabulary.tasks, *vocabulary.actions)), node.items[0])
    kind = "task" if signature.name in vocabulary.tasks else "action"
    return Subtask(label, signature.name, vocabulary.terms(kind, signature, node, node.items[1:], scope, reporter))


def _pairs(group: Group, subtasks: tuple[Subtask, ...], reporter: Reporter) -> Iterator[tuple[int, int]]:
    """Yield the indices of `(< a b)`, `(a < b)` and `(> b a)`."""
    index_of = {subtask.label.lower(): index for index, subtask in enumerate(subtasks)}
    for node in _conjuncts(group):
        if not isinstance(node, Group):
            raise reporter.error(f"expected '(< <label> <label>)', found {describe(node)}", node)
        if not node.items:
            continue
        sign, first, second = _comparison(node, reporter)
        before, after = (_index(label, index_of, reporter) for label in (first, second))
        yield (before, after) if sign == "<" else (after, before)


def _comparison(node: Group, reporter: Reporter) -> tuple[str, Word, Word]:
    """Return the sign of a comparison and the labels to its left and right."""
    labels = [item for item in words(node.items, "a label", reporter) if item.text not in ("<", ">")]
    signs = [item.text for item in words(node.items[:2], "a label", reporter) if item.text in ("<", ">")]
    if len(signs) == 1 and len(labels) == 2 and len(node.items) == 3:
        return signs[0], labels[0], labels[1]
    text = " ".join(item.text for item in words(node.items, "a label", reporter))
    match = _WITHOUT_SPACES.fullmatch(text)
    if match is None:
        raise reporter.error(f"expected '(< <label> <label>)', found {describe(node)}", node)
    reporter.warn(f"expected '(< <label> <label>)' with spaces, found '({shortened(text)})'", node)
    sign = match["first"] or match["middle"]
    return sign, Word(match["left"], node.index), Word(match["right"], node.index)


def _index(label: Word, index_of: dict[str, int], reporter: Reporter) -> int:
    if label.lower not in index_of:
        raise reporter.error(unknown("label", label.text, index_of), label)
    return index_of[label.lower]
