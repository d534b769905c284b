"""Alpha from what people say about lotteries."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

import statehtn
from statehtn import Attitude, CostDistribution, Neutral, alpha_of
from statehtn.errors import InputError, UsageError

JAM = CostDistribution.of([(0.9, 18), (0.1, 30)])


@pytest.mark.parametrize("slope", [-20.0, -3.0, -0.01, 1e-6, 0.028, 0.9, 50.0])
def test_the_alpha_of_a_certainty_equivalent_is_found_again(slope: float) -> None:
    found = alpha_of(JAM.exponential_mean(slope), JAM)
    assert found.low == found.high == pytest.approx(slope, rel=1e-6)
    assert found.attitude is (Attitude.AVERSE if slope > 0 else Attitude.SEEKING)
    assert found.alpha == pytest.approx(abs(slope), rel=1e-6)
    assert found.utility.risk_cost(JAM) == pytest.approx(JAM.exponential_mean(slope), rel=1e-12)


@given(
    st.lists(st.tuples(st.integers(1, 9), st.integers(0, 100)), min_size=2, max_size=5),
    st.floats(0.02, 0.98),
)
def test_every_certain_cost_between_the_ends_fits_an_agent(weights: list[tuple[int, int]], share: float) -> None:
    total = sum(weight for weight, _ in weights)
    law = CostDistribution.of((weight / total, cost) for weight, cost in weights)
    if law.least == law.most:
        with pytest.raises(InputError, match="says nothing about an attitude"):
            alpha_of(law.least, law)
        return
    certain = law.least + share * (law.most - law.least)
    found = alpha_of(certain, law)
    assert found.utility.risk_cost(law) == pytest.approx(certain, rel=1e-8)


def test_the_mean_is_what_a_neutral_person_says() -> None:
    found = alpha_of(JAM.mean, JAM)
    assert (found.low, found.high, found.utility, found.name, found.alpha) == (0, 0, Neutral(), "neutral", None)


def test_several_answers_leave_the_interval_that_fits_all() -> None:
    rough = alpha_of((19.3, 25.0), JAM)
    assert rough.low == pytest.approx(alpha_of(19.3, JAM).low)
    assert rough.high == pytest.approx(alpha_of(25.0, JAM).low)
    both = alpha_of([(19.3, 25.0), (22.0, 29.0)], [JAM, JAM])
    assert (both.low, both.high) == (alpha_of(22.0, JAM).low, rough.high)
    assert both.contradictions == ()
    assert both.name == f"averse {both.middle:.6g}"
    assert str(both) == f"alpha {both.low:.6g} to {both.high:.6g}"
    assert repr(both) == f"<{both}>"
    assert str(both.answers[0]) == f"19.3 to 25 for {JAM}: {rough}"


def test_contradictory_answers_are_named() -> None:
    found = alpha_of([(19.3, 25.0), 18.5, (26.0, 29.0)], [JAM, JAM, JAM])
    assert found.contradictions == ((0, 1), (0, 2), (1, 2))
    assert (found.low, found.high) == (alpha_of(18.5, JAM).low, alpha_of(29.0, JAM).high)
    assert "no alpha fits all answers (contradictory are 1 and 2, 1 and 3, 2 and 3)" in str(found)


def test_what_says_nothing_is_refused() -> None:
    for certain in (18.0, 30.0, 5, math.inf):
        with pytest.raises(InputError, match="is as bad to nobody as a lottery of 18 w.p. 0.9, 30 w.p. 0.1"):
            alpha_of(certain, JAM)
    with pytest.raises(InputError, match="costs 5 in any case"):
        alpha_of(5, CostDistribution.certain(5))
    with pytest.raises(UsageError, match="as many certain costs as lotteries are expected, found 1 and 2"):
        alpha_of(19, [JAM, JAM])
    with pytest.raises(UsageError, match="the smaller one comes first"):
        alpha_of((25.0, 19.0), JAM)


def test_continuous_laws() -> None:
    stats = pytest.importorskip("scipy.stats")
    law = CostDistribution.from_scipy(stats.gamma(2, scale=3))
    assert alpha_of(law.exponential_mean(0.25), law).low == pytest.approx(0.25)
    heavy = CostDistribution.from_scipy(stats.lognorm(1))
    assert alpha_of(heavy.exponential_mean(-0.5), heavy).low == pytest.approx(-0.5, rel=1e-6)
    with pytest.raises(InputError, match="no exponential agent finds a certain cost of 2 as bad as lognorm"):
        alpha_of(2, heavy)


def test_it_is_public() -> None:
    assert isinstance(statehtn.alpha_of(19.4, JAM), statehtn.Elicited)
