"""What the differential tests share: solving within limits, and comparing costs.

Where a limit comes before the answer, `GaveUp` says so: the example is dropped, and counted (see conftest.py).
"""

from __future__ import annotations

from typing import Any

import pytest

from statehtn import Plan, Problem, Result, Status, TopPlans, pipeline, validate
from statehtn.core.heuristics import HEURISTICS
from statehtn.limits import Limits
from statehtn.reference.search_node import Solution
from statehtn.risk import Utility
from statehtn.session import Session
from statehtn.settings import Settings, TopSettings
from tests.brute_force import GaveUp

ADMISSIBLE = [name for name, info in HEURISTICS.items() if info.admissible]
LIMITS = Limits(steps=200_000)  # some tenths of a second, whatever the machine


def solve(problem: Problem, utility: Utility, **options: Any) -> Result:
    """The planner's answer, which a limit may have ended: recursion makes some spaces infinite at no cost."""
    return pipeline.solve(Session(problem), Settings.of(utility, **options), LIMITS)


def solve_top(problem: Problem, utility: Utility, k: int, **options: Any) -> TopPlans:
    """The best plans, as far as they were found within the limit."""
    return pipeline.solve_top(Session(problem), TopSettings.of(k, utility, **options), LIMITS)


def must_have_ended(stopped: Status | None) -> None:
    """Give up where a limit has ended a search."""
    if stopped is not None:
        assert stopped is Status.TIME_LIMIT
        raise GaveUp


def must_cost(problem: Problem, plan: Plan, utility: Utility, cost: float | None) -> None:
    """Require that a plan is valid, and has this risk cost in the states that it runs through."""
    validation = validate(problem, plan)
    assert validation.valid, validation.reasons
    assert validation.risk_cost(utility) == close_to(cost)


def must_agree(problem: Problem, utility: Utility, solution: Solution, **options: Any) -> None:
    """Require that the planner comes to what the readable algorithm has come to; give up where one of them has."""
    if solution.status is Status.GAVE_UP:
        raise GaveUp
    result = solve(problem, utility, **options)
    must_have_ended(result.stopped)
    assert solution.status is result.status
    if solution.plan is not None:
        assert solution.risk_cost == close_to(result.risk_cost)
        must_cost(problem, solution.plan, utility, result.risk_cost)


def close_to(cost: float | None) -> object:
    return pytest.approx(cost, rel=1e-9, abs=1e-9)
