"""Finds out which task of a plan stands for which subtask of a method, where the plan lists them in any order."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

from statehtn.model.formula import is_variable
from statehtn.model.plan import Decomposition
from statehtn.model.problem import TaskNetwork

MOST_TRIALS = 100_000  # then the order in the file is as good as any


@dataclass(frozen=True, slots=True)
class Child:
    """A task in a plan: the step or decomposition, its name and arguments, and the first and last steps below it."""

    value: int | Decomposition
    task: str
    arguments: tuple[str, ...]
    first: int | None
    last: int | None


class ChildrenMatcher:
    """Puts the tasks that a plan lists for a network in the order of the network's subtasks.

    The assignment agrees with the subtasks' names, under one binding of variables with their arguments, and, if
    possible, with the network's ordering; the order of the file is kept if it does all that, or if nothing does.

    Args:
        network: the network of a method, or the initial one.
        terms: the arguments of the method's task.
    """

    def __init__(self, network: TaskNetwork, terms: tuple[str, ...] = ()) -> None:
        self._network = network
        self._terms = terms
        self._order = network.topological_order()
        self._predecessors = network.predecessors()

    def match(self, children: Sequence[Child], objects: tuple[str, ...] = ()) -> Sequence[Child]:
        """Return the children in the order of the subtasks; `objects` are what the terms are bound to."""
        if len(children) != len(self._order):
            return children
        bindings = _unify(self._terms, objects, {})
        if bindings is None or self._is_in_order(children, dict(bindings)):
            return children
        file_order = list(range(len(children)))
        by_time = sorted(file_order, key=lambda index: children[index].first or 0)
        for order, ordered in ((by_time, True), (file_order, False)):
            candidates = _candidates(self._network, children, order, bindings)
            search = _Assignment(self._network, self._order, self._predecessors, children, candidates, ordered)
            found = search.find(bindings)
            if found is not None:
                return [children[index] for index in found]
        return children

    def _is_in_order(self, children: Sequence[Child], bindings: dict[str, str]) -> bool:
        """Tell whether each child fits the subtask of its own index; the bindings are extended."""
        ends = [0] * len(children)  # by subtask: the number of steps after which its child has ended
        for index in self._order:
            subtask, child = self._network.subtasks[index], children[index]
            if child.task != subtask.task or len(child.arguments) != len(subtask.arguments):
                return False
            for term, name in zip(subtask.arguments, child.arguments, strict=True):
                if (bindings.setdefault(term, name) if is_variable(term) else term) != name:
                    return False
            start = max([ends[before] for before in self._predecessors[index]], default=0)
            if child.first is not None and child.first < start:
                return False
            ends[index] = start if child.last is None else max(start, child.last + 1)
        return True


def _candidates(
    network: TaskNetwork, children: Sequence[Child], order: Sequence[int], bindings: Mapping[str, str]
) -> list[list[int]]:
    """Return for each subtask the children of its name, and of its arguments where these are known beforehand."""
    by_name: dict[str, list[int]] = {}
    by_arguments: dict[tuple[str, ...], list[int]] = {}
    for index in order:
        child = children[index]
        by_name.setdefault(child.task, []).append(index)
        by_arguments.setdefault((child.task, *child.arguments), []).append(index)
    found = []
    for subtask in network.subtasks:
        arguments = tuple(bindings.get(term, term) for term in subtask.arguments)
        if any(is_variable(term) for term in arguments):
            found.append(by_name.get(subtask.task, []))
        else:
            found.append(by_arguments.get((subtask.task, *arguments), []))
    return found


class _Assignment:
    """Assigns to each subtask a child of its own, by backtracking over the subtasks in topological order.

    Args:
        network: the network with the subtasks.
        order: a topological order of them.
        predecessors: by subtask, those that are ordered before it.
        children: the tasks of the plan.
        candidates: for each subtask the indices of the children to try, in this order.
        ordered: a child may only start when what is ordered before it has ended.
    """

    def __init__(
        self,
        network: TaskNetwork,
        order: list[int],
        predecessors: list[list[int]],
        children: Sequence[Child],
        candidates: list[list[int]],
        ordered: bool,
    ) -> None:
        self._network = network
        self._order = order
        self._predecessors = predecessors
        self._children = children
        self._candidates = candidates
        self._ordered = ordered
        self._ends = [0] * len(self._order)  # by subtask: the number of steps after which its child has ended
        self._used: set[int] = set()
        self._trials = 0

    def find(self, bindings: dict[str, str]) -> list[int] | None:
        """Return the index of each subtask's child; None if there is no assignment, or none is found in time."""
        picks: list[int] = []
        levels: list[Iterator[tuple[int, dict[str, str]]]] = []
        while len(picks) < len(self._order):
            if len(levels) == len(picks):
                levels.append(self._options(self._order[len(picks)], bindings))
            option = next(levels[-1], None)
            if option is not None:
                pick, bindings = option
                picks.append(pick)
                self._used.add(pick)
            else:
                levels.pop()
                if not picks:
                    return None
                self._used.remove(picks.pop())
        chosen = dict(zip(self._order, picks, strict=True))
        return [chosen[index] for index in range(len(picks))]

    def _options(self, index: int, bindings: dict[str, str]) -> Iterator[tuple[int, dict[str, str]]]:
        """Yield the unused children that a subtask can stand for, with the bindings extended by it."""
        subtask = self._network.subtasks[index]
        start = max((self._ends[before] for before in self._predecessors[index]), default=0) if self._ordered else 0
        for candidate in self._candidates[index]:
            self._trials += 1
            if self._trials > MOST_TRIALS:
                return
            child = self._children[candidate]
            if candidate in self._used or child.task != subtask.task:
                continue
            if child.first is not None and child.first < start:
                continue
            extended = _unify(subtask.arguments, child.arguments, bindings)
            if extended is not None:
                self._ends[index] = start if child.last is None else max(start, child.last + 1)
                yield candidate, extended


def _unify(terms: tuple[str, ...], objects: tuple[str, ...], bindings: Mapping[str, str]) -> dict[str, str] | None:
    """Return the bindings extended so that the terms name the objects; None if there is no such extension."""
    if len(terms) != len(objects):
        return None
    extended = dict(bindings)
    for term, name in zip(terms, objects, strict=True):
        if (extended.setdefault(term, name) if is_variable(term) else term) != name:
            return None
    return extended
