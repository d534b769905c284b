"""The paper's results on the Satellite problems: the 48 rows of table 2, its three plans, its remark on alpha 0.1."""

from __future__ import annotations

from functools import cache

import pytest

from statehtn.experiments.report.paper_tables import agrees
from statehtn.model import CostLaw, Plan
from statehtn.risk import expected_utility_text, plan_expected_cost, plan_risk_cost, utility_for
from statehtn.validation import validate
from tests.brute_force import all_plans
from tests.regression.paper_tables import (
    ADMISSIBLE_HEURISTICS,
    actions,
    alpha_of,
    instances,
    problem,
    rows,
    solve,
)

RESULT_ROWS = rows("satellite_results")
THREE_PLANS = rows("satellite_three_plans")
ORDERED = [name for name in instances("satellite") if not name.endswith("-unordered")]

SMALLEST = "RA-3obs-1sat-3mod"


def row_id(row: dict[str, str]) -> str:
    return f"{row['instance']}-{row['attitude']}"


@cache
def plans_of_the_smallest() -> dict[tuple[str, ...], tuple[Plan, tuple[CostLaw, ...]]]:
    """One plan of RA-3obs-1sat-3mod with its cost laws for every sequence of action names."""
    found: dict[tuple[str, ...], tuple[Plan, tuple[CostLaw, ...]]] = {}
    for plan in all_plans(problem("satellite", SMALLEST)):
        validation = validate(problem("satellite", SMALLEST), plan)
        assert validation.valid, validation.reasons
        found[actions(plan)] = (plan, validation.costs)
    return found


def test_every_row_has_its_instance() -> None:
    assert {row["instance"] for row in RESULT_ROWS} == set(ORDERED)
    assert len(RESULT_ROWS) == 48
    assert {f"{name}-unordered" for name in ORDERED} <= set(instances("satellite"))


@pytest.mark.parametrize("row", RESULT_ROWS, ids=row_id)
def test_table_2(row: dict[str, str]) -> None:
    result = solve("satellite", row["instance"], row["attitude"], alpha_of(row))
    assert agrees(result.expected_utility, row["expected_utility_printed"])
    assert agrees(result.expected_cost, row["expected_cost_corrected"])
    assert result.length == int(row["length"])
    if row["attitude"] == "neutral":
        return
    assert agrees(result.log10_expected_utility, row["log10_eu_recomputed"])
    if not row["remark"].startswith("printed log10"):
        assert agrees(result.log10_expected_utility, row["log10_eu_printed"])


@pytest.mark.parametrize("heuristic", [name for name in ADMISSIBLE_HEURISTICS if name != "lmcut"])
@pytest.mark.parametrize("row", RESULT_ROWS, ids=row_id)
def test_every_heuristic_proves_the_same_optimum(row: dict[str, str], heuristic: str) -> None:
    problem_and_agent = ("satellite", row["instance"], row["attitude"], alpha_of(row))
    expected = solve(*problem_and_agent).risk_cost
    assert solve(*problem_and_agent, heuristic).risk_cost == pytest.approx(expected, rel=1e-9)


@pytest.mark.parametrize("row", THREE_PLANS, ids=lambda row: f"plan{row['plan']}")
def test_the_three_plans(row: dict[str, str]) -> None:
    _, laws = plans_of_the_smallest()[tuple(row["actions"].split())]
    for attitude in ("seeking", "averse"):
        utility = utility_for(attitude, 0.5)
        log10 = utility.log10_expected_utility(plan_risk_cost(laws, utility))
        assert agrees(expected_utility_text(laws, utility), row[f"expected_utility_{attitude}_printed"])
        column = "recomputed" if attitude == "seeking" and row["remark"] else "printed"
        assert agrees(log10, row[f"log10_eu_{attitude}_{column}"])
    assert agrees(-plan_expected_cost(laws), row["expected_utility_neutral_printed"])


def test_the_smallest_has_four_plans_up_to_the_order_of_arguments() -> None:
    # Beside the paper's three: the first instrument is replaced by the second, and the third is overloaded onto that.
    assert len(plans_of_the_smallest()) == 4
    assert len(all_plans(problem("satellite", SMALLEST))) == 5
    (fourth,) = set(plans_of_the_smallest()) - {tuple(row["actions"].split()) for row in THREE_PLANS}
    assert len(fourth) == 16
    assert fourth.count("overload") == 1


@pytest.mark.parametrize(("attitude", "number"), [("seeking", 0), ("neutral", 1), ("averse", 2)])
def test_each_attitude_chooses_its_plan(attitude: str, number: int) -> None:
    alpha = None if attitude == "neutral" else 0.5
    result = solve("satellite", SMALLEST, attitude, alpha)
    assert result.plan is not None
    chosen = actions(result.plan)
    if attitude == "neutral":  # the fourth plan ties with the second
        _, laws = plans_of_the_smallest()[chosen]
        assert plan_expected_cost(laws) == pytest.approx(240.85)
    else:
        assert chosen == tuple(THREE_PLANS[number]["actions"].split())


@pytest.mark.parametrize("instance", ORDERED)
def test_a_slightly_averse_satellite_never_powers_three_instruments(instance: str) -> None:
    result = solve("satellite", instance, "averse", 0.1)
    assert result.plan is not None
    assert "superload" not in actions(result.plan)


def test_a_slightly_averse_satellite_sometimes_powers_two_instruments() -> None:
    plans = [solve("satellite", instance, "averse", 0.1).plan for instance in ORDERED]
    assert any(plan is not None and "overload" in actions(plan) for plan in plans)


@pytest.mark.parametrize(("attitude", "alpha"), [("seeking", 0.1), ("seeking", 0.9), ("averse", 0.9)])
@pytest.mark.parametrize("instance", ORDERED)
def test_other_intensities_change_nothing(instance: str, attitude: str, alpha: float) -> None:
    usual, other = (solve("satellite", instance, attitude, value) for value in (0.5, alpha))
    assert other.length == usual.length
    assert other.expected_cost == pytest.approx(usual.expected_cost)


@pytest.mark.parametrize("attitude", ["neutral", "seeking"])
def test_without_the_order_thirteen_actions_are_enough(attitude: str) -> None:
    alpha = None if attitude == "neutral" else 0.5
    result = solve("satellite", f"{SMALLEST}-unordered", attitude, alpha)
    assert result.length == 13
    assert result.expected_cost == pytest.approx(215.1)
