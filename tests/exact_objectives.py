"""What objectives mean, spelled out in exact arithmetic: the judge of the planner's own definitions.

Rational values are exact, others have some 50 digits (the entropic value at risk 20). Costs are minimised, so the
least value is the best.
"""

from __future__ import annotations

import decimal
import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from decimal import Decimal
from fractions import Fraction

from tests.exact import CONTEXT, decimal_of
from tests.exact_laws import Law

Value = Callable[[Law], Fraction]
SLACK = Fraction(1, 10**12)  # probabilities that have to reach a level may be so much below it
DIGITS = Decimal("1e-45")
ROUNDING = 1e-12  # of sums of floats, with a lot to spare


@dataclass(frozen=True)
class ExactObjective:
    """What is minimised."""

    text: str
    value: Value
    bound: Value
    """At most `value`, soon computed, and never lower where an independent cost, which is not negative, is added."""

    def __repr__(self) -> str:
        return self.text


def exact_objective(text: str) -> ExactObjective:
    """Read an objective in the planner's form, such as `cvar 0.95`; numbers are what their digits say."""
    name, *words = text.split()
    named = {key: Fraction(number) for key, number in (word.split("=") for word in words if "=" in word)}
    pairs = [
        (Fraction(first), Fraction(second)) for first, second in (word.split(":") for word in words if ":" in word)
    ]
    numbers = [Fraction(word) for word in words if "=" not in word and ":" not in word]
    arguments = {**named, **({"pairs": pairs} if pairs else {})}
    value = VALUES[name](*numbers, **arguments)
    bound = BOUNDS[name](*numbers, **arguments) if name in BOUNDS else value
    return ExactObjective(text, value, bound)


def of_utility(utility: Callable[[Fraction], Fraction], text: str = "a utility") -> ExactObjective:
    """The expected utility of the total cost, times -1; the utility does not rise."""
    value = expectation(lambda cost: -Fraction(utility(cost)))
    return ExactObjective(text, value, value)


def expectation(function: Callable[[Fraction], Fraction]) -> Value:
    return lambda law: sum((p * function(cost) for cost, p in law.outcomes), Fraction(0))


def neutral() -> Value:
    return lambda law: law.mean


def averse(alpha: Fraction) -> Value:
    return lambda law: Fraction(certainty_equivalent(law, alpha))


def seeking(alpha: Fraction) -> Value:
    return lambda law: Fraction(certainty_equivalent(law, -alpha))


def success_utility(alpha: Fraction) -> Value:
    return lambda law: alpha * Fraction(certainty_equivalent(law, -alpha))


def mean_variance(weight: Fraction) -> Value:
    return lambda law: law.mean + weight * variance(law)


def mean_deviation(weight: Fraction) -> Value:
    def value(law: Law) -> Fraction:
        return law.mean + weight * Fraction(decimal_of(variance(law)).sqrt(CONTEXT))

    return value


def variance(law: Law) -> Fraction:
    return sum((p * (cost - law.mean) ** 2 for cost, p in law.outcomes), Fraction(0))


def one_switch(alpha: Fraction, tradeoff: Fraction, wealth: Fraction) -> Value:
    """The cost c with u(wealth - c) = E u(wealth - C), where u(x) = x - tradeoff/alpha e^(-alpha x)."""
    with decimal.localcontext(CONTEXT):
        weight = decimal_of(tradeoff / alpha) * (-decimal_of(alpha * wealth)).exp()
    return exponentials(Fraction(1), [(alpha, Fraction(weight))])


def exponentials(linear: Fraction = Fraction(0), pairs: Sequence[tuple[Fraction, Fraction]] = ()) -> Value:
    """The cost c with d(c) = E d(C), where d is linear plus exponentials, those of negative alpha with a minus."""
    w0, terms = decimal_of(linear), [(decimal_of(alpha), decimal_of(weight)) for alpha, weight in pairs]

    def disutility(cost: Decimal) -> Decimal:
        return w0 * cost + sum((w if a > 0 else -w) * (a * cost).exp() for a, w in terms)

    def slope(cost: Decimal) -> Decimal:
        return w0 + sum(w * abs(a) * (a * cost).exp() for a, w in terms)

    def value(law: Law) -> Fraction:
        with decimal.localcontext(CONTEXT):
            expected = sum(decimal_of(p) * disutility(decimal_of(cost)) for cost, p in law.outcomes)
            candidates = [certainty_equivalent(law, alpha) for alpha, weight in pairs if weight]
            candidates += [decimal_of(law.mean)] if linear else []
            low, high = min(candidates), max(candidates)  # the answer lies between the answers of the terms alone
            cost = high
            while True:
                excess = disutility(cost) - expected
                step = excess / slope(cost)
                if abs(step) <= DIGITS * max(1, high) or high - low <= DIGITS * max(1, high):
                    return Fraction(cost)
                low, high = (cost, high) if excess <= 0 else (low, cost)
                cost = cost - step if low < cost - step < high else (low + high) / 2

    return value


def certainty_equivalent(law: Law, slope: Fraction) -> Decimal:
    """`ln E e^(slope C) / slope`."""
    with decimal.localcontext(CONTEXT):
        return log_of_mean_exponential(law, decimal_of(slope)) / decimal_of(slope)


