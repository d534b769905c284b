"""Frontiers of mean and risk are those of all plans, on random small problems and on the vehicle's first."""

from __future__ import annotations

import itertools
import json
import math

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

import statehtn
from statehtn import Frontier, Problem, Status
from statehtn.limits import Limits
from statehtn.session import Session
from statehtn.settings import Settings
from statehtn.sweeps.frontier import find_frontier
from tests.all_laws import all_outlooks
from tests.differential.oracles import LIMITS, must_have_ended
from tests.exact_laws import Law
from tests.exact_objectives import exact_objective, variance
from tests.lotteries import lottery_problems
from tests.shares import share_of_examples

SHARE = share_of_examples(5)

RISKS = ("cvar 0.5", "cvar 0.9", "deadline 8", "deadline 11", "deviation")
CLOSE = 1e-6  # what a search may be off by
SLACK = 1e-7
Pair = tuple[float, float]


def risk_of(risk: str, law: Law) -> float:
    return math.sqrt(variance(law)) if risk == "deviation" else float(exact_objective(risk).value(law))


def undominated(pairs: list[Pair]) -> list[Pair]:
    """Those of which no other one is lower in both, nearly equal ones once."""
    found: list[Pair] = []
    for mean, risk in sorted(set(pairs)):
        if not found or risk < found[-1][1] - CLOSE:
            found.append((mean, risk))
    return found


def has_finitely_many_plans(problem: Problem) -> bool:
    return not any(
        subtask.task == method.task for method in problem.domain.methods.values() for subtask in method.network.subtasks
    )


def of_all_plans(problem: Problem, risk: str) -> list[Pair]:
    return undominated([(float(plan.law.mean), risk_of(risk, plan.law)) for plan in all_outlooks(problem)])


def must_be_the_frontier(found: Frontier, expected: list[Pair]) -> None:
    """Nothing is missing but what the gaps allow; and nothing is there that is not on it, if it is complete."""
    pairs = [(point.mean, point.risk) for point in found.points]
    for (mean, risk), (other_mean, other_risk) in itertools.pairwise(pairs):
        assert mean < other_mean
        assert risk > other_risk
    if found.status is Status.OPTIMAL:
        for point in expected:
            assert any(mean <= point[0] + CLOSE and risk <= point[1] + CLOSE for mean, risk in pairs), (point, pairs)
        for pair in pairs:
            assert any(math.dist(pair, point) <= 4 * CLOSE for point in expected), (pair, expected)
    elif found.stopped is None:
        for mean, risk in expected:
            allowed = [gap for gap, one, after in zip(found.gaps, pairs, pairs[1:], strict=False)
                       if mean < after[0] and risk < one[1]]  # fmt: skip
            known = any(other <= mean + CLOSE and worse <= risk + CLOSE for other, worse in pairs)
            assert known or any(gap > 0 for gap in allowed)


@pytest.mark.parametrize("risk", RISKS)
@SHARE
@given(problem=lottery_problems())
def test_frontier(risk: str, problem: Problem) -> None:
    assume(has_finitely_many_plans(problem))
    expected = of_all_plans(problem, risk)
    found = find_frontier(Session(problem), risk, Settings.of(precision=SLACK), LIMITS)
    must_have_ended(found.stopped)
    if not expected:
        assert (found.status, len(found)) == (Status.UNSOLVABLE, 0)
        return
    must_be_the_frontier(found, expected)


@SHARE
@given(problem=lottery_problems(), risk=st.sampled_from(RISKS), steps=st.integers(1, 60))
def test_frontier_within_a_limit(problem: Problem, risk: str, steps: int) -> None:
    """What is there are plans of the problem, none better than another; it is complete only if nothing stopped it."""
    assume(has_finitely_many_plans(problem))
    found = find_frontier(Session(problem), risk, Settings.of(), Limits(steps=steps))
    assert (found.stopped is None) or found.status is not Status.OPTIMAL
    expected = of_all_plans(problem, risk)
    for point in found.points:
        assert any(mean <= point.mean + CLOSE and risk <= point.risk + CLOSE for mean, risk in expected)
    if found.status is Status.OPTIMAL:
        must_be_the_frontier(found, expected)


def test_the_vehicle(p1: Problem) -> None:
    found = statehtn.frontier(p1, "cvar 0.9")
    assert (found.status, found.risk, found.gaps) == (Status.OPTIMAL, "cvar 0.9", (0,))
    assert [point.mean for point in found.points] == pytest.approx([18.35, 19.4])
    assert [point.risk for point in found.points] == pytest.approx([22.532, 19.4])
    assert repr(found) == "<frontier of mean and cvar 0.9: optimal, 2 plans>"
    assert str(found).splitlines()[0].split() == ["steps", "mean", "cvar", "0.9", "gap", "before"]
    assert "<table" in found._repr_html_()
    assert found[:1] == [found[0]]
    data = json.loads(json.dumps(found.to_dict(), allow_nan=False))
    assert [len(point["plan"]) for point in data["points"]] == [9, 9]
    assert data["points"] == list(found)


def test_a_limit_says_that_plans_may_be_missing(p1: Problem) -> None:
    found = find_frontier(Session(p1), "deadline 20", Settings.of(), Limits(steps=1))
    assert found.stopped is Status.TIME_LIMIT
    assert found.status in (Status.SOLVED, Status.TIME_LIMIT)
    assert not found.points or "plans of lower risk may be missing" in str(found)


def test_what_is_no_risk_is_refused(p1: Problem) -> None:
    for risk, message in (
        ("cvr 0.9", r"unknown risk of a frontier 'cvr' \(did you mean 'cvar'\?\)"),
        ("cvar", "the risk of a frontier is 'cvar 0.95', 'deadline 25' or 'deviation', found 'cvar'"),
        ("cvar 2", "2"),
        ("", "the risk of a frontier is a text"),
    ):
        with pytest.raises(statehtn.UsageError, match=message):
            statehtn.frontier(p1, risk)
