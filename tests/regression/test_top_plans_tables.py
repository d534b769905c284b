"""The paper's tables of several plans come out of one call each: the vehicle's sixteen plans, the satellite's three."""

from __future__ import annotations

from functools import cache

import pytest

import statehtn
from statehtn import RankedPlan, Status, TopPlans
from statehtn.experiments.report.paper_tables import agrees
from tests.regression.paper_tables import actions, problem, rows
from tests.regression.test_av_tables import plan_key
from tests.regression.test_satellite_tables import SMALLEST

AGENTS = {"seeking": 0.9, "averse": 0.9, "neutral": None}
SIXTEEN = {plan_key(row): row for row in rows("av_p1_plans")}
THREE = {tuple(row["actions"].split()): row for row in rows("satellite_three_plans")}


@cache
def plans_of_p1(attitude: str, k: int = 16) -> TopPlans:
    return statehtn.top_plans(problem("av", "p1"), k, attitude=attitude, alpha=AGENTS[attitude])


def row_of(ranked: RankedPlan) -> dict[str, str]:
    """The paper's line about a plan of P1."""
    drives = [step.arguments for step in ranked.plan.steps if step.action in ("accelerate", "decelerate")]
    return SIXTEEN[("s", *(to for _, to in drives)), actions(ranked.plan)]


@pytest.mark.parametrize("attitude", AGENTS)
def test_the_sixteen_plans(attitude: str) -> None:
    plans = plans_of_p1(attitude)
    assert plans.status is Status.OPTIMAL
    assert plans.proven == len(plans) == 16
    assert {row_of(ranked)["plan"] for ranked in plans} == {str(number) for number in range(1, 17)}
    for ranked in plans:
        row = row_of(ranked)
        assert ranked.length == int(row["length"])
        assert agrees(ranked.expected_cost, row["expected_cost_printed"])
        if attitude == "neutral":
            assert ranked.log10_expected_utility is None
        else:
            assert agrees(ranked.log10_expected_utility, row[f"log10_eu_{attitude}_recomputed"])
            if row["remark"] != f"{attitude} value misprinted":
                assert agrees(ranked.log10_expected_utility, row[f"log10_eu_{attitude}_printed"])


@pytest.mark.parametrize("attitude", AGENTS)
def test_the_sixteen_plans_come_in_the_order_of_their_values(attitude: str) -> None:
    column = "expected_cost_recomputed" if attitude == "neutral" else f"log10_eu_{attitude}_recomputed"
    values = [float(row_of(ranked)[column]) for ranked in plans_of_p1(attitude)]
    assert values == sorted(values, reverse=attitude != "neutral")


@pytest.mark.parametrize("attitude", AGENTS)
def test_there_is_no_seventeenth_plan(attitude: str) -> None:
    plans = plans_of_p1(attitude, 17)
    assert plans.is_all
    assert plans.lower_bound is None
    assert [ranked.plan.steps for ranked in plans] == [ranked.plan.steps for ranked in plans_of_p1(attitude)]
    fewer = plans_of_p1(attitude, 5)  # of those that tie, any
    assert not fewer.is_all
    assert [ranked.risk_cost for ranked in fewer] == pytest.approx([ranked.risk_cost for ranked in plans[:5]])


@pytest.mark.parametrize(("attitude", "first"), [("seeking", 1), ("averse", 3), ("neutral", 2)])
def test_the_three_plans_of_the_satellite(attitude: str, first: int) -> None:
    alpha = None if attitude == "neutral" else 0.5
    plans = statehtn.top_plans(problem("satellite", SMALLEST), 10, attitude=attitude, alpha=alpha)
    # Beside the paper's three: the second with two arguments the other way round, and one with the second's values.
    assert plans.is_all
    assert len(plans) == 5
    of_the_paper = [(ranked, THREE[actions(ranked.plan)]) for ranked in plans if actions(ranked.plan) in THREE]
    assert {row["plan"] for _, row in of_the_paper} == {"1", "2", "3"}
    if attitude == "neutral":  # the first three tie
        assert str(first) in {row["plan"] for ranked, row in of_the_paper if ranked.rank <= 3}
    else:
        assert of_the_paper[0][0].rank == 1
        assert of_the_paper[0][1]["plan"] == str(first)
    for ranked, row in of_the_paper:
        if attitude == "neutral":
            assert agrees(ranked.expected_utility, row["expected_utility_neutral_printed"])
            continue
        assert agrees(ranked.expected_utility, row[f"expected_utility_{attitude}_printed"])
        column = "recomputed" if attitude == "seeking" and row["remark"] else "printed"
        assert agrees(ranked.log10_expected_utility, row[f"log10_eu_{attitude}_{column}"])


@pytest.mark.parametrize("attitude", ["seeking", "averse"])
def test_the_plans_of_the_satellite_differ_in_more_than_their_order(attitude: str) -> None:
    satellite = problem("satellite", SMALLEST)
    by_sequence, by_multiset = (
        statehtn.top_plans(satellite, 10, attitude=attitude, alpha=0.5, distinct=name)
        for name in ("sequence", "multiset")
    )
    assert [ranked.plan.steps for ranked in by_sequence] == [ranked.plan.steps for ranked in by_multiset]
