"""The best policy is the best of all: random problems against exact values of their whole graphs.

Objectives: all that have policies, with and without a price of failing. The value of each policy that is found is
worked out again from its decisions, and its runs are checked against the lifted problem.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from fractions import Fraction
from unittest import mock

import pytest
from hypothesis import given
from hypothesis import strategies as st

import statehtn
from statehtn import PolicyResult, Problem, Status
from statehtn.core.policy_cut import CutPolicies
from statehtn.core.switches import PolicySwitches
from statehtn.errors import InputError, UnsupportedError
from statehtn.limits import Limits
from statehtn.model.policy_graph import PolicyNode
from statehtn.policies.run import find_policy
from statehtn.policies.settings import PolicySettings
from statehtn.policies.trajectory import TakenStep, Trajectory
from statehtn.risk import ObjectiveLike
from statehtn.session import Session
from tests.brute_force import GaveUp
from tests.explicit_graph import ExplicitGraph, explicit_graph
from tests.explicit_memory import INFINITE, FailureCost, bounded
from tests.explicit_policies import Answer
from tests.lotteries import lottery_problems
from tests.naive_outcomes import Way, ways
from tests.naive_semantics import Semantics, State
from tests.policy_values import best_answer, graph_of_policy
from tests.random_graphs import ALPHAS, LEVELS
from tests.random_outcomes import chance_problems, locked_problems, wide_problems
from tests.shares import share_of_examples

SHARE = share_of_examples(2)
LIMITS = Limits(steps=200_000)
PRECISION = 1e-9
CLOSE = {"rel": 1e-7, "abs": 1e-8}
BY_SWEEP = 1e-6  # the precision by which the entropic value at risk is proven
ORDERS = [("total",), ("none", "partial")]
PLAIN = st.one_of(
    st.just("neutral"), st.builds("{} {}".format, st.sampled_from(("averse", "seeking")), st.sampled_from(ALPHAS))
)
BUDGETS = st.sampled_from(("1", "2", "3.5", "5", "8", "13"))
MEMORY = {
    "deadline": st.builds("deadline {}".format, BUDGETS),
    "overrun": st.builds("overrun {}".format, BUDGETS),
    "quantile": st.builds("quantile {}".format, st.sampled_from(LEVELS)),
    "cvar": st.builds("cvar {}".format, st.sampled_from(LEVELS)),
    "mean-cvar": st.builds("mean-cvar {} {}".format, st.sampled_from(LEVELS), st.sampled_from(("0.25", "0.75"))),
    "piecewise": st.builds(
        "piecewise 0:0 2:{} 5:{}".format, st.sampled_from(("0", "-1")), st.sampled_from(("-4", "-9"))
    ),
    "one-switch": st.builds(
        "one-switch alpha={} tradeoff={} wealth={}".format,
        st.sampled_from(("0.05", "0.1", "0.3", "0.7")),
        st.sampled_from(("0.1", "1", "4")),
        st.sampled_from(("0", "5", "20")),
    ),
    "exponentials": st.one_of(
        st.builds(
            "exponentials linear={} {}:{} {}:1".format,
            st.sampled_from(("0", "1")),
            st.sampled_from(("0.1", "0.3")),
            st.sampled_from(("1", "0.1")),
            st.sampled_from(("-0.2", "-0.5")),
        ),
        st.sampled_from(
            (
                "exponentials linear=1 -0.3:2",
                "exponentials linear=0 -0.2:1 -1:3",
                "exponentials linear=0 -0.5:1 -2:9",
                "exponentials linear=0 -0.002:1 -0.01:9",
                "exponentials linear=0 0.1:1 0.4:0.05",
                "exponentials linear=2",
                "exponentials linear=0 0.3:1",
            )
        ),
    ),
}
FUNCTIONS: list[Callable[[Fraction], Fraction]] = [
    lambda cost: cost**2,
    lambda cost: Fraction(math.floor(cost)),  # jumps
    lambda cost: -3 / (1 + cost),  # seeks risk
    lambda cost: min(cost, Fraction(4)) + max(cost - 9, Fraction(0)) ** 3,
]
"""Disutilities of a cost."""
Judge = Callable[[ExplicitGraph], Answer]
FAILURE_COSTS: st.SearchStrategy[FailureCost] = st.sampled_from(
    (None, None, Fraction(2), Fraction(10), Fraction("0.5"))
)


def problems(orders: Sequence[str]) -> st.SearchStrategy[Problem]:
    return st.one_of(chance_problems(tuple(orders)), chance_problems(tuple(orders)), wide_problems(tuple(orders)))


def search(
    problem: Problem,
    wanted: ObjectiveLike,
    failure_cost: FailureCost = None,
    switches: PolicySwitches = PolicySwitches(),
) -> PolicyResult:
    """The planner's answer; give up where a limit came first."""
    price = None if failure_cost is None else float(failure_cost)
    precision = BY_SWEEP if str(wanted).startswith("evar") else PRECISION
    settings = PolicySettings.of(wanted, failure_cost=price, precision=precision)
    try:
        result = find_policy(Session(problem), replace(settings, switches=switches), LIMITS)
    except InputError as error:
        if "more than 64 outcomes" in str(error):
            raise GaveUp from error
        raise
    if result.stopped is not None:
        assert result.stopped is Status.TIME_LIMIT
        raise GaveUp
    return result


