"""What a plan is judged in: the objects and their types, and the limits of the judging."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import TypeVar

from statehtn.limits import Limits
from statehtn.model.formula import is_variable
from statehtn.model.hidden import check_that_costs_alone_read
from statehtn.model.problem import Problem

UNITS = 1024  # of work between two looks at the limits: well below a tenth of a second

Item = TypeVar("Item")


class World:
    """A problem, which of its objects are of which types, and the limits that hold while a plan is judged.

    Raises:
        UnsupportedError: something else than the condition of a cost reads hidden facts.
    """

    def __init__(self, problem: Problem, limits: Limits = Limits()) -> None:
        check_that_costs_alone_read(problem)
        self.problem = problem
        self.limits = limits
        self._members: dict[tuple[str, ...], dict[str, None]] = {}
        self._work = 0

    def work(self) -> None:
        """Count a unit of work; every thousand of them, look at the limits.

        Raises:
            LimitReached: a limit is reached.
        """
        self._work += 1
        if self._work % UNITS == 0:
            self.limits.check()

    def limited(self, items: Sequence[Item]) -> Iterator[Item]:
        """Yield the items, each a unit of work."""
        for start in range(0, len(items), UNITS):
            self.limits.check()
            yield from items[start : start + UNITS]

    def objects(self, types: tuple[str, ...]) -> Mapping[str, None]:
        """Return the objects of any of the types, in order of declaration."""
        found = self._members.get(types)
        if found is None:
            found = self._members[types] = dict.fromkeys(self.problem.objects_of(types))
        return found

    def is_of_type(self, name: str, types: tuple[str, ...]) -> bool:
        """Tell whether an object is of one of the types."""
        return name in self.objects(types)

    def unify(self, terms: tuple[str, ...], objects: tuple[str, ...], bindings: dict[str, str]) -> bool:
        """Bind the variables so that the terms name the objects; false if that contradicts the bindings."""
        return len(terms) == len(objects) and all(
            (bindings.setdefault(term, name) if is_variable(term) else term) == name
            for term, name in zip(terms, objects, strict=True)
        )


def substitute(terms: tuple[str, ...], bindings: Mapping[str, str]) -> tuple[str, ...]:
    """Replace bound variables by their objects."""
    return tuple(bindings.get(term, term) for term in terms)
