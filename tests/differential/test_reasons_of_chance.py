"""Why no policy is done for certain: the probability is the largest there is, and dead ends are all that is lost."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

import statehtn
from statehtn import Problem
from statehtn.explanation.chance import MOST_OUTCOMES, NoPolicy, what_is_lost, why_no_policy
from statehtn.limits import Limits
from statehtn.policies.settings import PolicySettings
from statehtn.session import Session
from tests.brute_force import GaveUp
from tests.explicit_graph import explicit_graph
from tests.explicit_policies import best_policy
from tests.random_outcomes import chance_problems

LIMITS = Limits(steps=200_000)
FAILURE_COST = 100


@given(chance_problems())
def test_dead_ends_are_all_that_is_lost(problem: Problem) -> None:
    if not problem.domain.has_outcomes:
        raise GaveUp
    graph = explicit_graph(problem)
    most = best_policy(graph, "success").value
    assert most is not None
    answer = why_no_policy(Session(problem), PolicySettings.of(), LIMITS)
    if isinstance(answer, NoPolicy):
        assert most < 1
        if not answer.is_proven or len(answer.dead_ends) == MOST_OUTCOMES:
            raise GaveUp
        assert answer.most_success == pytest.approx(float(most))
        likeliest = why_no_policy(Session(problem), PolicySettings.of("success"), LIMITS)
        if not isinstance(likeliest, NoPolicy):
            assert likeliest.value == pytest.approx(float(most))
            lost = what_is_lost(likeliest)
            assert lost is not None
            assert lost.dead_ends == answer.dead_ends
        if most == 0:
            return
        # The policy with that probability stops where being done has become impossible: every other run comes to one
        # of the outcomes, each of which leads where no policy is done. Were one done there, a better one would do so.
        assert math.fsum(bad.reached for bad in answer.dead_ends) >= 1 - float(most) - 1e-7
        assert all(bad.reached <= 1 - float(most) + 1e-7 for bad in answer.dead_ends)
        go_on = statehtn.policy(problem, failure_cost=FAILURE_COST, time_limit=2)
        assert go_on.policy is not None
    elif answer.policy is not None:
        assert most == answer.policy.success_probability == 1
        assert answer.value is not None
        assert math.isfinite(answer.value)
    else:
        raise GaveUp


@given(chance_problems(), st.sampled_from(("0.3", "0.7", "2")))
def test_averse_agents_loathe_what_they_are_said_to(problem: Problem, alpha: str) -> None:
    if not problem.domain.has_outcomes:
        raise GaveUp
    graph = explicit_graph(problem)
    most = best_policy(graph, "success").value
    best = best_policy(graph, f"averse {alpha}").value
    answer = why_no_policy(Session(problem), PolicySettings.of(f"averse {alpha}"), LIMITS)
    if isinstance(answer, NoPolicy):
        assert best is None
        if most == 1:
            assert answer.loops
            assert answer.finite_below is not None
            assert best_policy(graph, f"averse {answer.finite_below * 0.99:.6f}").value is not None
    elif answer.policy is not None:
        assert best is not None
        assert answer.value == pytest.approx(float(best), rel=1e-5)
    else:
        raise GaveUp
