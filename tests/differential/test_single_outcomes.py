"""Where every action has one outcome: what a policy is worth beside the best plan."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from statehtn import Problem, Status, pipeline
from statehtn.limits import Limits
from statehtn.policies.run import find_policy
from statehtn.policies.settings import PolicySettings
from statehtn.risk import objective
from statehtn.session import Session
from statehtn.settings import Settings
from tests.brute_force import GaveUp
from tests.explicit_graph import explicit_graph
from tests.lotteries import ALPHAS, FINITE, LAWS, lottery_problems, texts
from tests.policy_values import best_answer
from tests.shares import share_of_examples
from tests.strategies import problems

LIMITS = Limits(steps=200_000)
PLAIN = st.one_of(st.just("neutral"), texts(("averse ", "seeking "), ALPHAS))
POLICIES = st.one_of(
    *(LAWS[name] for name in ("deadline", "overrun", "quantile", "cvar", "mean-cvar")),
    FINITE["one-switch"],
    FINITE["exponentials"],
)
SHARE = share_of_examples(3)


def both(problem: Problem, text: str) -> tuple[float, float] | None:
    """The values of the best plan and of the best policy; None where there is neither."""
    session = Session(problem)
    plan = pipeline.solve(session, Settings.of(objective(text)), LIMITS)
    policy = find_policy(session, PolicySettings.of(text, precision=1e-9), LIMITS)
    if plan.stopped is not None or policy.stopped is not None:
        raise GaveUp
    assert (plan.status is Status.UNSOLVABLE) == (policy.status is Status.UNSOLVABLE)
    if plan.value is None:
        return None
    assert policy.value is not None
    return plan.value, policy.value


@SHARE
@given(problem=st.one_of(lottery_problems(), problems()), text=PLAIN)
def test_what_was_spent_does_not_matter_to_neutral_and_exponential_agents(problem: Problem, text: str) -> None:
    values = both(problem, text)
    if values is not None:
        assert values[1] == pytest.approx(values[0], rel=1e-6, abs=1e-6)


@SHARE
@given(problem=lottery_problems(), text=POLICIES)
def test_looking_is_never_worth_less_than_nothing(problem: Problem, text: str) -> None:
    values = both(problem, text)
    if values is not None:
        assert values[1] <= values[0] + 1e-6 * max(1, abs(values[0]))
        value = best_answer(explicit_graph(problem), text).value
        assert values[1] == pytest.approx(float(value), rel=1e-6, abs=1e-6)
