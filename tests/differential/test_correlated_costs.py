"""The best plan where costs hang together is the best of all: compared with every plan's exact law in each scenario."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import fields

import pytest
from hypothesis import given
from hypothesis import strategies as st

from statehtn import Problem, Status, validate
from statehtn.core.grounding import ground
from statehtn.core.label_run import PRECISION
from statehtn.core.label_search import search_labels, search_networks_by_labels
from statehtn.core.labels import Support
from statehtn.core.scenario_labels import ScenarioLabels
from statehtn.core.search_run import SearchOutcome
from statehtn.core.switches import LabelSwitches, LawSwitches, ScenarioSwitches
from statehtn.limits import Limits
from statehtn.model.cost.scenario_cost import total_of
from statehtn.risk.keep import Keep
from statehtn.risk.objective import Objective
from statehtn.risk.objectives import objective
from tests.all_laws import Budget
from tests.correlated_plans import Plan, best_plan
from tests.differential.oracles import LIMITS, must_have_ended
from tests.exact_objectives import SLACK, exact_objective
from tests.lotteries import ALPHAS, FINITE, SWEPT, budgets, texts
from tests.lotteries import LAWS as OF_LAWS_ALONE
from tests.scenarios import correlated_lotteries, correlated_problems, hedging_problems
from tests.shares import share_of_examples

SHARE = share_of_examples(5)

LAWS = {**OF_LAWS_ALONE, **SWEPT}
SWITCHES = [field.name for kind in (ScenarioSwitches, LawSwitches) for field in fields(kind)]
FINITE_SWITCHES = ("one_price_first", "bound_mixes", "compare_boxes", "compare_envelopes", "use_cutoff")
EXPONENTIAL = {
    "averse": texts("averse ", ALPHAS),
    "seeking": texts("seeking ", ALPHAS),
    **{name: FINITE[name] for name in ("one-switch", "exponentials")},
}
ORDERS = [("total",), ("none", "partial")]
TEXTS = st.one_of(*LAWS.values())


def correlated(orders: tuple[str, ...] = ("total", "partial", "none")) -> st.SearchStrategy[Problem]:
    return st.one_of(
        hedging_problems(orders),
        hedging_problems(orders, certain=False),
        correlated_lotteries(orders),
        correlated_lotteries(orders, certain=True),
        correlated_problems(orders),
    )


def search(
    problem: Problem, wanted: Objective, keep: Sequence[Budget] = (), without: Sequence[str] = ()
) -> SearchOutcome:
    switches = LabelSwitches(**dict.fromkeys(without, False))
    kept = tuple(Keep(float(budget), float(probability)) for budget, probability in keep)
    *_, outcome = search_labels(ground(problem), wanted, keep=kept, limits=LIMITS, switches=switches)
    must_have_ended(outcome.stopped)
    return outcome


def check(problem: Problem, outcome: SearchOutcome, wanted: Objective, expected: Plan | None) -> None:
    """The plan is valid, the best there is, and the bound is one."""
    if expected is None:
        assert outcome.status is Status.UNSOLVABLE
        return
    assert outcome.status is Status.OPTIMAL
    (plan,) = outcome.plans
    validation = validate(problem, plan)
    assert validation.valid, validation.reasons
    value, best = wanted.value(total_of(validation.costs)), float(expected.value)
    slack = PRECISION * max(1.0, abs(best))
    assert best - 1e-9 <= value <= best + slack
    assert outcome.lower_bound is not None
    assert value - slack <= outcome.lower_bound <= best + 1e-9 * max(1.0, abs(best))


@pytest.mark.parametrize("family", LAWS)
@pytest.mark.parametrize("orders", ORDERS)
@SHARE
@given(data=st.data())
def test_the_best_plan(family: str, orders: tuple[str, ...], data: st.DataObject) -> None:
    problem, text = data.draw(correlated(orders)), data.draw(LAWS[family])
    wanted = objective(text)
    check(problem, search(problem, wanted), wanted, best_plan(problem, exact_objective(text)))


@SHARE
@given(
    problem=correlated(),
    text=TEXTS,
    keep=st.one_of(st.just(()), budgets()),
    without=st.lists(st.sampled_from(SWITCHES), max_size=2),
)
def test_the_label_search_finds_the_best_plan_by_itself(
    problem: Problem, text: str, keep: tuple[Budget, ...], without: list[str]
) -> None:
    """The searches with one price before it, which mostly find the best plan, leave it their tangents alone."""
    support = ScenarioLabels.support

    def tangents_alone(labels: ScenarioLabels, limits: Limits, share: float = 0.25) -> Iterator[Support]:
        for _ in support(labels, limits, share):
            pass
        yield Support()

    wanted = objective(text)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(ScenarioLabels, "support", tangents_alone)
        outcome = search(problem, wanted, keep, without)
    check(problem, outcome, wanted, best_plan(problem, exact_objective(text), keep))


@pytest.mark.parametrize("family", EXPONENTIAL)
@SHARE
@given(data=st.data(), without=st.one_of(st.just([]), st.lists(st.sampled_from(FINITE_SWITCHES))))
def test_the_best_plan_by_exponentials(family: str, data: st.DataObject, without: list[str]) -> None:
    problem, text = data.draw(correlated()), data.draw(EXPONENTIAL[family])
    if text.startswith("exponentials") and "linear" not in text:
        text = text.replace("exponentials", "exponentials linear=0")
    wanted = objective(text)
    check(problem, search(problem, wanted, (), without), wanted, best_plan(problem, exact_objective(text)))


@SHARE
@given(problem=correlated(), text=st.one_of(TEXTS, *EXPONENTIAL.values()))
def test_the_plan_based_solver_agrees(problem: Problem, text: str) -> None:
    if text.startswith("exponentials") and "linear" not in text:
        text = text.replace("exponentials", "exponentials linear=0")
    wanted = objective(text)
    *_, outcome = search_networks_by_labels(ground(problem), wanted, limits=LIMITS)
    must_have_ended(outcome.stopped)
    check(problem, outcome, wanted, best_plan(problem, exact_objective(text)))


@SHARE
@given(problem=correlated(), text=st.one_of(TEXTS, st.just("neutral"), *EXPONENTIAL.values()), keep=budgets())
def test_budgets_are_kept(problem: Problem, text: str, keep: tuple[Budget, ...]) -> None:
    if text.startswith("exponentials") and "linear" not in text:
        text = text.replace("exponentials", "exponentials linear=0")
    wanted = objective(text)
    outcome = search(problem, wanted, keep)
    check(problem, outcome, wanted, best_plan(problem, exact_objective(text), keep))
    for plan in outcome.plans:
        law = total_of(validate(problem, plan).costs)
        assert all(law.cdf(float(budget)) >= float(probability - SLACK) for budget, probability in keep)


@SHARE
@given(
    problem=correlated(),
    text=TEXTS,
    keep=st.one_of(st.just(()), budgets()),
    without=st.one_of(st.sampled_from(SWITCHES).map(lambda one: [one]), st.lists(st.sampled_from(SWITCHES))),
)
def test_refinements_keep_the_best_plan(
    problem: Problem, text: str, keep: tuple[Budget, ...], without: list[str]
) -> None:
    wanted = objective(text)
    outcome = search(problem, wanted, keep, without)
    check(problem, outcome, wanted, best_plan(problem, exact_objective(text), keep))
