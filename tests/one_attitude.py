"""Whether one attitude to risk, neutral or exponential, explains the choice of a plan: a proof that none does."""

from __future__ import annotations

import math
from collections.abc import Sequence

from tests.exact_laws import Law

LARGEST = 400.0  # beyond it the extreme outcomes of laws of a step of some tenths decide, and then their probabilities
MOST_INTERVALS = 300
SOME_ALPHAS = (0.0, *(sign * 2.0**power for sign in (1, -1) for power in range(-7, 5)))
ROUNDING = 1e-9


def is_best_for_none(law: Law, others: Sequence[Law]) -> bool:
    """True if for every alpha, also 0, another law has a lower certainty equivalent; false if that cannot be shown.

    Certainty equivalents rise with alpha. So on an interval [a, b] a law is never best if another one's at b is below
    its own at a; what this leaves open is halved.
    """
    if any(extremes(law, sign) <= min(extremes(other, sign) for other in others) for sign in (1, -1)):
        return False
    rivals = {min(others, key=lambda other: equivalent(other, alpha)) for alpha in SOME_ALPHAS}
    if law in rivals:
        return False
    pending = [(-LARGEST, 0.0), (0.0, LARGEST)]
    for _ in range(MOST_INTERVALS):
        if not pending:
            return True
        low, high = pending.pop()
        if equivalent(law, low) - ROUNDING > min(equivalent(other, high) for other in rivals):
            continue
        middle = (low + high) / 2
        if high - low > 2:  # alphas of all orders of magnitude are tried soon
            middle = math.copysign(math.sqrt(low * high + 1), middle)
        if equivalent(law, middle) - ROUNDING <= min(equivalent(other, middle) for other in rivals):
            return False
        pending += [(low, middle), (middle, high)]
    return False


def extremes(law: Law, sign: int) -> list[tuple[float, float]]:
    """What the most extreme agents compare: the worst outcome and its probability, then the next one; or the best."""
    outcomes = law.outcomes[::-1] if sign > 0 else law.outcomes
    return [(float(cost), sign * float(p)) for cost, p in outcomes]


def equivalent(law: Law, alpha: float) -> float:
    """The certainty equivalent of an exponential utility: averse for positive alpha, neutral for 0."""
    if abs(alpha) < 1e-9:
        return float(law.mean)
    exponents = [alpha * cost for cost, _ in law.in_floats]
    largest = max(exponents)
    terms = zip(exponents, law.in_floats, strict=True)
    return (largest + math.log(sum(p * math.exp(exponent - largest) for exponent, (_, p) in terms))) / alpha
