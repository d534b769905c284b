"""Sweeps over alpha find what exhaustive search finds, and their bounds hold: on random small problems."""

from __future__ import annotations

import math

import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from statehtn import CostDistribution, Problem, Result, Status
from statehtn.limits import Limits
from statehtn.session import Session
from statehtn.settings import Settings
from statehtn.sweeps import solve
from statehtn.sweeps.attitude_map import AttitudeMap, map_attitudes
from statehtn.sweeps.minorants import certainty_equivalent, minorant
from tests.all_laws import best_plans
from tests.differential.oracles import LIMITS, must_have_ended
from tests.exact_objectives import ExactObjective, exact_objective
from tests.lotteries import lottery_problems
from tests.shares import share_of_examples
from tests.strategies import problems

SHARE = share_of_examples(5)

LEVELS = ("0.05", "0.3", "0.5", "0.8", "0.95", "0.999")
SLOPES = ("-3", "-0.5", "-0.1", "-0.01", "0", "0.01", "0.1", "0.3", "0.5", "0.9", "2", "5")
PRECISION = 1e-8
SLACK = 1e-9


def agent(slope: str) -> ExactObjective:
    """The agent of a slope: alpha if averse, -alpha if seeking."""
    if slope == "0":
        return exact_objective("neutral")
    return exact_objective(f"seeking {slope[1:]}" if slope.startswith("-") else f"averse {slope}")


def evar(problem: Problem, level: str, limits: Limits, **options: str) -> Result:
    return solve(Session(problem), Settings.of(f"evar {level}", precision=PRECISION, **options), limits)


def mapped(problem: Problem, low: float, high: float, limits: Limits, eps: float | None = None) -> AttitudeMap:
    return map_attitudes(Session(problem), low, high, eps, 1e-3, Settings.of(), limits)


@SHARE
@given(problem=lottery_problems(), level=st.sampled_from(LEVELS))
def test_evar_without_chords(problem: Problem, level: str) -> None:
    """The plain way proves as much, in many more runs; so not as precisely here."""
    settings = Settings.of(f"evar {level}", precision=1e-2, without=("chords",))
    result = solve(Session(problem), settings, LIMITS)
    must_have_ended(result.stopped)
    best = best_plans(problem, exact_objective(f"evar {level}"))
    assert result.status is (Status.OPTIMAL if best else Status.UNSOLVABLE)
    if best:
        value = float(best[0].value)
        assert result.value is not None
        assert result.lower_bound is not None
        assert value - SLACK <= result.value <= value + 1e-2 * max(1.0, value)
        assert result.lower_bound <= value + SLACK


@pytest.mark.parametrize("solver", ["state", "plan"])
@SHARE
@given(problem=st.one_of(lottery_problems(), problems()), level=st.sampled_from(LEVELS))
def test_evar(solver: str, problem: Problem, level: str) -> None:
    result = evar(problem, level, LIMITS, solver=solver)
    must_have_ended(result.stopped)
    best = best_plans(problem, exact_objective(f"evar {level}"))
    assert result.status is (Status.OPTIMAL if best else Status.UNSOLVABLE)
    if best:
        value = float(best[0].value)
        assert result.value is not None
        assert result.lower_bound is not None
        assert result.gap is not None
        assert value - SLACK * value <= result.value <= value + PRECISION * max(1, value) + SLACK
        assert result.lower_bound <= value * (1 + SLACK)
        assert result.gap <= PRECISION * max(1, value)


@SHARE
@given(problem=lottery_problems(), level=st.sampled_from(LEVELS), steps=st.integers(1, 40))
def test_evar_within_a_limit(problem: Problem, level: str, steps: int) -> None:
    """Whenever it ends, the bound holds, and the plan is worth what is said."""
    result = evar(problem, level, Limits(steps=steps))
    best = best_plans(problem, exact_objective(f"evar {level}"))
    value = float(best[0].value) if best else math.inf
    if result.lower_bound is not None:
        assert result.lower_bound <= value * (1 + SLACK)
    if result.value is not None:
        assert result.value >= value * (1 - SLACK)
        assert result.status is (Status.OPTIMAL if result.gap == 0 or result.stopped is None else result.status)
    else:
        assert result.status in (Status.UNSOLVABLE, Status.TIME_LIMIT)


