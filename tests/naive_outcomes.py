"""What an action with several outcomes may lead to, spelled out in the plainest way: the judge of the planner."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction

from statehtn.model import TRUE, Fact
from tests.naive_semantics import Bindings, Law, Semantics, State, add


@dataclass(frozen=True)
class Way:
    """What may happen when an action is executed: its probability, the facts that change, the law of its cost then."""

    probability: Fraction
    added: frozenset[Fact]
    deleted: frozenset[Fact]
    law: Law

    def state(self, before: State) -> State:
        return (before - self.deleted) | self.added


def ways(semantics: Semantics, name: str, arguments: tuple[str, ...], state: State) -> list[Way] | None:
    """All that may happen when the action is executed in the state; None if it cannot be executed there.

    Every block is chosen from independently; of all that was chosen together, facts are deleted first, then added.
    """
    action = semantics.domain.actions[name]
    bindings = semantics.bind(action, arguments)
    if bindings is None or not semantics.holds(action.precondition, bindings, state):
        return None
    added, deleted = semantics.changes(action.effects, bindings, state)
    law = semantics.exact_law(name, arguments, state)
    found = [Way(Fraction(1), frozenset(added), frozenset(deleted), law)]
    for block in action.outcomes:
        for more in semantics.all_bindings(block.parameters):
            inner: Bindings = {**bindings, **more}
            if block.condition == TRUE or semantics.holds(block.condition, inner, state):
                chosen = []
                for outcome in block.outcomes:
                    added, deleted = semantics.changes(outcome.effects, inner, state)
                    cost = semantics.law_of(outcome.costs, arguments, inner, state)
                    probability = semantics.value(outcome.probability, inner)
                    chosen.append(Way(probability, frozenset(added), frozenset(deleted), cost))
                rest = 1 - sum((way.probability for way in chosen), Fraction(0))
                assert rest >= 0, (name, arguments, rest)
                chosen.append(Way(rest, frozenset(), frozenset(), {Fraction(0): Fraction(1)}))
                found = [both(one, other) for one in found for other in chosen if other.probability]
    return found


def both(one: Way, other: Way) -> Way:
    return Way(
        one.probability * other.probability,
        one.added | other.added,
        one.deleted | other.deleted,
        add(one.law, other.law),
    )
