"""The planner's answer is the best there is, for every objective: compared with all plans and the laws of their costs.

What `optimal` promises is a value within 1e-6 of the least one, relative to the value or 1; bounds are bounds to 1e-11.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import fields
from fractions import Fraction

import pytest
from hypothesis import given
from hypothesis import strategies as st

from statehtn import Problem, Result, Status, objective, pipeline, sweeps
from statehtn.core.grounding import ground
from statehtn.core.label_search import search_labels
from statehtn.core.search import last_of
from statehtn.core.switches import LabelSwitches
from statehtn.model import Domain, Method, Signature, TypeHierarchy
from statehtn.risk import Keep
from statehtn.session import Session
from statehtn.settings import Settings, TopSettings
from tests.all_laws import Budget, largest_probability, law_of
from tests.differential.judge import check, check_top, note_attitudes
from tests.differential.oracles import ADMISSIBLE, LIMITS, must_have_ended
from tests.exact_objectives import ExactObjective, exact_objective, of_utility
from tests.lotteries import FAMILIES, budgets, lottery_problems, network_of
from tests.shares import share_of_examples
from tests.strategies import problems

SHARE = share_of_examples(8)

NO_BUDGET: Sequence[Budget] = ()
OPTIONS: list[dict[str, str]] = [
    {},
    {},
    *({"heuristic": heuristic} for heuristic in ADMISSIBLE),
    {"search": "anytime"},
    {"solver": "plan"},
    {"solver": "plan"},
]


def some_problems() -> st.SearchStrategy[Problem]:
    """Mostly lotteries; everything that the language has now and then."""
    return st.one_of(lottery_problems(), lottery_problems(("total",)), problems())


def maybe_budgets() -> st.SearchStrategy[Sequence[Budget]]:
    return st.one_of(st.just(NO_BUDGET), budgets())


def kept(keep: Sequence[Budget]) -> tuple[Keep, ...]:
    return tuple(Keep(float(budget), float(probability)) for budget, probability in keep)


def solve(problem: Problem, text: object, keep: Sequence[Budget], **options: object) -> Result:
    settings = Settings.of(objective(text), keep=kept(keep), **options)
    return sweeps.solve(Session(problem), settings, LIMITS)


def judge(problem: Problem, exact: ExactObjective, keep: Sequence[Budget], result: Result, family: str) -> None:
    best = check(problem, exact, keep, result.status, result.plan, result.value, result.lower_bound, result.stopped)
    if best is not None:
        note_attitudes(family, problem, exact, keep, best.value)


@pytest.mark.parametrize("family", FAMILIES)
@SHARE
@given(problem=some_problems(), data=st.data(), options=st.sampled_from(OPTIONS))
def test_the_best_plan(family: str, problem: Problem, data: st.DataObject, options: dict[str, str]) -> None:
    text = data.draw(FAMILIES[family])
    result = solve(problem, text, NO_BUDGET, **options)
    judge(problem, exact_objective(text), NO_BUDGET, result, family)


@pytest.mark.parametrize("family", FAMILIES)
@SHARE
@given(problem=some_problems(), data=st.data(), keep=budgets(), options=st.sampled_from(OPTIONS))
def test_the_best_plan_that_keeps_budgets(
    family: str, problem: Problem, data: st.DataObject, keep: Sequence[Budget], options: dict[str, str]
) -> None:
    text = data.draw(FAMILIES[family])
    result = solve(problem, text, keep, **options)
    judge(problem, exact_objective(text), keep, result, f"{family}, with budgets")
    if result.status is Status.UNSOLVABLE:
        most = [largest_probability(problem, budget) for budget, _ in keep]
        assert [kept.attained for kept in result.keep] == [
            None if p is None else pytest.approx(float(p), abs=1e-6) for p in most
        ]


UTILITIES = {
    "square": lambda cost: -cost * cost,
    "steps": lambda cost: 2 * (cost <= 9) + (cost <= 12) + 3 * (cost <= 14.5),
    "capped": lambda cost: -min(cost, 11),
    "kinked": lambda cost: -cost - 2 * max(cost - 10, 0),
}


@pytest.mark.parametrize("name", UTILITIES)
@SHARE
@given(problem=some_problems(), keep=maybe_budgets(), options=st.sampled_from(OPTIONS))
def test_utilities_as_functions(name: str, problem: Problem, keep: Sequence[Budget], options: dict[str, str]) -> None:
    result = solve(problem, UTILITIES[name], keep, **options)
    judge(problem, of_utility(UTILITIES[name]), keep, result, "callable")


@pytest.mark.parametrize("family", FAMILIES)
@SHARE
@given(
    problem=some_problems(),
    data=st.data(),
    keep=maybe_budgets(),
    k=st.integers(1, 6),
    distinct=st.sampled_from(("sequence", "multiset")),
)
def test_the_best_plans(
    family: str, problem: Problem, data: st.DataObject, keep: Sequence[Budget], k: int, distinct: str
) -> None:
    text = data.draw(FAMILIES[family])
    settings = TopSettings.of(k, objective(text), distinct, keep=kept(keep))
    found = pipeline.solve_top(Session(problem), settings, LIMITS)
    plans = [(ranked.plan, ranked.value) for ranked in found]
    check_top(problem, exact_objective(text), keep, distinct, k, plans, found.proven, found.lower_bound, found.stopped)


RULES = [field.name for field in fields(LabelSwitches)]


@pytest.mark.parametrize("switch", RULES)
@SHARE
@given(problem=some_problems(), data=st.data(), keep=maybe_budgets(), heuristic=st.sampled_from(ADMISSIBLE))
def test_without_a_rule(
    switch: str, problem: Problem, data: st.DataObject, keep: Sequence[Budget], heuristic: str
) -> None:
    text = data.draw(st.one_of(*FAMILIES.values()))
    outcome = last_of(
        search_labels(
            ground(problem),
            objective(text),
            keep=kept(keep),
            heuristic=heuristic,
            limits=LIMITS,
            switches=LabelSwitches(**{switch: False}),
        )
    )
    must_have_ended(outcome.stopped)
    exact = exact_objective(text)
    value = None if outcome.plan is None else float(exact.value(law_of(problem, outcome.plan.steps)))
    check(problem, exact, keep, outcome.status, outcome.plan, value, outcome.lower_bound, outcome.stopped)


@pytest.mark.parametrize("solver", ["state", "plan"])
@pytest.mark.parametrize("text", ["neutral", "deadline 5", "cvar 0.9", "one-switch alpha=1 tradeoff=1 wealth=3"])
def test_the_plan_without_actions(solver: str, text: str) -> None:
    nothing = Method("nothing", (), "t", (), network_of([], ()))
    domain = Domain("d", TypeHierarchy({}), {}, {}, {}, {"t": Signature("t", ())}, {}, {"nothing": nothing})
    problem = Problem("p", domain, {}, (), network_of(["t"], ()), frozenset(), {})
    for keep in (NO_BUDGET, ((Fraction(1), Fraction(1)),)):
        judge(problem, exact_objective(text), keep, solve(problem, text, keep, solver=solver), "no actions")
