"""Random problems to unified-planning and back."""

from __future__ import annotations

from dataclasses import replace

from hypothesis import assume, given
from hypothesis import strategies as st

import statehtn
from statehtn import Problem, Status, UnsupportedError, validate
from statehtn.engine import StateHtnEngine
from statehtn.interop.conversion import Conversion
from statehtn.model import Equals, Not
from statehtn.model.cost.ground_cost import is_unconditional
from tests.differential.oracles import close_to, must_have_ended, solve
from tests.normal_form import normal_form
from tests.strategies import problems, utilities


@st.composite
def expressible(draw: st.DrawFn) -> Problem:
    """A problem that unified-planning can hold, with a constraint in a method now and then."""
    problem = draw(problems())
    domain = problem.domain
    actions = {}
    for name, action in domain.actions.items():
        actions[name] = replace(action, costs=tuple(filter(is_unconditional, action.costs)))
    methods = {}
    for name, method in domain.methods.items():
        if len(method.parameters) > 1 and draw(st.booleans()):
            first, second, *_ = (parameter.name for parameter in method.parameters)
            constraint = draw(st.sampled_from((Equals(first, second), Not(Equals(first, second)))))
            method = replace(method, network=replace(method.network, constraints=constraint))
        methods[name] = method
    return replace(problem, domain=replace(domain, actions=actions, methods=methods))


def to_up_or_drop(problem: Problem) -> Conversion:
    """The conversion; the example is dropped where a variable's type is wider than a predicate's."""
    try:
        return Conversion.to_up(problem)
    except UnsupportedError as error:
        assume("wider" not in str(error))
        raise


@given(problem=expressible())
def test_round_trip(problem: Problem) -> None:
    up_problem = to_up_or_drop(problem).up_problem
    back = statehtn.from_unified_planning(up_problem, statehtn.cost_distributions(problem))
    assert normal_form(back) == normal_form(problem)
    assert StateHtnEngine.supports(up_problem.kind)
    again = statehtn.to_unified_planning(back)
    assert set(again.actions) == set(up_problem.actions)
    assert set(again.methods) == set(up_problem.methods)
    assert again.task_network == up_problem.task_network
    assert again.initial_values == up_problem.initial_values
    assert again.quality_metrics == up_problem.quality_metrics


@given(problem=expressible(), utility=utilities())
def test_plans_go_both_ways(problem: Problem, utility: object) -> None:
    conversion = to_up_or_drop(problem)
    back = Conversion.from_up(conversion.up_problem, statehtn.cost_distributions(problem))
    result = solve(problem, utility, search="anytime")
    mirrored = solve(back.problem, utility)
    must_have_ended(result.stopped or mirrored.stopped)
    assert (result.plan is None) == (mirrored.plan is None)
    if result.status is Status.OPTIMAL and result.plan is not None and mirrored.plan is not None:
        assert mirrored.risk_cost == close_to(result.risk_cost)
    if mirrored.plan is not None:
        theirs = back.plan_to_up(mirrored.plan)
        ours = back.plan_from_up(theirs)
        assert (ours.steps, ours.roots) == (mirrored.plan.steps, mirrored.plan.roots)
        assert validate(problem, conversion.plan_from_up(theirs)).valid
