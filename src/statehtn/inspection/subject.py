"""What is inspected: a domain, perhaps a problem, where their parts stand, and who uses what."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

from statehtn.hddl.source_map import SourceMap
from statehtn.hddl.vocabulary import ANY_TYPE
from statehtn.model import Action, And, Domain, Formula, Method, Problem, Subtask, TaskNetwork


@dataclass(frozen=True)
class Subject:
    """A model that has been read without an error.

    Args:
        domain: the domain.
        problem: None where the domain is inspected alone.
        places: where things stand.
    """

    domain: Domain
    problem: Problem | None
    places: SourceMap

    @cached_property
    def methods_of(self) -> dict[str, list[Method]]:
        """The methods of every compound task, in the order of the file."""
        found: dict[str, list[Method]] = {name: [] for name in self.domain.tasks}
        for method in self.domain.methods.values():
            found[method.task].append(method)
        return found

    @cached_property
    def methods_with(self) -> dict[str, list[Method]]:
        """The methods in whose network a task or an action stands."""
        found: defaultdict[str, list[Method]] = defaultdict(list)
        for method in self.domain.methods.values():
            for task in dict.fromkeys(subtask.task for subtask in method.network.subtasks):
                found[task].append(method)
        return found

    @cached_property
    def initial_tasks(self) -> frozenset[str]:
        """The tasks and actions of the initial network; empty without a problem."""
        return frozenset(subtask.task for subtask in self.problem.network.subtasks) if self.problem else frozenset()

    @property
    def schemas(self) -> Iterator[tuple[str, Action | Method]]:
        """Actions and methods, with the word for them."""
        yield from (("action", action) for action in self.domain.actions.values())
        yield from (("method", method) for method in self.domain.methods.values())

    @cached_property
    def constants_without_declaration(self) -> frozenset[str]:
        """The objects that a domain names and does not declare; only some problem can."""
        return frozenset(name for name, kind in self.domain.constants.items() if kind == ANY_TYPE)


def whole_condition(schema: Action | Method) -> Formula:
    """Return the precondition; of a method with the constraints of its network."""
    if isinstance(schema, Action):
        return schema.precondition
    return And((schema.precondition, schema.network.constraints))


def networks(subject: Subject) -> Iterator[tuple[Method | None, TaskNetwork]]:
    """Yield the networks of the methods, and that of the problem, if there is one."""
    yield from ((method, method.network) for method in subject.domain.methods.values())
    if subject.problem is not None:
        yield None, subject.problem.network


def written(subtask: Subtask) -> tuple[str, ...]:
    """Return the words by which a subtask stands in the file."""
    return (subtask.task, *subtask.arguments)
