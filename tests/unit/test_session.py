"""A planner as a session: grounded once, priced once for each agent, and never the worse for a run that was ended."""

from __future__ import annotations

import inspect
from collections.abc import Callable
from typing import Any

import pytest

import statehtn
from statehtn import Planner, Status, session
from statehtn.core.grounding import Grounding, ground
from statehtn.limits import LimitReached
from statehtn.model import Problem
from tests.test_minimal import DOMAIN, PROBLEM

METHODS = ("plan", "improving", "top_plans", "compare_attitudes")


@pytest.fixture
def problem() -> Problem:
    return statehtn.read_hddl_text(DOMAIN, PROBLEM)


@pytest.fixture
def calls(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """The names of the phases that have been gone through, in their order."""
    made: list[str] = []

    def counted(name: str) -> Callable[..., Any]:
        phase = getattr(session, name)

        def call(*arguments: Any) -> Any:
            made.append(name)
            return phase(*arguments)

        return call

    for name in ("ground", "price"):
        monkeypatch.setattr(session, name, counted(name))
    return made


def test_a_problem_is_grounded_once_and_priced_once_for_each_agent(problem: Problem, calls: list[str]) -> None:
    planner = Planner(problem)
    assert planner.problem is problem
    assert repr(planner).startswith("<planner for <problem")
    averse = planner.plan(attitude="averse", alpha=0.5)
    best = planner.top_plans(2, attitude="averse", alpha=0.5)
    *_, last = planner.improving(attitude="averse", alpha=0.5)
    assert calls == ["ground", "price"]
    assert averse.risk_cost == best[0].risk_cost == last.risk_cost
    assert len(planner.compare_attitudes([0.5, 2]).results) == 5
    assert calls == ["ground"] + 5 * ["price"]


def test_compared_agents_share_one_grounding(problem: Problem, calls: list[str]) -> None:
    comparison = statehtn.compare_attitudes(problem, [0.5, 2])
    assert calls.count("ground") == 1
    for result in comparison.results:
        alone = statehtn.plan(problem, attitude=result.attitude, alpha=result.alpha)
        assert (alone.plan, alone.risk_cost, alone.lower_bound) == (result.plan, result.risk_cost, result.lower_bound)
        assert alone.statistics.sizes == result.statistics.sizes
        assert alone.statistics.search == result.statistics.search


@pytest.mark.parametrize(
    ("ending", "status"), [(LimitReached(Status.TIME_LIMIT), "time-limit"), (KeyboardInterrupt(), "interrupted")]
)
def test_a_phase_that_was_ended_is_begun_anew(
    ending: BaseException, status: str, problem: Problem, monkeypatch: pytest.MonkeyPatch
) -> None:
    endings = [ending]

    def ground_later(*arguments: Any) -> Grounding:
        if endings:
            raise endings.pop()
        return ground(*arguments)

    monkeypatch.setattr(session, "ground", ground_later)
    planner = Planner(problem)
    first, second = planner.plan(), planner.plan()
    assert (first.status, first.stopped, first.plan) == (status, status, None)
    assert first.statistics.ground_seconds is not None
    assert first.statistics.facts is None
    assert second.status is Status.OPTIMAL


@pytest.mark.parametrize("name", METHODS)
def test_functions_are_methods_of_a_planner_for_one_call(name: str) -> None:
    function, method = getattr(statehtn, name), getattr(Planner, name)
    (first, *others), (_, *own) = (inspect.signature(one).parameters.values() for one in (function, method))
    assert first.name == "problem"
    assert others == own
    assert function.__doc__ == method.__doc__
    assert (function.__name__, function.__qualname__) == (name, name)


def test_what_is_no_problem_is_told_at_once() -> None:
    with pytest.raises(statehtn.UsageError, match="problem"):
        Planner("p1.hddl")
    for name in METHODS:
        with pytest.raises(statehtn.UsageError, match="problem"):
            getattr(statehtn, name)("p1.hddl")
