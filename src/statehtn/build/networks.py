"""Task networks: occurrences of tasks and their order."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from itertools import chain, count, pairwise
from typing import Literal

from statehtn.build.declarations import Declarations, Scope
from statehtn.build.names import Named, new_name, not_declared
from statehtn.build.terms import Term, checked_formula, name_of
from statehtn.errors import UsageError
from statehtn.expected import shown
from statehtn.hddl.cycles import find_cycle
from statehtn.model import And, Equals, Formula, Not, OfType, Or, Subtask, TaskNetwork
from statehtn.model.formula import Combinable


@dataclass(frozen=True, slots=True)
class Occurrence:
    """A task with arguments, as it stands in a network; calling a task makes it."""

    task: str
    terms: tuple[Term, ...]
    label: str | None = None

    def __str__(self) -> str:
        shown = f"({' '.join((self.task, *map(name_of, self.terms)))})"
        return shown if self.label is None else f"({self.label} {shown})"


Ordering = Literal["total"] | Iterable[tuple["Occurrence | str", "Occurrence | str"]]
"""`"total"`: as the subtasks stand; otherwise pairs (before, after) of occurrences, or of their labels."""


def network_of(
    subtasks: Iterable[Occurrence | Iterable[Occurrence]],
    ordering: Ordering,
    constraints: Combinable,
    scope: Scope,
    declared: Declarations,
) -> TaskNetwork:
    """Return the network of some occurrences.

    Raises:
        UsageError: a task, an argument or a label is unknown, a label stands twice, the order is cyclic, or a
            constraint speaks of facts.
    """
    occurrences = _occurrences(subtasks)
    given = [occurrence.label for occurrence in occurrences if occurrence.label is not None]
    taken: Named[None] = Named()
    for label in given:
        if taken.spelling(new_name(label, "label")):
            raise UsageError(f"label '{label}' stands twice in one network (case does not matter)")
        taken[label] = None
    fresh = (name for name in map("task{}".format, count()) if taken.spelling(name) is None)
    found = []
    for occurrence in occurrences:
        signature = declared.signature(occurrence.task)
        if signature is None:
            raise not_declared("task", occurrence.task, (*declared.tasks, *declared.actions))
        arguments = declared.arguments("task", signature, occurrence.terms, scope)
        found.append(Subtask(occurrence.label or next(fresh), occurrence.task, arguments))
    formula = checked_formula(constraints, "'constraints'")
    _check_constraint(formula)
    declared.check_formula(formula, scope)
    return TaskNetwork(tuple(found), _pairs(ordering, occurrences, found), formula)


def _occurrences(subtasks: Iterable[Occurrence | Iterable[Occurrence]]) -> tuple[Occurrence, ...]:
    listed = ([given] if isinstance(given, str) or not isinstance(given, Iterable) else given for given in subtasks)
    found = tuple(chain.from_iterable(listed))
    for occurrence in found:
        if not isinstance(occurrence, Occurrence):
            hint = "; call the task with its arguments" if callable(occurrence) else ""
            raise UsageError(f"expected a task with its arguments, such as drive(a, b), found {occurrence!r}{hint}")
    return found


def _check_constraint(formula: Formula) -> None:
    match formula:
        case Not(operand):
            _check_constraint(operand)
        case And(operands) | Or(operands):
            for operand in operands:
                _check_constraint(operand)
        case Equals() | OfType():
            pass
        case _:
            raise UsageError(
                f"a constraint speaks of variables only (equal() and OfType), found {formula}; "
                f"facts belong in a precondition"
            )


def _pairs(
    ordering: Ordering, occurrences: Sequence[Occurrence], subtasks: Sequence[Subtask]
) -> tuple[tuple[int, int], ...]:
    if ordering == "total":
        return tuple(pairwise(range(len(subtasks))))
    if isinstance(ordering, str) or not isinstance(ordering, Iterable):
        raise UsageError(f"an ordering is 'total' or pairs of subtasks, found {shown(ordering)}")
    pairs = tuple(dict.fromkeys(_indices(ordering, occurrences, subtasks)))
    after: dict[int, list[int]] = {}
    for i, j in pairs:
        after.setdefault(i, []).append(j)
    if cycle := find_cycle(after):
        raise UsageError(f"the ordering is cyclic: {' < '.join(str(occurrences[i]) for i in cycle)}")
    return pairs


def _indices(
    ordering: Iterable[tuple[Occurrence | str, Occurrence | str]],
    occurrences: Sequence[Occurrence],
    subtasks: Sequence[Subtask],
) -> Iterator[tuple[int, int]]:
    for pair in ordering:
        if not isinstance(pair, tuple | list) or len(pair) != 2:
            raise UsageError(f"an ordering has pairs (before, after) of subtasks or labels, found {pair!r}")
        before, after = (_index(item, occurrences, subtasks) for item in pair)
        yield before, after


def _index(item: object, occurrences: Sequence[Occurrence], subtasks: Sequence[Subtask]) -> int:
    """Return the place of an occurrence: of this very object, or else of the only equal one."""
    if isinstance(item, str):
        labels = [subtask.label for subtask in subtasks]
        if item not in labels:
            raise not_declared("label", item, labels)
        return labels.index(item)
    same = [i for i, occurrence in enumerate(occurrences) if occurrence is item]
    equal = same or [i for i, occurrence in enumerate(occurrences) if occurrence == item]
    if len(equal) != 1:
        where = "is not in this network" if not equal else "stands more than once in this network; give it a label"
        raise UsageError(f"the ordering names {item}, which {where}")
    return equal[0]
