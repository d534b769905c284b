"""Risk costs in exact arithmetic, for tests of precision.

A float means the decimal that it prints as. Means are fractions, exponential means decimals of 60 digits.
"""

from __future__ import annotations

import decimal
from dataclasses import dataclass
from decimal import Decimal
from fractions import Fraction

from statehtn.model import CostDistribution
from statehtn.risk import Attitude, Utility

CONTEXT = decimal.Context(prec=60, Emax=decimal.MAX_EMAX, Emin=decimal.MIN_EMIN)


@dataclass(frozen=True)
class ExactUtility:
    """Prices a list of outcomes as a utility does, without rounding."""

    utility: Utility

    def risk_cost(self, law: CostDistribution) -> Fraction:
        outcomes = [(Fraction(repr(probability)), Fraction(repr(cost))) for probability, cost in law.outcomes]
        whole = sum(probability for probability, _ in outcomes)
        if self.utility.alpha is None:
            return sum((probability * cost for probability, cost in outcomes), Fraction(0)) / whole
        if len(outcomes) == 1:
            return outcomes[0][1]
        slope = decimal_of(Fraction(self.utility.alpha) * (1 if self.utility.attitude is Attitude.AVERSE else -1))
        with decimal.localcontext(CONTEXT):
            exponents = [slope * decimal_of(cost) for _, cost in outcomes]
            largest = max(exponents)  # without it, no exponent is in the range even of decimals
            terms = zip((decimal_of(p) for p, _ in outcomes), exponents, strict=True)
            total = sum(p * (exponent - largest).exp() for p, exponent in terms)
            return Fraction((largest + (total / decimal_of(whole)).ln()) / slope)


def decimal_of(number: Fraction) -> Decimal:
    with decimal.localcontext(CONTEXT):
        return Decimal(number.numerator) / Decimal(number.denominator)
