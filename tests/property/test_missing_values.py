"""A plan that is optimal where numbers are missing is optimal whatever they are."""

from __future__ import annotations

import warnings
from dataclasses import replace
from fractions import Fraction

import pytest
from hypothesis import HealthCheck, event, given, settings
from hypothesis import strategies as st

import statehtn
from statehtn.model import Action, CostBlock, FunctionTerm, Number, Problem
from statehtn.model.cost.unknown import MissingNumber
from statehtn.result import Result
from statehtn.risk import Exponential, Utility
from statehtn.settings import SolverName
from tests.strategies import FUNCTION, problems, utilities

MISSING = (FUNCTION, "o0")


def priced(action: Action) -> Action:
    """The action with a further cost: the value that is to be missing."""
    block = CostBlock(((Number(Fraction(1)), FunctionTerm(FUNCTION, MISSING[1:])),))
    return replace(action, costs=(*action.costs, block))


def solved(problem: Problem, utility: Utility, solver: SolverName) -> Result:
    alpha = utility.alpha if isinstance(utility, Exponential) else None
    return statehtn.plan(problem, attitude=utility.attitude, alpha=alpha, solver=solver, time_limit=5)


@settings(deadline=None, suppress_health_check=[HealthCheck.too_slow, HealthCheck.data_too_large])
@given(problems(), utilities(), st.sampled_from(("state", "state", "plan")), st.sets(st.sampled_from(range(5))))
def test_what_is_optimal_is_optimal_for_all_numbers(
    problem: Problem, utility: Utility, solver: SolverName, uncertain: set[int]
) -> None:
    domain = problem.domain
    names = {f"a{number}" for number in uncertain}
    actions = {name: priced(action) if name in names else action for name, action in domain.actions.items()}
    problem = replace(problem, domain=replace(domain, actions=actions))
    values = {key: value for key, value in problem.function_values.items() if key != MISSING}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        try:
            result = solved(replace(problem, function_values=values), utility, solver)
        except MissingNumber:
            event("the best plan needs it")
            return
        event(f"{result.status.value}{'' if result.plan is None else ', with a plan'}")
        if result.status is not statehtn.Status.OPTIMAL:
            return
        for number in (0, Fraction(1, 2), 50):
            complete = {**values, MISSING: Fraction(number)}
            other = solved(replace(problem, function_values=complete), utility, solver)
            if other.status is statehtn.Status.OPTIMAL:
                assert other.risk_cost == pytest.approx(result.risk_cost, rel=1e-9, abs=1e-9)
