"""What is decided by chance before a plan begins and is never seen: hidden facts, and the scenarios that they make."""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from fractions import Fraction

from statehtn.errors import UnsupportedError
from statehtn.model.formula import Fact

MOST_SCENARIOS = 256
"""Of a problem: combinations of the outcomes of all that is decided by chance."""


@dataclass(frozen=True, slots=True)
class Outcome:
    """One way in which a chance turns out.

    Args:
        probability: above 0, exactly as written.
        facts: the hidden facts that hold then, as ground atoms.
        name: in results; None for the facts themselves.
    """

    probability: Fraction
    facts: frozenset[Fact] = frozenset()
    name: str | None = field(default=None, compare=False)


@dataclass(frozen=True, slots=True)
class Chance:
    """One thing that is decided by chance: exactly one of its outcomes, whose probabilities sum to 1.

    Different chances are independent. Source: the probabilistic initial state of PPDDL (Younes and Littman, *PPDDL1.0*,
    2004).
    """

    outcomes: tuple[Outcome, ...]

    @property
    def facts(self) -> frozenset[Fact]:
        """The facts that it decides."""
        return frozenset().union(*(outcome.facts for outcome in self.outcomes))


@dataclass(frozen=True, slots=True)
class Scenario:
    """What all chances of a problem may turn out to be together.

    Args:
        name: the hidden facts that hold, or what their outcomes are called.
        probability: of this scenario.
        facts: the hidden facts that hold in it.
    """

    name: str
    probability: float
    facts: frozenset[Fact]

    def __str__(self) -> str:
        return self.name


def scenario_count(chances: Sequence[Chance]) -> int:
    """Return how many combinations of outcomes there are."""
    return math.prod(len(chance.outcomes) for chance in chances)


def scenarios_of(chances: Sequence[Chance]) -> tuple[Scenario, ...]:
    """Return the combinations of one outcome of each chance, those with the same facts as one; none without chances.

    Raises:
        UnsupportedError: there are more than `MOST_SCENARIOS`.
    """
    if not chances:
        return ()
    if (count := scenario_count(chances)) > MOST_SCENARIOS:
        raise UnsupportedError(too_many(count))
    found: dict[frozenset[Fact], tuple[str, Fraction]] = {}
    for outcomes in itertools.product(*(chance.outcomes for chance in chances)):
        facts = frozenset().union(*(outcome.facts for outcome in outcomes))
        names = [name for outcome in outcomes for name in _names(outcome)]
        probability = math.prod((outcome.probability for outcome in outcomes), start=Fraction(1))
        name, before = found.get(facts, (" ".join(names) or "no hidden fact", Fraction(0)))
        found[facts] = name, before + probability
    return tuple(Scenario(name, float(weight), facts) for facts, (name, weight) in found.items())


def too_many(count: int) -> str:
    """Return the message that there are more scenarios than are supported."""
    return f"what is decided by chance makes {count} scenarios, and at most {MOST_SCENARIOS} are supported"


def _names(outcome: Outcome) -> list[str]:
    if outcome.name is not None:
        return [outcome.name]
    return [f"({' '.join(fact)})" for fact in sorted(outcome.facts)]