def log_of_mean_exponential(law: Law, slope: Decimal) -> Decimal:
    exponents = [slope * decimal_of(cost) for cost, _ in law.outcomes]
    largest = max(exponents)  # without it, no exponent is in the range even of decimals
    terms = zip(law.outcomes, exponents, strict=True)
    return largest + sum(decimal_of(p) * (exponent - largest).exp() for (_, p), exponent in terms).ln()


def entropic_value_at_risk(level: Fraction) -> Value:
    """The infimum over a > 0 of `(ln E e^(a C) + c) / a`, where c = ln(1/(1 - level)).

    Its slope has the sign of `a K'(a) - K(a) - c`, K the logarithm; `a K' - K`, the divergence of the tilted law, rises
    from 0 to ln(1/P(C is largest)). Where that is at most c the infimum is the largest cost.
    """
    radius = -math.log(1 - level)

    def divergence(law: Law, a: float) -> float:
        top = float(law.most)
        weights = [(p * math.exp(a * (cost - top)), cost) for cost, p in law.in_floats]
        whole = sum(weight for weight, _ in weights)
        mean = sum(weight * cost for weight, cost in weights) / whole
        return a * (mean - top) - math.log(whole)

    def value(law: Law) -> Fraction:
        if law.outcomes[-1][1] >= 1 - level:
            return law.most
        low, high = 0.0, 1.0
        while divergence(law, high) < radius:
            low, high = high, 2 * high
        for _ in range(60):  # in floats: the value is flat there, so that its error is the square of theirs
            middle = (low + high) / 2
            low, high = (middle, high) if divergence(law, middle) < radius else (low, middle)
        with decimal.localcontext(CONTEXT):
            a = decimal_of(Fraction(high))
            return Fraction((log_of_mean_exponential(law, a) - decimal_of(1 - level).ln()) / a)

    return value


def deadline(budget: Fraction) -> Value:
    return lambda law: 1 - law.at_most(budget)


def overrun(budget: Fraction) -> Value:
    return expectation(lambda cost: max(cost - budget, Fraction(0)))


def piecewise(pairs: Sequence[tuple[Fraction, Fraction]]) -> Value:
    """The utility goes through these points (cost, utility), in straight lines, also beyond the first and the last."""

    def utility(cost: Fraction) -> Fraction:
        number = next((i for i in range(1, len(pairs)) if cost <= pairs[i][0]), len(pairs) - 1)
        (c0, u0), (c1, u1) = pairs[number - 1], pairs[number]
        return u0 + (u1 - u0) * (cost - c0) / (c1 - c0)

    return expectation(lambda cost: -utility(cost))


def quantile(level: Fraction) -> Value:
    return lambda law: next(cost for cost, _ in law.outcomes if law.at_most(cost) >= level - SLACK)


def conditional_value_at_risk(level: Fraction) -> Value:
    """The mean of the worst cases, which have the probability `1 - level` together."""

    def value(law: Law) -> Fraction:
        left, total = 1 - level, Fraction(0)
        for cost, p in reversed(law.outcomes):
            taken = min(p, left)
            total += taken * cost
            left -= taken
        return total / (1 - level)

    return value


def mean_cvar(level: Fraction, weight: Fraction) -> Value:
    worst = conditional_value_at_risk(level)
    return lambda law: (1 - weight) * law.mean + weight * worst(law)


VALUES: dict[str, Callable[..., Value]] = {
    "neutral": neutral,
    "averse": averse,
    "seeking": seeking,
    "mean-variance": mean_variance,
    "one-switch": one_switch,
    "exponentials": exponentials,
    "mean-deviation": mean_deviation,
    "evar": entropic_value_at_risk,
    "deadline": deadline,
    "overrun": overrun,
    "piecewise": piecewise,
    "quantile": quantile,
    "cvar": conditional_value_at_risk,
    "mean-cvar": mean_cvar,
    "success-utility": success_utility,
}
"""The value of a law by the name of an objective and its numbers."""


def nearly(*slopes: Fraction) -> Value:
    """A little less than the least certainty equivalent of exponentials with these slopes; 0 stands for the mean."""

    def equivalent(law: Law, slope: float) -> float:
        if not slope:
            return float(law.mean)
        exponents = [slope * cost for cost, _ in law.in_floats]
        largest = max(exponents)
        terms = zip(exponents, law.in_floats, strict=True)
        return (largest + math.log(sum(p * math.exp(exponent - largest) for exponent, (_, p) in terms))) / slope

    def bound(law: Law) -> Fraction:
        least = min(equivalent(law, float(slope)) for slope in slopes)
        return Fraction(least - ROUNDING * (1 + abs(least) + 1 / min(abs(float(slope)) or 1 for slope in slopes)))

    return bound


def bound_of_exponentials(linear: Fraction = Fraction(0), pairs: Sequence[tuple[Fraction, Fraction]] = ()) -> Value:
    return nearly(*([Fraction(0)] if linear else []), *(alpha for alpha, weight in pairs if weight))


BOUNDS: dict[str, Callable[..., Value]] = {
    "averse": nearly,
    "seeking": lambda alpha: nearly(-alpha),
    "success-utility": lambda alpha: lambda law: alpha * nearly(-alpha)(law),
    "one-switch": lambda alpha, **_: nearly(Fraction(0), alpha),
    "exponentials": bound_of_exponentials,
    "evar": conditional_value_at_risk,
}
"""Bounds that are found sooner than the value."""
