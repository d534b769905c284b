"""Where the memory is too small for a grid a coarser one follows: what is proven there is a bound, with a gap."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import replace
from fractions import Fraction

import pytest
from hypothesis import given
from hypothesis import strategies as st

import statehtn._relax as _relax
from statehtn import Problem, Status, read_hddl, validate
from statehtn.core import law_grid
from statehtn.core.grounding import ground
from statehtn.core.label_run import LabelRun
from statehtn.core.label_search import search_labels
from statehtn.core.search_run import SearchOutcome
from statehtn.model.cost.scenario_cost import total_of
from statehtn.risk.keep import Keep
from statehtn.risk.objective import Objective
from statehtn.risk.objectives import objective
from tests.all_laws import Budget, best_plans
from tests.correlated_plans import best_plan
from tests.differential.oracles import LIMITS
from tests.exact_objectives import exact_objective
from tests.lotteries import LAWS, SWEPT, budgets, lottery_problems
from tests.scenarios import correlated_lotteries
from tests.shares import share_of_examples

SHARE = share_of_examples(5)
FAMILIES = {**LAWS, **SWEPT}


@contextmanager
def memory_for_coarser_grids() -> Iterator[list[float]]:
    """The memory is too small for the first search; yields the bound of each search, as far as there is one."""
    bounds: list[float] = []
    run_core = LabelRun.run_core

    def run(search: LabelRun) -> _relax.LabelSearchResult:
        limits = search.limits
        try:
            if not bounds:
                search.limits = replace(limits, memory_mb=0.001)
            result = run_core(search)
        finally:
            search.limits = limits
        least = result.statistics.lower_bound
        bounds.append(float("nan") if least is None else search.value_of(least))
        return result

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(LabelRun, "run_core", run)
        patch.setattr(law_grid, "FEWEST_STEPS", 1)
        patch.setattr(law_grid, "FINER", 2)
        yield bounds


def check(problem: Problem, wanted: Objective, keep: Sequence[Budget], best: Fraction | None) -> SearchOutcome:
    kept = tuple(Keep(float(budget), float(probability)) for budget, probability in keep)
    with memory_for_coarser_grids() as bounds:
        *_, outcome = search_labels(ground(problem), wanted, keep=kept, limits=LIMITS)
    if len(bounds) < 2:
        return outcome
    assert outcome.status is Status.OPTIMAL or outcome.stopped is Status.MEMORY_LIMIT
    if best is None:
        assert outcome.plan is None
        return outcome
    assert outcome.status is not Status.UNSOLVABLE
    slack = 1e-9 * max(1.0, abs(float(best)))
    assert outcome.lower_bound is None or outcome.lower_bound <= float(best) + slack
    if outcome.plan is not None:
        costs = validate(problem, outcome.plan).costs
        value = wanted.value(total_of(costs))
        assert value >= float(best) - slack
        assert all(total_of(costs).cdf(float(budget)) >= float(p) - 1e-9 for budget, p in keep)
        assert outcome.status is not Status.OPTIMAL or value <= float(best) + 1e-6 * max(1.0, abs(float(best)))
    return outcome


@pytest.mark.parametrize("family", FAMILIES)
@SHARE
@given(problem=lottery_problems(), data=st.data(), keep=st.one_of(st.just(()), budgets()))
def test_independent_costs(family: str, problem: Problem, data: st.DataObject, keep: tuple[Budget, ...]) -> None:
    text = data.draw(FAMILIES[family])
    best = best_plans(problem, exact_objective(text), keep=keep)
    check(problem, objective(text), keep, best[0].value if best else None)


@SHARE
@given(problem=correlated_lotteries(), text=st.one_of(*FAMILIES.values()), keep=st.one_of(st.just(()), budgets()))
def test_costs_that_hang_together(problem: Problem, text: str, keep: tuple[Budget, ...]) -> None:
    best = best_plan(problem, exact_objective(text), keep)
    check(problem, objective(text), keep, None if best is None else best.value)


def test_the_vehicle_has_a_gap() -> None:
    """On the paper's P1 costs are multiples of a hundredth; on the coarser grid the bound is lower than the value."""
    problem = read_hddl("domains/av/domain.hddl", "domains/av/p1.hddl")
    with memory_for_coarser_grids() as bounds:
        *_, outcome = search_labels(ground(problem), objective("quantile 0.9"))
    assert len(bounds) > 1
    assert outcome.stopped is Status.MEMORY_LIMIT
    assert outcome.status is Status.SOLVED
    assert outcome.plan is not None
    assert outcome.lower_bound is not None
    costs = validate(problem, outcome.plan).costs
    assert 0.9 * (value := total_of(costs).quantile(0.9)) < outcome.lower_bound < value
