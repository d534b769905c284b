"""The outline of a policy: its actions and what they may lead to, where equal ways to go on are one."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from statehtn.counted import letters
from statehtn.display.policy_classes import Way, classes_of
from statehtn.display.policy_words import OTHERWISE, Changes, budget, conditions, cost_text
from statehtn.model.plan import Step
from statehtn.model.policy_graph import End, PolicyGraph

MOST_NODES = 50_000
"""Of a policy that is outlined; larger ones are not to be read."""


@dataclass(frozen=True, slots=True)
class Choice:
    """What may come of an action.

    Args:
        condition: how it is told from the others; empty where there is no other.
        probability: of it, where what was spent does not matter; None where it depends on that.
        place: the index of the way to go on.
        rest: the probability of all others together; None where it is not known.
    """

    condition: str
    probability: float | None
    place: int
    rest: float | None = None


@dataclass(frozen=True, slots=True)
class Place:
    """A way to go on: an action and what may come of it, or an end.

    Args:
        step: the action; None at an end.
        cost: what it costs, in words.
        end: why a run is over here; None where it goes on.
        choices: what may come of the action.
    """

    step: Step | None
    cost: str
    end: End | None
    choices: tuple[Choice, ...]


@dataclass(frozen=True, slots=True)
class Outline:
    """The ways to go on; the first is where runs begin."""

    places: tuple[Place, ...]

    def shared(self) -> dict[int, str]:
        """Return names of the places that several choices lead to, but for ends: A, B, .., in the order of reading."""
        known: dict[int, int] = {0: 0}
        order: list[int] = []
        pending = [0]
        visited: set[int] = set()
        while pending:
            place = pending.pop()
            if place in visited:
                continue
            visited.add(place)
            order.append(place)
            for choice in reversed(self.places[place].choices):
                known[choice.place] = known.get(choice.place, 0) + 1
                pending.append(choice.place)
        named = (p for p in order if self.places[p].end is None and known[p] > (1 if p else 0))
        return {place: letters(index) for index, place in enumerate(named)}


def outline(graph: PolicyGraph) -> Outline:
    """Return the outline of a policy: what stands for decompositions and preconditions alone is left out."""
    return _Outliner(graph).outline()


class _Outliner:
    def __init__(self, graph: PolicyGraph) -> None:
        self.graph = graph
        self.begin = graph.nodes[0].left
        self.ways: dict[int, list[Way]] = {}
        self.start = self._next(0)
        pending = [self.start]
        while pending:
            node = pending.pop()
            if node in self.ways:
                continue
            decision = graph.nodes[node].decision
            branches = () if decision is None else decision.branches
            self.ways[node] = [Way(b, self._next(b.successor), self._spent(b.successor)) for b in branches]
            pending += [way.target for way in self.ways[node]]

    def outline(self) -> Outline:
        """Return equal nodes as one place each."""
        classes = classes_of(self.graph, self.ways, by_cost=False)
        if not self._has_thresholds(classes):
            classes = classes_of(self.graph, self.ways, by_cost=True)
        members: dict[int, list[int]] = {}
        for node, name in classes.items():
            members.setdefault(name, []).append(node)
        first = classes[self.start]
        places = {name: place for place, name in enumerate([first, *(name for name in members if name != first)])}
        return Outline(tuple(self._place(members[name], classes, places) for name in places))

    def _next(self, node: int) -> int:
        """Return the next node at which an action of the domain is executed, or a run ends."""
        passed: set[int] = set()
        while (decision := self.graph.nodes[node].decision) is not None and decision.action is None:
            if node in passed or len(decision.branches) != 1:
                break
            passed.add(node)
            node = decision.branches[0].successor
        return node

    def _spent(self, node: int) -> float | None:
        left = self.graph.nodes[node].left
        return None if left is None or self.begin is None else self.begin - left

    def _has_thresholds(self, classes: dict[int, int]) -> bool:
        """Tell whether amounts spent tell the ways apart at each class: those of one lie below those of the next."""
        spent: dict[tuple[int, Changes], dict[int, list[float]]] = {}
        for node, ways in self.ways.items():
            for way in ways:
                key = classes[node], (way.branch.added, way.branch.deleted)
                if way.spent is not None:
                    spent.setdefault(key, {}).setdefault(classes[way.target], []).append(way.spent)
        return all(_are_apart(groups.values()) for groups in spent.values())

    def _place(self, members: Sequence[int], classes: dict[int, int], places: dict[int, int]) -> Place:
        node = self.graph.nodes[members[0]]
        step = None if node.decision is None else node.decision.action
        outcomes: dict[Changes, dict[int, list[Way]]] = {}
        for member in members:
            for way in self.ways[member]:
                changes = way.branch.added, way.branch.deleted
                outcomes.setdefault(changes, {}).setdefault(classes[way.target], []).append(way)
        is_one = len({classes[way.target] for ways in outcomes.values() for some in ways.values() for way in some}) == 1
        texts = conditions(list(outcomes))
        own = {id(way) for way in self.ways[members[0]]}
        choices: list[Choice] = []
        for changes, groups in outcomes.items():
            ordered = sorted(groups.items(), key=lambda group: min(way.spent or 0.0 for way in group[1]))
            limits = [max(way.spent or 0.0 for way in ways) for _, ways in ordered]
            for rank, (name, ways) in enumerate(ordered):
                amount = budget(rank, limits) if len(ordered) > 1 else ""
                condition = ", ".join(part for part in (texts[changes], amount) if part)
                probability = math.fsum(way.branch.probability for way in ways if id(way) in own)
                is_fixed = len(members) == 1 or len(ordered) == 1
                choices.append(Choice("" if is_one else condition, probability if is_fixed else None, places[name]))
        merged = _merged(choices)
        return Place(step, cost_text([way.branch for way in self.ways[members[0]]]), node.end, merged)


def _are_apart(groups: Iterable[Sequence[float]]) -> bool:
    ranges = sorted((min(amounts), max(amounts)) for amounts in groups)
    return all(high < low for (_, high), (low, _) in itertools.pairwise(ranges))


def _merged(choices: Sequence[Choice]) -> tuple[Choice, ...]:
    """Return choices that lead to one place as one, in the order of their first choices; what is left comes last."""
    groups: dict[int, list[Choice]] = {}
    for choice in choices:
        groups.setdefault(choice.place, []).append(choice)
    found = []
    for place, some in groups.items():
        known = [choice.probability for choice in some if choice.probability is not None]
        probability = math.fsum(known) if len(known) == len(some) else None
        others = [choice.probability for choice in choices if choice.place != place]
        rest = math.fsum(p for p in others if p is not None) if None not in others else None
        conditions_of = dict.fromkeys(choice.condition for choice in some)
        condition = OTHERWISE if OTHERWISE in conditions_of else " or ".join(conditions_of)
        found.append(Choice(condition, probability, place, rest))
    return tuple(sorted(found, key=lambda choice: choice.condition == OTHERWISE))