@SHARE
@given(
    problem=st.one_of(lottery_problems(), problems()),
    ends=st.sampled_from(((-3.0, 5.0), (-math.inf, math.inf), (0.01, 2.0), (-3.0, -0.01), (-1.0, 0.0), (0.0, 1.0))),
    part=st.sampled_from((None, 0.1, 0.001)),
    slopes=st.lists(st.sampled_from(SLOPES), min_size=2, max_size=4, unique=True),
)
def test_map(problem: Problem, ends: tuple[float, float], part: float | None, slopes: list[str]) -> None:
    found = mapped(problem, *ends, LIMITS, part)
    must_have_ended(found.stopped)
    if not found.pieces:
        assert found.status is Status.UNSOLVABLE
        assert best_plans(problem, agent("0")) == []
        return
    assert found.status is Status.OPTIMAL
    assert found.eps is not None
    assert found.gap is not None
    assert found.gap <= found.eps
    assert part is None or found.eps == part
    assert [found.pieces[0].low, found.pieces[-1].high] == list(ends)
    must_be_in_order(found)
    must_be_within_the_gap(problem, found, slopes)


@SHARE
@given(
    problem=lottery_problems(),
    steps=st.integers(1, 60),
    slopes=st.lists(st.sampled_from(SLOPES), min_size=2, max_size=3),
)
def test_map_within_a_limit(problem: Problem, steps: int, slopes: list[str]) -> None:
    found = mapped(problem, -3, 5, Limits(steps=steps))
    if found.pieces:
        must_be_in_order(found)
        must_be_within_the_gap(problem, found, slopes)
    else:
        assert found.status in (Status.UNSOLVABLE, Status.TIME_LIMIT)


def must_be_in_order(found: AttitudeMap) -> None:
    assert len(found.breaks) == len(found) - 1
    for left, right, point in zip(found.pieces, found.pieces[1:], found.breaks, strict=False):
        assert left.low <= left.high == right.low <= right.high
        assert point.low <= right.low <= point.high
        assert left.curve != right.curve


def must_be_within_the_gap(problem: Problem, found: AttitudeMap, slopes: list[str]) -> None:
    """The plan of each agent is at most the gap of its piece worse than the best."""
    for slope in slopes:
        if found.low <= float(slope) <= found.high:
            piece = found.at(float(slope))
            best = float(best_plans(problem, agent(slope))[0].value)
            worth = piece.certainty_equivalent(float(slope))
            assert best * (1 - SLACK) <= worth <= best * (1 + SLACK) + piece.gap + SLACK


@example([(1, 0), (1, 0), (1, 1.5)], 0.0, 0.25, 2.0**-23, 0.25)  # where the slope is a difference of equal numbers
@SHARE
@given(
    st.lists(st.tuples(st.integers(1, 1000), st.sampled_from((0, 1, 1.5, 2, 10, 1000))), min_size=1, max_size=4),
    st.floats(0, 30),
    st.floats(1e-3, 30),
    st.floats(0, 1),
    st.floats(0, 1),
)
def test_minorants_are_below(
    weights: list[tuple[int, float]], low: float, width: float, at: float, where: float
) -> None:
    """The chord between the ends is nowhere above the certainty equivalent."""
    total = sum(weight for weight, _ in weights)
    law = CostDistribution.of((weight / total, cost) for weight, cost in weights)
    high = low + width
    ends = minorant(law, low, high, low + at * width)
    assert min(ends) >= 0
    x = low + where * width
    line = ends[0] + where * (ends[1] - ends[0])
    truth = certainty_equivalent(law, x)
    assert line <= truth * (1 + 1e-13)