def check(problem: Problem, text: str, failure_cost: FailureCost = None) -> PolicyResult:
    """The planner's policy is worth what the best one is, and its runs are runs of the problem."""
    graph = explicit_graph(problem)
    answer = best_answer(graph, text, failure_cost)
    result = search(problem, text, failure_cost)
    close = BY_SWEEP if text.startswith("evar") else None
    must_be_best(problem, result, answer, lambda own: best_answer(own, text, failure_cost), close)
    return result


def must_be_best(
    problem: Problem, result: PolicyResult, answer: Answer, judge: Judge, tolerance: float | None = None
) -> None:
    value, expected_cost = answer.value, answer.expected_cost
    if value is None:
        assert result.status is Status.UNSOLVABLE
        assert result.policy is None
        assert result.reason
        return
    assert result.status is Status.OPTIMAL
    assert result.policy is not None
    close = {"rel": tolerance, "abs": tolerance} if tolerance else CLOSE
    slack = (2e-7 if tolerance else CLOSE["abs"]) * max(1.0, abs(float(value)))
    assert result.value == pytest.approx(float(value), **close)
    assert result.lower_bound <= float(value) + slack
    assert result.upper_bound >= float(value) - slack
    own = judge(graph_of_policy(result.policy.graph.flat))
    assert own.value is not None
    assert float(own.value) == pytest.approx(float(value), **close)
    if expected_cost is not None:
        assert float(own.expected_cost) == pytest.approx(float(expected_cost), **CLOSE)
    for seed in range(3):
        must_be_a_run(problem, result, seed)


def must_be_a_run(problem: Problem, result: PolicyResult, seed: int) -> None:
    """Require that a run that is drawn can happen in the lifted problem, at its cost, and ends as it says."""
    semantics = Semantics(problem)
    trajectory = result.policy.trajectory(seed)
    state = problem.initial_state
    for taken, node in zip(trajectory.steps, nodes_after(trajectory), strict=True):
        found = ways(semantics, taken.step.action, taken.step.arguments, state)
        assert found is not None, taken
        fitting = [way for way in found if fits(way, taken, node, state)]
        assert fitting, taken
        # How likely it is cannot be told from here: a branch may stand for outcomes whose difference does not matter.
        assert any(probability_of(way, taken.cost) for way in fitting), taken
        state = min(fitting, key=lambda way: len(way.state(state) ^ state)).state(state)
    if trajectory.end is statehtn.model.policy_graph.End.DONE:
        assert semantics.holds(problem.goal, {}, state)
        plan = result.policy.plan(trajectory)
        assert [str(step) for step in plan.steps] == [str(taken.step) for taken in trajectory.steps]


def nodes_after(trajectory: Trajectory) -> Iterator[PolicyNode]:
    """Yield the node to which each action of a run has led."""
    graph, node = trajectory.graph, 0
    for branch in trajectory.branches:
        decision = graph.nodes[node].decision
        node = graph.flat.successors[branch]
        if decision is not None and decision.action is not None:
            yield graph.nodes[node]


def fits(way: Way, taken: TakenStep, node: PolicyNode, state: State) -> bool:
    """Tell whether a way may be what came: it agrees in all that matters afterwards."""
    after = way.state(state)
    assert node.known is not None
    return after & node.known == node.facts & node.known and taken.added <= after and not taken.deleted & after


