"""Disutilities of several sums in exact arithmetic, and random ones: for tests of what the core makes of them."""

from __future__ import annotations

import decimal
from collections.abc import Sequence
from dataclasses import dataclass
from decimal import Decimal
from fractions import Fraction

import statehtn._relax as _relax
from statehtn.core.grounding import Grounding, ground
from statehtn.hddl.reader import read_hddl_text

CONTEXT = decimal.Context(prec=70, Emax=decimal.MAX_EMAX, Emin=decimal.MIN_EMIN)
ACTIONS = 6


def few_actions() -> Grounding:
    """A problem of some actions that nobody looks at: prices make them into labels."""
    actions = [f"a{number}" for number in range(ACTIONS)]
    domain = f"""(define (domain d) (:task all :parameters ())
      (:method m :parameters () :task (all) :ordered-subtasks (and {" ".join(f"({name})" for name in actions)}))
      {" ".join(f"(:action {name} :parameters () :precondition () :effect ())" for name in actions)})"""
    problem = "(define (problem p) (:domain d) (:htn :ordered-subtasks (and (all))) (:init))"
    return ground(read_hddl_text(domain, problem))


@dataclass(frozen=True)
class ExactDisutility:
    """`linear` times the first sum, if it is not 0, and an exponential `(slope, log weight)` of each other sum."""

    linear: float
    terms: tuple[tuple[float, float], ...]

    @property
    def size(self) -> int:
        return len(self.terms) + (self.linear > 0)

    def at(self, point: Sequence[Decimal]) -> Decimal:
        """The disutility at one sum for each term, in the unit of costs."""
        with decimal.localcontext(CONTEXT):
            first = 1 if self.linear else 0
            total = Decimal(self.linear) * point[0] if first else Decimal(0)
            for (slope, log_weight), sum_of_term in zip(self.terms, point[first:], strict=True):
                size = (Decimal(log_weight) + Decimal(slope) * sum_of_term).exp()
                total += size if slope > 0 else -size
            return total

    def of(self, cost: Decimal) -> Decimal:
        """The disutility of a certain cost."""
        return self.at([cost] * self.size)


def priced(grounding: Grounding, prices: Sequence[int]) -> _relax.PricedProblem:
    """The problem of some actions at these prices, and at none where they are fewer."""
    return _relax.PricedProblem(grounding.handle, [*prices, *([0] * (ACTIONS - len(prices)))], [])


def in_cost(units: Sequence[int], exponents: Sequence[int]) -> list[Decimal]:
    """Sums in units of `2**-exponent`, in the unit of costs."""
    with decimal.localcontext(CONTEXT):
        return [Decimal(sum_of) * Decimal(2) ** -exponent for sum_of, exponent in zip(units, exponents, strict=True)]


def mix_of(weights: Sequence[float], units: Sequence[int]) -> int:
    """A sum of prices, each times its weight, in whole units."""
    return int(sum(Fraction(weight) * price for weight, price in zip(weights, units, strict=True)))
