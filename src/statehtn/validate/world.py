"""What a plan is judged in: the objects and their types, and the states that the plan runs through."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass

from statehtn.model.formula import is_variable
from statehtn.model.problem import Fact, Problem


class World:
    """A problem, and which of its objects are of which types."""

    def __init__(self, problem: Problem) -> None:
        self.problem = problem
        self._members: dict[tuple[str, ...], frozenset[str]] = {}

    def objects(self, types: tuple[str, ...]) -> tuple[str, ...]:
        """Return the objects of any of the types, in order of declaration."""
        return self.problem.objects_of(types)

    def is_of_type(self, name: str, types: tuple[str, ...]) -> bool:
        """Tell whether an object is of one of the types."""
        if types not in self._members:
            self._members[types] = frozenset(self.objects(types))
        return name in self._members[types]

    def unify(self, terms: tuple[str, ...], objects: tuple[str, ...], bindings: dict[str, str]) -> bool:
        """Bind the variables so that the terms name the objects; false if that contradicts the bindings."""
        return len(terms) == len(objects) and all(
            (bindings.setdefault(term, name) if is_variable(term) else term) == name
            for term, name in zip(terms, objects, strict=True)
        )


def substitute(terms: tuple[str, ...], bindings: Mapping[str, str]) -> tuple[str, ...]:
    """Replace bound variables by their objects."""
    return tuple(bindings.get(term, term) for term in terms)


class History:
    """The states of a run: state 0 is the initial one, state t the one after t steps.

    Only changes are stored: for each fact the times at which its truth flips.
    """

    def __init__(self, initial_state: frozenset[Fact]) -> None:
        self._initial_state = initial_state
        self._flips: dict[Fact, list[int]] = {}
        self._facts: dict[str, dict[Fact, None]] = {}  # by predicate, every fact that is ever true, in a fixed order
        self._changes: dict[str, list[int]] = {}  # by predicate, the times at which one of its facts flips, ascending
        self.end = 0
        for fact in sorted(initial_state):
            self._facts.setdefault(fact[0], {})[fact] = None

    def advance(self, added: Iterable[Fact], deleted: Iterable[Fact]) -> None:
        """Append the state after a step with these effects; adding wins over deleting."""
        before = self.at(self.end)
        adding = dict.fromkeys(added)
        flips = [fact for fact in adding if not before.holds(fact)]
        flips += [fact for fact in dict.fromkeys(deleted) if fact not in adding and before.holds(fact)]
        self.end += 1
        for fact in flips:
            self._flips.setdefault(fact, []).append(self.end)
            self._facts.setdefault(fact[0], {})[fact] = None
            changes = self._changes.setdefault(fact[0], [])
            if not changes or changes[-1] != self.end:
                changes.append(self.end)

    def at(self, time: int) -> State:
        """Return a view of one state."""
        return State(self, time)

    def change_times(self, predicates: Iterable[str], after: int, until: int) -> list[int]:
        """Return the times in `after < time <= until` at which a fact of one of the predicates flips, ascending."""
        times: set[int] = set()
        for predicate in predicates:
            changes = self._changes.get(predicate, [])
            times.update(changes[bisect_right(changes, after) : bisect_right(changes, until)])
        return sorted(times)

    def holds(self, fact: Fact, time: int) -> bool:
        """Tell whether a fact is true in a state."""
        flips = self._flips.get(fact)
        initially = fact in self._initial_state
        return initially if flips is None else initially ^ bool(bisect_right(flips, time) & 1)

    def facts_of(self, predicate: str, time: int) -> Iterator[Fact]:
        """Yield the true facts of a predicate in a state."""
        return (fact for fact in self._facts.get(predicate, ()) if self.holds(fact, time))


@dataclass(frozen=True, slots=True)
class State:
    """One state of a history."""

    history: History
    time: int

    def holds(self, fact: Fact) -> bool:
        """Tell whether a fact is true."""
        return self.history.holds(fact, self.time)

    def facts_of(self, predicate: str) -> Iterator[Fact]:
        """Yield the true facts of a predicate."""
        return self.history.facts_of(predicate, self.time)