def probability_of(way: Way, cost: float) -> Fraction:
    return sum((p for amount, p in way.law.items() if math.isclose(amount, cost, abs_tol=1e-12)), Fraction(0))


@pytest.mark.parametrize("orders", ORDERS)
@SHARE
@given(data=st.data())
def test_neutral_and_exponential(orders: tuple[str, ...], data: st.DataObject) -> None:
    check(data.draw(problems(orders)), data.draw(PLAIN), data.draw(FAILURE_COSTS))


@SHARE
@given(problem=locked_problems(), text=PLAIN, price=FAILURE_COSTS)
def test_parts_out_of_reach(problem: Problem, text: str, price: FailureCost) -> None:
    check(problem, text, price)


@pytest.mark.parametrize("left_out", ["follow_forced", "forget_unreachable"])
@SHARE
@given(data=st.data())
def test_refinements_keep_the_values(left_out: str, data: st.DataObject) -> None:
    """Left out, there may be more nodes; values are the same."""
    problem = data.draw(st.one_of(problems(("total", "none", "partial")), locked_problems()))
    family = st.one_of(PLAIN, st.just("success"), MEMORY["deadline"], MEMORY["one-switch"])
    text, price = data.draw(family), data.draw(FAILURE_COSTS)
    price = None if text == "success" else price
    refined, plain = (search(problem, text, price, PolicySwitches(**{left_out: on})) for on in (True, False))
    assert plain.status is refined.status
    if refined.value is not None:
        assert plain.value == pytest.approx(refined.value, **CLOSE)
        must_be_a_run(problem, plain, 0)


@pytest.mark.parametrize("orders", ORDERS)
@SHARE
@given(data=st.data())
def test_success(orders: tuple[str, ...], data: st.DataObject) -> None:
    check(data.draw(problems(orders)), "success")


@pytest.mark.parametrize("family", MEMORY)
@SHARE
@given(data=st.data())
def test_agents_that_look_at_what_they_have_spent(family: str, data: st.DataObject) -> None:
    problem = data.draw(problems(("total", "none", "partial")))
    infinite = st.just(INFINITE) if family in ("deadline", "quantile") else st.nothing()
    check(problem, data.draw(MEMORY[family]), data.draw(st.one_of(FAILURE_COSTS, infinite)))


@share_of_examples(4)  # each is many searches
@given(problem=problems(("total", "none", "partial")), level=st.sampled_from(("0.5", "0.9")), price=FAILURE_COSTS)
def test_entropic_value_at_risk(problem: Problem, level: str, price: FailureCost) -> None:
    check(problem, f"evar {level}", price)


@SHARE
@given(data=st.data())
def test_what_is_remembered_up_to_a_cut(data: st.DataObject) -> None:
    """Wherever the first cut is; by itself the search begins without one, which is often enough."""
    several = problems(("total", "none", "partial"))
    problem = data.draw(st.one_of(several, several, lottery_problems()))
    text = data.draw(st.one_of(MEMORY["one-switch"], MEMORY["exponentials"]))
    with mock.patch.object(CutPolicies, "first_cut", data.draw(st.sampled_from((0, 1, 3, 8, 30)))):
        check(problem, text, data.draw(FAILURE_COSTS))


@SHARE
@given(data=st.data())
def test_functions_of_the_total_cost(data: st.DataObject) -> None:
    """Where costs are bounded; where the whole graph has a loop that costs something, they may be refused."""
    problem = data.draw(st.one_of(problems(("total", "none", "partial")), lottery_problems()))
    function = data.draw(st.sampled_from(FUNCTIONS))
    failure_cost = data.draw(FAILURE_COSTS)
    assert not isinstance(failure_cost, str)

    def utility(cost: float) -> float:
        return -float(function(Fraction(repr(cost))))

    answer = bounded(explicit_graph(problem), failure_cost, function)
    try:
        result = search(problem, utility, failure_cost)
    except UnsupportedError:
        assert answer is None
        return
    if answer is None:  # the search knows that the loop leads nowhere
        return

    def judge(graph: ExplicitGraph) -> Answer:
        own = bounded(graph, failure_cost, function)
        assert own is not None
        return own

    must_be_best(problem, result, answer, judge)
