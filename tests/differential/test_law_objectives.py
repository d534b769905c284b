"""The plan by an objective that needs the law of the cost is the best of all: compared with every plan's exact law."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import fields
from fractions import Fraction

import pytest
from hypothesis import given
from hypothesis import strategies as st

import statehtn._relax as _relax
from statehtn import Problem, Status, validate
from statehtn.core import law_grid, law_labels
from statehtn.core.grounding import ground
from statehtn.core.label_run import PRECISION
from statehtn.core.label_search import search_labels
from statehtn.core.law_labels import LawLabels
from statehtn.core.search_run import SearchOutcome
from statehtn.core.switches import LabelSwitches, LawSwitches, TopSwitches
from statehtn.limits import Limits
from statehtn.model.cost.sum import total_cost
from statehtn.risk.deadline import Deadline
from statehtn.risk.keep import Keep
from statehtn.risk.objective import Objective
from statehtn.risk.objectives import objective
from tests.all_laws import Best, Budget, all_outlooks, best_plans
from tests.differential.oracles import LIMITS, must_have_ended
from tests.exact_objectives import SLACK, exact_objective, of_utility
from tests.lotteries import LAWS as OF_LAWS_ALONE
from tests.lotteries import SWEPT, budgets, lottery_problems
from tests.shares import share_of_examples
from tests.strategies import problems

SHARE = share_of_examples(5)

LAWS = {**OF_LAWS_ALONE, **SWEPT}
SWITCHES = [field.name for kind in (LawSwitches, TopSwitches) for field in fields(kind)]
PROBLEMS = st.one_of(lottery_problems(), problems())
ORDERS = [("total",), ("none", "partial")]


def search(
    problem: Problem, wanted: Objective, keep: Sequence[Budget] = (), without: str | None = None
) -> SearchOutcome:
    switches = LabelSwitches(**({without: False} if without else {}))
    kept = tuple(Keep(float(budget), float(probability)) for budget, probability in keep)
    *_, outcome = search_labels(ground(problem), wanted, keep=kept, limits=LIMITS, switches=switches)
    must_have_ended(outcome.stopped)
    return outcome


def check(problem: Problem, outcome: SearchOutcome, wanted: Objective, expected: list[Best]) -> None:
    """The plan is valid, the best there is, and the bound is one."""
    if not expected:
        assert outcome.status is Status.UNSOLVABLE
        return
    assert outcome.status is Status.OPTIMAL
    plan = next(iter(outcome.plans))
    validation = validate(problem, plan)
    assert validation.valid, validation.reasons
    value = wanted.value(total_cost(validation.costs))
    best = float(expected[0].value)
    slack = PRECISION * max(1.0, abs(best))
    assert best - 1e-9 <= value <= best + slack
    assert outcome.lower_bound is not None
    assert value - slack <= outcome.lower_bound <= best + 1e-9 * max(1.0, abs(best))


@pytest.mark.parametrize("family", LAWS)
@pytest.mark.parametrize("orders", ORDERS)
@SHARE
@given(data=st.data())
def test_the_best_plan(family: str, orders: tuple[str, ...], data: st.DataObject) -> None:
    problem = data.draw(st.one_of(lottery_problems(orders), problems(orders)))
    text = data.draw(LAWS[family])
    wanted = objective(text)
    check(problem, search(problem, wanted), wanted, best_plans(problem, exact_objective(text)))


@SHARE
@given(problem=PROBLEMS, text=st.one_of(*LAWS.values(), st.just("neutral")), keep=budgets())
def test_budgets_are_kept(problem: Problem, text: str, keep: tuple[Budget, ...]) -> None:
    wanted = objective(text)
    outcome = search(problem, wanted, keep)
    check(problem, outcome, wanted, best_plans(problem, exact_objective(text), keep=keep))
    for plan in outcome.plans:
        law = total_cost(validate(problem, plan).costs)
        assert all(law.cdf(float(budget)) >= float(probability - SLACK) for budget, probability in keep)


@SHARE
@given(
    problem=PROBLEMS,
    text=st.one_of(*LAWS.values()),
    keep=st.one_of(st.just(()), budgets()),
    switch=st.sampled_from(SWITCHES),
)
def test_refinements_keep_the_best_plan(problem: Problem, text: str, keep: tuple[Budget, ...], switch: str) -> None:
    wanted = objective(text)
    outcome = search(problem, wanted, keep, switch)
    check(problem, outcome, wanted, best_plans(problem, exact_objective(text), keep=keep))


@SHARE
@given(problem=PROBLEMS, falls=st.lists(st.integers(0, 4), min_size=1, max_size=30))
def test_utilities_that_are_functions(problem: Problem, falls: list[int]) -> None:
    """The utility falls by so much from each whole cost to the next, in steps, and stays."""

    def exact(cost: Fraction) -> Fraction:
        return Fraction(-sum(falls[: int(cost)]))

    wanted = objective(lambda cost: float(-sum(falls[: int(cost)])))
    check(problem, search(problem, wanted), wanted, best_plans(problem, of_utility(exact)))


@SHARE
@given(problem=PROBLEMS, text=st.one_of(*LAWS.values()), keep=st.one_of(st.just(()), budgets()))
def test_coarse_laws_become_exact(problem: Problem, text: str, keep: tuple[Budget, ...]) -> None:
    wanted = objective(text)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(law_grid, "EXACT_STEPS", 2)
        patch.setattr(law_grid, "FIRST_STEPS", 2)
        patch.setattr(law_labels, "FIRST_OUTCOMES", 2)
        patch.setattr(law_labels, "MORE_OUTCOMES", 2)
        outcome = search(problem, wanted, keep)
    check(problem, outcome, wanted, best_plans(problem, exact_objective(text), keep=keep))


@SHARE
@given(problem=PROBLEMS, data=st.data())
def test_no_plan_is_below_the_graph_of_laws(problem: Problem, data: st.DataObject) -> None:
    """The law of the initial task bounds every plan's probability to keep a budget, and so do rounded-down ones."""
    outlooks = all_outlooks(problem)
    grounding = ground(problem)
    if not outlooks or not grounding.handle.solvable:
        return
    wanted = Deadline(data.draw(st.sampled_from((5.0, 12.0, 40.0))))
    labels = LawLabels(grounding, wanted, LabelSwitches(), Limits())
    labels._options.graph_outcomes = data.draw(st.sampled_from((3, 256)))
    valuation = labels.valuation
    assert isinstance(valuation, _relax.LawValuation)
    at, probabilities = valuation.law_of_task(grounding.handle.initial_task)
    step = labels.grid.grid.step
    for budget in {cost for outlook in outlooks for cost, _ in outlook.law.outcomes if cost <= wanted.budget}:
        best = max(outlook.law.at_most(budget) for outlook in outlooks)
        kept = sum(p for cost, p in zip(at, probabilities, strict=True) if int(cost) * step <= budget)
        assert kept >= float(best) - 1e-12
