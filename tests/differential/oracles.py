"""What the differential tests share: solving within limits, and comparing costs."""

from __future__ import annotations

import pytest
from hypothesis import assume

import statehtn
from statehtn.core.heuristics import HEURISTICS
from statehtn.model import Problem
from statehtn.risk import Utility
from tests.brute_force import GaveUp, optimal_risk_cost

ADMISSIBLE = [name for name, info in HEURISTICS.items() if info.admissible]
SECONDS = 0.5


def brute_force(problem: Problem, utility: Utility) -> float | None:
    """The optimum by exhaustion; the example is dropped if that takes too long."""
    try:
        return optimal_risk_cost(problem, utility)
    except GaveUp:
        assume(False)
        raise


def solve(problem: Problem, utility: Utility, **options: object) -> statehtn.Result:
    """The planner's answer, which a limit may have ended: recursion makes some spaces infinite at no cost."""
    return statehtn.plan(problem, attitude=utility.attitude, alpha=utility.alpha, time_limit=SECONDS, **options)


def solve_or_drop(problem: Problem, utility: Utility, **options: object) -> statehtn.Result:
    """The planner's answer; the example is dropped if a limit came first."""
    result = solve(problem, utility, **options)
    assume(result.status is not statehtn.Status.TIME_LIMIT)
    return result


def close_to(cost: float) -> object:
    return pytest.approx(cost, rel=1e-9, abs=1e-9)
