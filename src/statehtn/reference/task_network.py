"""Task networks of the reference search: a partially ordered multiset of tasks, and what decomposition does to it."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from statehtn.model.ground import GroundMethod

Identifier = int
"""Tells occurrences of tasks apart; never used twice in the history of a node."""


@dataclass(frozen=True)
class TaskNetwork:
    """Occurrences of tasks, and the transitively closed order of their identifiers: (i, j) where i comes before j."""

    tasks: dict[Identifier, int]
    ordering: frozenset[tuple[Identifier, Identifier]] = frozenset()

    def unconstrained(self) -> list[Identifier]:
        """Return the occurrences that nothing comes before (`findUnconstrainedTasks` of Algorithm 4)."""
        later = {j for _, j in self.ordering}
        return [identifier for identifier in self.tasks if identifier not in later]

    def without(self, identifier: Identifier) -> TaskNetwork:
        """Return the network without a task."""
        tasks = {i: task for i, task in self.tasks.items() if i != identifier}
        return TaskNetwork(tasks, frozenset(pair for pair in self.ordering if identifier not in pair))

    def decomposed(self, identifier: Identifier, method: GroundMethod, first: Identifier) -> TaskNetwork:
        """Return the network with the method's subtasks, numbered from `first`, in the place of a task.

        Source: the paper's definition of decomposition; what was ordered before or after the task is so with all of
        its subtasks.
        """
        subtasks = {first + index: task for index, task in enumerate(method.subtasks)}
        inner = _transitive_closure((first + i, first + j) for i, j in method.ordering)
        rest = self.without(identifier)
        before = {(i, subtask) for i, j in self.ordering if j == identifier for subtask in subtasks}
        after = {(subtask, j) for i, j in self.ordering if i == identifier for subtask in subtasks}
        return TaskNetwork(rest.tasks | subtasks, rest.ordering | before | inner | after)

    def key(self) -> tuple[object, ...]:
        """Return the network without its identifiers.

        Networks with equal keys are isomorphic, since the key lists all tasks with their order. Isomorphic networks may
        have different keys where tasks that look alike were numbered differently; then the search does the work twice.
        """
        before: dict[Identifier, list[int]] = {i: [] for i in self.tasks}
        after: dict[Identifier, list[int]] = {i: [] for i in self.tasks}
        for i, j in self.ordering:
            before[j].append(self.tasks[i])
            after[i].append(self.tasks[j])
        order = sorted(self.tasks, key=lambda i: (self.tasks[i], sorted(before[i]), sorted(after[i])))
        position = {identifier: index for index, identifier in enumerate(order)}
        pairs = frozenset((position[i], position[j]) for i, j in self.ordering)
        return tuple(self.tasks[identifier] for identifier in order), pairs


def _transitive_closure(pairs: Iterable[tuple[Identifier, Identifier]]) -> frozenset[tuple[Identifier, Identifier]]:
    closure = set(pairs)
    while True:
        more = {(i, k) for i, j in closure for middle, k in closure if j == middle} - closure
        if not more:
            return frozenset(closure)
        closure |= more
