"""Random objectives of every kind that has a text form, with parameters of all sizes."""

from __future__ import annotations

from hypothesis import strategies as st

from statehtn.risk import (
    Attitude,
    ConditionalValueAtRisk,
    Deadline,
    EntropicValueAtRisk,
    Exponential,
    Exponentials,
    MeanCvar,
    MeanDeviation,
    MeanVariance,
    Neutral,
    Objective,
    OneSwitch,
    Overrun,
    Piecewise,
    Quantile,
    SuccessUtility,
)


def _scaled(exponents: tuple[float, float]) -> st.SearchStrategy[float]:
    return st.floats(*exponents).map(lambda exponent: round(10.0**exponent, 12))


LEVELS = st.one_of(st.integers(1, 99).map(lambda percent: percent / 100), _scaled((-6, -2)).map(lambda tail: 1 - tail))
WEIGHTS = st.one_of(st.just(0.0), _scaled((-3, 3)))
SLOPES = _scaled((-4, 1.5))
COSTS = st.integers(0, 400).map(lambda tenths: tenths / 10)


@st.composite
def piecewise(draw: st.DrawFn) -> Piecewise:
    """Draw a piecewise linear utility that does not rise."""
    costs = sorted(draw(st.lists(COSTS, min_size=2, max_size=5, unique=True)))
    falls = draw(st.lists(st.integers(0, 50), min_size=len(costs), max_size=len(costs)))
    return Piecewise([(cost, -sum(falls[: index + 1]) / 4) for index, cost in enumerate(costs)])


@st.composite
def exponentials(draw: st.DrawFn) -> Exponentials:
    """Draw a sum of exponentials."""
    signs = st.sampled_from([-1, 1])
    slopes = draw(st.lists(st.builds(lambda sign, size: sign * size, signs, SLOPES), max_size=3, unique=True))
    weights = [(slope, draw(WEIGHTS)) for slope in slopes]
    linear = draw(WEIGHTS)
    return Exponentials(linear if linear or any(weight for _, weight in weights) else 1.0, weights)


BY_NAME: dict[str, st.SearchStrategy[Objective]] = {
    "neutral": st.just(Neutral()),
    "averse": st.builds(Exponential, st.just(Attitude.AVERSE), SLOPES),
    "seeking": st.builds(Exponential, st.just(Attitude.SEEKING), SLOPES),
    "mean-variance": st.builds(MeanVariance, WEIGHTS),
    "one-switch": st.builds(OneSwitch, SLOPES, _scaled((-4, 4)), st.floats(-50, 500)),
    "exponentials": exponentials(),
    "mean-deviation": st.builds(MeanDeviation, WEIGHTS),
    "evar": st.builds(EntropicValueAtRisk, LEVELS),
    "deadline": st.builds(Deadline, COSTS),
    "overrun": st.builds(Overrun, COSTS),
    "piecewise": piecewise(),
    "quantile": st.builds(Quantile, LEVELS),
    "cvar": st.builds(ConditionalValueAtRisk, LEVELS),
    "mean-cvar": st.builds(MeanCvar, LEVELS, st.integers(0, 10).map(lambda tenths: tenths / 10)),
    "success-utility": st.builds(SuccessUtility, SLOPES),
}
"""Random objectives of every name that has a text form; costs are at most some 40."""


def objectives() -> st.SearchStrategy[Objective]:
    """Draw an objective of any kind that has a text form."""
    return st.sampled_from(sorted(BY_NAME)).flatmap(BY_NAME.__getitem__)
