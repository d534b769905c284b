"""What is decided by chance before a plan begins, from Python objects."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from fractions import Fraction
from typing import Any

from statehtn.build.declarations import Declarations, Scope
from statehtn.errors import UsageError
from statehtn.expected import shown_number
from statehtn.model import And, Atom, Fact
from statehtn.model.chance import Chance, Outcome
from statehtn.model.cost.blocks import PROBABILITY_TOLERANCE, exact


def chance_of(outcomes: Iterable[Any], declared: Declarations) -> Chance:
    """Return a chance with these outcomes: pairs (probability, facts); see `ProblemBuilder.initially_by_chance`.

    Raises:
        UsageError: a pair or a fact is none, a probability is negative, or they do not sum to 1.
    """
    found: dict[frozenset[Fact], Fraction] = {}
    for outcome in outcomes:
        if not isinstance(outcome, tuple | list) or len(outcome) != 2:
            raise UsageError(f"expected a pair (probability, facts) such as (0.3, snow()), found {outcome!r}")
        probability, facts = exact(outcome[0]), frozenset(_facts(outcome[1], declared))
        if probability < 0:
            raise UsageError(f"a probability must not be negative, found {float(probability):g}")
        found[facts] = found.get(facts, Fraction(0)) + probability
    total = sum(found.values(), Fraction(0))
    if abs(total - 1) > PROBABILITY_TOLERANCE:
        raise UsageError(f"the probabilities of a chance must sum to 1, found {shown_number(total)}")
    return Chance(tuple(Outcome(weight / total, facts) for facts, weight in found.items() if weight))


def _facts(given: object, declared: Declarations) -> Iterator[Fact]:
    parts = given.operands if isinstance(given, And) else given if isinstance(given, tuple | list) else (given,)
    for part in parts:
        if not isinstance(part, Atom):
            raise UsageError(f"a hidden fact is an atom such as snow(), found {part!r}; () stands for none")
        declared.check_formula(part, Scope())
        yield (part.predicate, *part.arguments)
