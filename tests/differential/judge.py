"""Results of the planner for any objective, compared with all plans and the exact laws of what they cost."""

from __future__ import annotations

import itertools
from collections import Counter
from collections.abc import Sequence
from fractions import Fraction

import pytest

from statehtn import Plan, Problem, Status, validate
from tests.all_laws import Best, Budget, all_outlooks, best_plans, law_of
from tests.brute_force import GaveUp
from tests.differential.oracles import must_have_ended
from tests.exact_laws import Law
from tests.exact_objectives import SLACK, ExactObjective
from tests.one_attitude import is_best_for_none

PRECISION = 1e-6  # of what is called optimal, times the value or 1
ROUNDING = 1e-11  # of values that are computed with floats
EXPLAINED = Counter[tuple[str, str]]()
"""How many cases of each family were `decided`, how many of them have `finite` numbers of plans, and of how many of
these no neutral or exponential agent explains the choice."""


def within(value: float) -> float:
    """The error that is allowed to a value that is called optimal."""
    return PRECISION * max(1.0, abs(value))


def rounding(value: float) -> float:
    """The error that is allowed to any value and bound."""
    return ROUNDING * max(1.0, abs(value))


def check(
    problem: Problem,
    exact: ExactObjective,
    keep: Sequence[Budget],
    status: Status,
    plan: Plan | None,
    value: float | None,
    bound: float | None,
    stopped: Status | None,
) -> Best | None:
    """Judge the answer for one plan; returns a best one."""
    best = best_plans(problem, exact, keep=keep)
    if not best:
        assert plan is None
        must_have_ended(stopped)
        assert status is Status.UNSOLVABLE
        return None
    least = float(best[0].value)
    assert status is not Status.UNSOLVABLE
    assert bound is None or bound <= least + rounding(least)
    if plan is not None:
        assert value is not None
        must_be_worth(problem, exact, keep, plan, value)
        assert least <= value + rounding(value)
    must_have_ended(stopped)
    assert status is Status.OPTIMAL
    assert value <= least + within(value)
    assert bound is not None
    assert value - bound <= within(value) + rounding(value)
    return best[0]


def must_be_worth(problem: Problem, exact: ExactObjective, keep: Sequence[Budget], plan: Plan, value: float) -> None:
    """Require that a plan is valid, has this value and keeps the budgets."""
    validation = validate(problem, plan)
    assert validation.valid, validation.reasons
    law = law_of(problem, plan.steps)
    assert value == pytest.approx(float(exact.value(law)), rel=ROUNDING, abs=ROUNDING)
    for budget, probability in keep:
        assert law.at_most(budget) >= probability - 2 * SLACK


def check_top(
    problem: Problem,
    exact: ExactObjective,
    keep: Sequence[Budget],
    distinct: str,
    k: int,
    plans: Sequence[tuple[Plan, float]],
    proven: int,
    bound: float | None,
    stopped: Status | None,
) -> None:
    """Judge the k best plans, each given with its value."""
    expected = [float(best.value) for best in best_plans(problem, exact, k + 1, distinct, keep)]
    names = [tuple(map(str, plan.steps)) for plan, _ in plans]
    keys = {name if distinct == "sequence" else tuple(sorted(name)) for name in names}
    assert len(keys) == len(plans) <= k
    for plan, value in plans:
        must_be_worth(problem, exact, keep, plan, value)
    values = [value for _, value in plans]
    assert all(one <= other + rounding(one) for one, other in itertools.pairwise(values))
    for value, least in zip(values, expected, strict=False):
        assert least <= value + rounding(value)
    for value, least in zip(values[:proven], expected, strict=False):
        assert value <= least + within(value)
    must_have_ended(stopped)
    assert proven == len(values) == min(k, len(expected))
    if bound is not None and len(expected) > k:
        assert bound <= expected[k] + rounding(expected[k])


def note_attitudes(
    family: str, problem: Problem, exact: ExactObjective, keep: Sequence[Budget], least: Fraction
) -> None:
    """Count a case, and whether none of its best plans is the best for any neutral or exponential agent."""
    EXPLAINED[family, "decided"] += 1
    try:
        laws = [outlook.law for outlook in all_outlooks(problem)]
    except GaveUp:  # there are too many plans to tell
        return
    EXPLAINED[family, "finite"] += 1
    kept = [law for law in laws if keeps(law, keep)]
    best = [law for law in kept if exact.value(law) - least <= Fraction(PRECISION) * max(1, abs(least))]
    if all(is_best_for_none(law, laws) for law in best):
        EXPLAINED[family, "unexplained"] += 1


def keeps(law: Law, keep: Sequence[Budget]) -> bool:
    return all(law.at_most(budget) >= probability - SLACK for budget, probability in keep)
