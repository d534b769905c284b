"""The states that a plan runs through, stored by what changes."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from heapq import merge

from statehtn.model.problem import Fact


class History:
    """The states of a run: state 0 is the initial one, state t the one after t steps.

    Only changes are stored: for each fact the times at which its truth flips. The last state is a set as well, updated
    in place.

    Args:
        initial_state: the facts that are true at the beginning.
    """

    def __init__(self, initial_state: frozenset[Fact]) -> None:
        self.end = 0
        self.now: set[Fact] = set(initial_state)
        self._initial_state = initial_state
        self._flips: dict[Fact, list[int]] = {}
        self._facts: list[Fact] = list(initial_state)  # every fact that is ever true
        self._indexed = 0  # how many of them stand in the index
        self._index: dict[tuple[str, int, str] | str, list[Fact]] = {}
        self._changes: dict[str, list[int]] = {}

    def advance(self, added: frozenset[Fact], deleted: frozenset[Fact]) -> None:
        """Append the state after a step with these effects; no fact is in both."""
        self.end += 1
        changed = (added - self.now) | (deleted & self.now)
        for fact in changed:
            flips = self._flips.get(fact)
            if flips is None:
                flips = self._flips[fact] = []
                if fact not in self._initial_state:
                    self._facts.append(fact)
            flips.append(self.end)
        self.now ^= changed

    def at(self, time: int, hidden: frozenset[Fact] = frozenset()) -> State:
        """Return a view of one state, in which hidden facts hold, too."""
        return State(self, time, hidden)

    def holds(self, fact: Fact, time: int) -> bool:
        """Tell whether a fact is true in a state."""
        if time == self.end:
            return fact in self.now
        flips = self._flips.get(fact)
        initially = fact in self._initial_state
        return initially if flips is None else initially ^ bool(bisect_right(flips, time) & 1)

    def first_time(self, fact: Fact, wanted: bool, time: int) -> int | None:
        """Return the first time from `time` on at which a fact is true (or false); None if there is none."""
        flips = self._flips.get(fact, ())
        passed = bisect_right(flips, time)
        if (fact in self._initial_state) ^ bool(passed & 1) == wanted:
            return time
        return flips[passed] if passed < len(flips) else None

    def change_times(self, predicates: Iterable[str], after: int, until: int) -> Iterator[int]:
        """Yield the times in `after < time <= until` at which a fact of one of the predicates flips, ascending."""
        last = after
        changes = [self._changes_of(predicate) for predicate in predicates]
        for time in merge(*(_between(times, after, until) for times in changes)):
            if time != last:
                last = time
                yield time

    def _changes_of(self, predicate: str) -> list[int]:
        """Return the times at which a fact of a predicate flips, ascending; asked once the run has ended."""
        if not self._changes:
            found: dict[str, set[int]] = {}
            for fact, flips in self._flips.items():
                found.setdefault(fact[0], set()).update(flips)
            self._changes = {name: sorted(times) for name, times in found.items()}
        return self._changes.get(predicate, [])

    def candidates(self, predicate: str, known: Iterable[tuple[int, str]]) -> list[Fact]:
        """Return facts of a predicate, among them all that are ever true with these objects in these positions.

        Args:
            predicate: the predicate.
            known: pairs (position, object); positions count from 1.
        """
        for fact in self._facts[self._indexed :]:
            self._index.setdefault(fact[0], []).append(fact)
            for position, name in enumerate(fact[1:], 1):
                self._index.setdefault((fact[0], position, name), []).append(fact)
        self._indexed = len(self._facts)
        found = self._index.get(predicate, [])
        for position, name in known:
            found = min(found, self._index.get((predicate, position, name), []), key=len)
        return found


def _between(times: list[int], after: int, until: int) -> Iterator[int]:
    for index in range(bisect_right(times, after), bisect_right(times, until)):
        yield times[index]


@dataclass(frozen=True, slots=True)
class State:
    """One state of a history, and the hidden facts that hold in all of it."""

    history: History
    time: int
    hidden: frozenset[Fact]

    def holds(self, fact: Fact) -> bool:
        """Tell whether a fact is true."""
        return fact in self.hidden or self.history.holds(fact, self.time)

    def candidates(self, predicate: str, known: Iterable[tuple[int, str]]) -> list[Fact]:
        """Return facts of a predicate, among them all that are true with these objects in these positions."""
        found = self.history.candidates(predicate, known)
        return [*found, *(fact for fact in self.hidden if fact[0] == predicate)] if self.hidden else found
