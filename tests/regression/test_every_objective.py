"""Each objective's plan is the best of all: on problems whose plans are few enough to value every one of them."""

from __future__ import annotations

import math
from functools import cache

import pytest

import statehtn
from statehtn import Plan, Status
from statehtn.risk import Objective, objective
from tests.regression.paper_tables import problem

INSTANCES = {
    "av": ("p1", 16, "sequence"),
    "marine": ("p1", 456, "sequence"),
    "satellite": ("RA-3obs-1sat-3mod-unordered", 189, "multiset"),
}
"""By domain: a problem, how many plans it has, and when two of them are different."""
BUDGETS = {"av": (16.5, 18.35, 20), "marine": (32, 36.4, 38), "satellite": (215, 230, 245)}
ANY_BUDGET = (
    *("neutral", "averse 0.1", "averse 0.9", "seeking 0.1", "seeking 0.9", "mean-variance 0.01", "mean-variance 0.5"),
    *("mean-deviation 0.2", "mean-deviation 2", "exponentials linear=1 0.1:0.5 0.2:0.001", "evar 0.5", "evar 0.95"),
    *("quantile 0.5", "quantile 0.9", "quantile 0.99", "cvar 0.5", "cvar 0.95", "mean-cvar 0.9 0.25"),
    "success-utility alpha=0.1",
)
OF_A_BUDGET = (
    "deadline {0}",
    "overrun {0}",
    "piecewise 0:0 {0}:0 {1}:-1",
    "piecewise 0:0 {0}:-1 {1}:-4",
    "one-switch alpha=0.9 tradeoff=20 wealth={0}",
    "one-switch alpha=0.05 tradeoff=1 wealth={1}",
)
CASES = [
    (domain, form.format(*budgets[index : index + 2]))
    for domain, budgets in BUDGETS.items()
    for form, starts in [*((form, (0, 1)) for form in OF_A_BUDGET), *((form, (0,)) for form in ANY_BUDGET)]
    for index in starts
]
PRECISION = 1e-6


@cache
def all_plans(domain: str) -> tuple[Plan, ...]:
    """Return every plan of the domain's instance, with what its steps cost."""
    name, count, distinct = INSTANCES[domain]
    found = statehtn.top_plans(problem(domain, name), 1000, distinct=distinct)  # type: ignore[arg-type]
    assert (len(found), found.is_all) == (count, True)
    return tuple(ranked.plan for ranked in found)


def least(domain: str, wanted: Objective, among: tuple[Plan, ...] | None = None) -> float:
    plans = all_plans(domain) if among is None else among
    return min(wanted.value(plan.cost_distribution()) for plan in plans)


def check(result: statehtn.Result, expected: float) -> None:
    """A result is optimal at this value, to the precision that is promised, and says so consistently."""
    assert result.status is Status.OPTIMAL
    assert result.plan is not None
    slack = PRECISION * max(1.0, abs(expected))
    assert result.value == pytest.approx(result.objective.value(result.plan.cost_distribution()), rel=1e-12, abs=1e-12)
    assert result.value == pytest.approx(expected, rel=0, abs=slack)
    assert result.lower_bound is not None
    assert result.lower_bound <= expected + 1e-12 * max(1.0, abs(expected))
    assert result.gap is not None
    assert 0 <= result.gap <= slack * (1 + 1e-9)


@pytest.mark.parametrize(("domain", "text"), CASES)
def test_the_plan_is_the_best_of_all(domain: str, text: str) -> None:
    wanted = objective(text)
    check(statehtn.plan(problem(domain, INSTANCES[domain][0]), objective=text), least(domain, wanted))


@pytest.mark.parametrize("domain", INSTANCES)
def test_a_function_that_is_no_other_objective(domain: str) -> None:
    low, high = BUDGETS[domain][0], BUDGETS[domain][-1]

    def utility(cost: float) -> float:
        return -math.tanh((cost - low) / (high - low)) - (cost > high)

    result = statehtn.plan(problem(domain, INSTANCES[domain][0]), objective=utility)
    check(result, least(domain, objective(utility)))
    assert result.value_unit == "utility"
    assert result.problem_class == "PS1020*"


@pytest.mark.parametrize("text", ["cvar 0.9", "deadline {}", "one-switch alpha=0.9 tradeoff=20 wealth={}"])
@pytest.mark.parametrize("domain", INSTANCES)
def test_the_best_plans_are_those_of_least_value(domain: str, text: str) -> None:
    name, _, distinct = INSTANCES[domain]
    wanted = objective(text.format(BUDGETS[domain][1]))
    found = statehtn.top_plans(problem(domain, name), 5, objective=wanted, distinct=distinct)  # type: ignore[arg-type]
    values = sorted(wanted.value(plan.cost_distribution()) for plan in all_plans(domain))
    assert found.status is Status.OPTIMAL
    assert [plan.value for plan in found] == pytest.approx(values[:5], rel=PRECISION, abs=PRECISION)


@pytest.mark.parametrize("text", ["neutral", "seeking 0.9", "mean-variance 0.01", "mean-deviation 0.2", "cvar 0.5"])
@pytest.mark.parametrize("domain", INSTANCES)
def test_budgets_are_kept(domain: str, text: str) -> None:
    wanted, budget = objective(text), BUDGETS[domain][-1]
    laws = [plan.cost_distribution() for plan in all_plans(domain)]
    probabilities = sorted({round(law.cdf(budget), 9) for law in laws})
    for asked in {probabilities[-1], probabilities[len(probabilities) // 2]} - {0.0}:
        keep = statehtn.Keep(budget, asked - 1e-10)
        result = statehtn.plan(problem(domain, INSTANCES[domain][0]), objective=text, keep=keep)
        keeping = tuple(plan for plan in all_plans(domain) if keep.holds(plan.cost_distribution()))
        check(result, least(domain, wanted, keeping))
        (kept,) = result.keep
        assert kept.attained is not None
        assert kept.attained >= keep.probability


def test_budgets_that_no_plan_keeps() -> None:
    result = statehtn.plan(problem("av", "p1"), keep=["12 0.9", "16.5 0.2"])
    laws = [plan.cost_distribution() for plan in all_plans("av")]
    assert result.status is Status.UNSOLVABLE
    assert [kept.attained for kept in result.keep] == pytest.approx(
        [max(law.cdf(budget) for law in laws) for budget in (12, 16.5)]
    )


@pytest.mark.parametrize(("wealth", "mean"), [(10, 19.4), (24, 19.4), (40, 18.35)])
def test_an_agent_of_one_switch_is_careful_when_little_is_left(wealth: float, mean: float) -> None:
    """Alpha 0.9, tradeoff 20: like an averse agent until it has enough, then like a neutral one."""
    result = statehtn.plan(problem("av", "p1"), objective=f"one-switch alpha=0.9 tradeoff=20 wealth={wealth}")
    assert result.status is Status.OPTIMAL
    assert result.expected_cost == pytest.approx(mean)
    if wealth == 40:  # of three plans with this mean, the least risky
        assert result.plan is not None
        deviations = [
            law.standard_deviation for law in map(Plan.cost_distribution, all_plans("av")) if law.mean < 18.36
        ]
        assert len(deviations) == 3
        assert result.plan.cost_distribution().standard_deviation == pytest.approx(min(deviations))
