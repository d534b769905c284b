"""Names on both sides: what is called what in unified-planning (UP), where any string is a name, and in HDDL."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from itertools import chain, count
from typing import Any

from statehtn.build.names import WORDS
from statehtn.hddl.cost_reader import TOTAL_COST
from statehtn.hddl.spelling import NOT_IN_NAMES, Spellings
from statehtn.model import Problem
from statehtn.model.types import ROOT_TYPE


class Names:
    """Pairs of names of one kind; every name has one partner on the other side."""

    def __init__(self) -> None:
        self._ours: dict[str, str] = {}
        self._theirs: dict[str, str] = {}

    def pair(self, ours: str, theirs: str) -> None:
        """Let two names stand for the same thing."""
        self._ours[theirs] = ours
        self._theirs[ours] = theirs

    def ours(self, theirs: str) -> str:
        """Return the name here of what UP calls so."""
        return self._ours[theirs]

    def theirs(self, ours: str) -> str:
        """Return UP's name of what is called so here."""
        return self._theirs[ours]

    def knows(self, theirs: str) -> bool:
        """Tell whether UP has something of this name."""
        return theirs in self._ours


@dataclass(frozen=True, slots=True)
class Vocabulary:
    """The names of a problem on both sides: `tasks` of actions, too, `fluents` of predicates and functions."""

    types: Names = field(default_factory=Names)
    fluents: Names = field(default_factory=Names)
    tasks: Names = field(default_factory=Names)
    methods: Names = field(default_factory=Names)
    objects: Names = field(default_factory=Names)
    up_types: list[Any] = field(default_factory=list)
    """UP's types, those of variables that are met later included: UP does not list them, and they have no objects."""

    def our_type(self, kind: Any) -> str:
        """Return the name here of a type of objects in UP."""
        if not self.types.knows(kind.name):
            if kind.father is not None:
                self.our_type(kind.father)
            self.types.pair(our_name(kind.name, self._taken_types()), kind.name)
            self.up_types.append(kind)
        return self.types.ours(kind.name)

    def _taken_types(self) -> Spellings:
        return Spellings((ROOT_TYPE, *map(self.our_type, self.up_types)))


def our_name(theirs: str, taken: Spellings) -> str:
    """Return a name that HDDL can write, as similar as can be, and that is not taken: UP distinguishes case."""
    name = NOT_IN_NAMES.sub("_", theirs.lstrip("?:-")).strip(":-") or "unnamed"
    candidates = chain([name], (f"{name}-{number}" for number in count(2)))
    return next(one for one in candidates if taken.find(one) is None and one.lower() not in WORDS)


def vocabulary_of_up(problem: Any) -> Vocabulary:
    """Return the names for the things of a UP problem; a type `object` above all others is ours of that name."""
    vocabulary = Vocabulary()
    roots = [kind for kind in problem.user_types if kind.father is None]
    if [kind.name for kind in roots] == [ROOT_TYPE]:
        vocabulary.types.pair(ROOT_TYPE, ROOT_TYPE)
    for kind in problem.user_types:
        vocabulary.our_type(kind)
    for names, things in (
        (vocabulary.fluents, problem.fluents),
        (vocabulary.tasks, [*problem.actions, *problem.tasks]),
        (vocabulary.methods, problem.methods),
        (vocabulary.objects, problem.all_objects),
    ):
        taken = Spellings((TOTAL_COST,) if names is vocabulary.fluents else ())
        for thing in things:
            name = our_name(thing.name, taken)
            taken.add((name,))
            names.pair(name, thing.name)
    return vocabulary


def vocabulary_of(problem: Problem) -> Vocabulary:
    """Return UP's names for the things of a problem: their own, with their kind added where two have one name.

    UP has one namespace for all. What plans speak of keeps its name first.
    """
    domain = problem.domain
    vocabulary = Vocabulary()
    taken: set[str] = set()
    kinds: Iterator[tuple[Names, str, list[str]]] = iter(
        (
            (vocabulary.tasks, "action", list(domain.actions)),
            (vocabulary.tasks, "task", list(domain.tasks)),
            (vocabulary.objects, "object", list(problem.all_objects)),
            (vocabulary.methods, "method", list(domain.methods)),
            (vocabulary.fluents, "predicate", list(domain.predicates)),
            (vocabulary.fluents, "function", list(domain.functions)),
            (vocabulary.types, "type", [ROOT_TYPE, *domain.types.parents]),
        )
    )
    for names, kind, ours in kinds:
        for name in ours:
            candidates = chain([name, f"{name}-{kind}"], (f"{name}-{kind}-{number}" for number in count(2)))
            theirs = next(candidate for candidate in candidates if candidate not in taken)
            taken.add(theirs)
            names.pair(name, theirs)
    return vocabulary
