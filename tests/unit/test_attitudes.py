"""Comparisons of attitudes: side by side, priced for each other, and explained."""

from __future__ import annotations

import json
import math

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import statehtn
from statehtn.attitudes import AttitudeComparison, _merged
from statehtn.cli import main
from statehtn.display.comparison import ComparedPlan, Reason, comparison_text
from statehtn.found_plan import PricedStep
from statehtn.model import CostDistribution
from tests.pages import ROOT

AV = tuple(str(ROOT / "domains" / "av" / name) for name in ("domain.hddl", "p1.hddl"))


@pytest.fixture(scope="module")
def comparison() -> AttitudeComparison:
    return statehtn.compare_attitudes(statehtn.read_hddl(*AV), 0.9)


def test_agents_stand_from_averse_to_seeking() -> None:
    problem = statehtn.read_hddl(*AV)
    several = statehtn.compare_attitudes(problem, [0.1, 0.9, 0.1])
    assert several.agents == ("averse 0.9", "averse 0.1", "neutral", "seeking 0.1", "seeking 0.9")
    assert statehtn.compare_attitudes(problem, attitudes=["seeking"]).agents == ("seeking 1",)
    with pytest.raises(statehtn.UsageError, match="no agents to compare"):
        statehtn.compare_attitudes(problem, [], attitudes=["averse"])
    with pytest.raises(statehtn.UsageError, match="unknown attitude 'bold'; there are neutral"):
        statehtn.compare_attitudes(problem, attitudes=["bold"])
    with pytest.raises(statehtn.UsageError, match="alpha must be a positive finite number"):
        statehtn.compare_attitudes(problem, -1)


def test_every_plan_is_priced_for_every_agent(comparison: AttitudeComparison) -> None:
    """The table of the README."""
    expected = [[19.4, 19.4, 19.4], [21.77, 18.35, 14.85], [26.9, 22.8, 10.17]]
    assert [[round(price, 2) for price in row] for row in comparison.risk_costs] == expected
    for agent in range(3):
        assert comparison.risk_costs[agent][agent] == min(row[agent] for row in comparison.risk_costs)


def test_differences_add_up(comparison: AttitudeComparison) -> None:
    prices = comparison.risk_costs
    for agent in range(3):
        for other in range(3):
            parts = comparison.differences(agent, other)
            assert bool(parts) == (agent != other)
            gain = math.fsum(part.other_cost - part.own_cost for part in parts)
            assert gain == pytest.approx(prices[other][agent] - prices[agent][agent])
    (part,) = comparison.differences(2, 1)
    assert [str(priced.step) for priced in part.own] == ["(accelerate l4 e)"]
    assert [str(priced.step) for priced in part.other] == ["(decelerate l4 e)"]


def test_it_prints_where_plans_part(comparison: AttitudeComparison) -> None:
    lines = str(comparison).splitlines()
    assert lines[0].split("  ")[-1].strip() == "seeking 0.9"
    assert "   (start)             (start)             (start)" in lines
    assert "|  (activate-esp)      (decelerate l4 e)   (accelerate l4 e)" in lines
    assert any(line.startswith("of the neutral         11     18.35    27") for line in lines)
    assert "seeking 0.9 instead of neutral: 10.17, not 14.85, by its own measure" in lines
    html = comparison._repr_html_()
    assert html.count("<table") == 2
    assert "instead of (decelerate l4 e)" in html


def test_equal_plans_stand_in_one_column() -> None:
    problem = statehtn.read_hddl(ROOT / "domains" / "av" / "domain.hddl", ROOT / "domains" / "av" / "p3.hddl")
    text = str(statehtn.compare_attitudes(problem, [0.1, 0.9], attitudes=["averse", "neutral"]))
    assert text.splitlines()[0].split(maxsplit=0)[0].strip() == "averse 0.9, averse 0.1, neutral"
    assert "|" not in text
    assert "instead" not in text


def test_it_is_json(comparison: AttitudeComparison) -> None:
    found = json.loads(json.dumps(comparison.to_dict(), allow_nan=False))
    assert found["agents"][1] == {"attitude": "neutral", "alpha": None}
    assert [result["status"] for result in found["results"]] == ["optimal"] * 3
    assert found["risk_costs"][1][1] == pytest.approx(18.35)
    assert len(found["differences"]) == 6
    last = found["differences"][-1]
    assert (last["agent"], last["other"]) == (2, 1)
    assert last["parts"] == [
        {
            "own": ["(accelerate l4 e)"],
            "other": ["(decelerate l4 e)"],
            "own_risk_cost": pytest.approx(3.05841914),
            "other_risk_cost": pytest.approx(7.740, abs=1e-3),
        }
    ]


LAWS = (CostDistribution.certain(1), CostDistribution.certain(2))
STEPS = st.builds(
    lambda name, law: PricedStep(statehtn.Step(name), law, law.mean, law.mean),
    st.sampled_from("abcd"),
    st.sampled_from(LAWS),
)


@settings(max_examples=50)
@given(st.lists(st.lists(STEPS, max_size=8), min_size=1, max_size=4))
def test_rows_hold_every_plan_in_its_order(plans: list[list[PricedStep]]) -> None:
    rows: list[list[PricedStep | None]] = []
    for width, steps in enumerate(plans):
        rows = _merged(rows, steps, width)
    for column, steps in enumerate(plans):
        assert [row[column] for row in rows if row[column] is not None] == steps
    assert all(any(cell is not None for cell in row) for row in rows)
    assert all(len(row) == len(plans) for row in rows)
    if all(steps == plans[0] for steps in plans):
        assert len(rows) == len(plans[0])


def test_long_stretches_are_shortened() -> None:
    plans = [ComparedPlan("a", "optimal", 1, 1, 1, [1, 1]), ComparedPlan("b", "solved", 1, 1, math.inf, [1, 1])]
    rows = [(True, [f"({number})"] * 2) for number in range(10)] + [(False, ["(x)", ""])]
    lines = comparison_text(plans, ["a", "b"], rows, []).splitlines()
    assert [line.split() for line in lines[2:10]] == [
        *([f"({number})"] * 2 for number in range(3)),
        ["...", "4", "more", "that", "all", "share"],
        *([f"({number})"] * 2 for number in range(7, 10)),
        ["|", "(x)"],
    ]
    assert [line.split() for line in lines[-4:-2]] == [
        ["of", "the", "a", "1", "1", "1", "1*", "1"],
        ["of", "the", "b", "1", "1", "unbounded", "1*", "1"],
    ]


def test_plans_that_tie_are_equally_good() -> None:
    """For the averse agent the second plan is as good as its own, for the neutral one it is dearer in the 7th digit."""
    plans = [
        ComparedPlan("averse", "optimal", 1, 2, 4, [3.434, 2.5000001]),
        ComparedPlan("neutral", "optimal", 1, 2, 4, [3.434 * (1 + 1e-12), 2.5]),
    ]
    reasons = [
        Reason("averse", "neutral", 3.434, 3.434 * (1 + 1e-12), [(["(flip)"], 3.434, ["(toss)"], 3.434)]),
        Reason("neutral", "averse", 2.5, 2.5000001, [(["(toss)"], 2.5, ["(flip)"], 2.5000001)]),
    ]
    lines = comparison_text(plans, ["averse", "neutral"], [(False, ["(flip)", "(toss)"])], reasons).splitlines()
    assert [line.split()[-2:] for line in lines if line.startswith("of the")] == [["3.434*", "2.5"], ["3.434*", "2.5*"]]
    assert [line for line in lines if "own" in line] == [
        "averse: the plan of neutral is as good as its own, 3.434, by its own measure",
        "neutral instead of averse: 2.5, not 2.5000001, by its own measure",
    ]


def test_agents_without_a_plan() -> None:
    domain = "(define (domain d) (:task t :parameters ()) (:action a :parameters () :precondition (or)))"
    problem = statehtn.read_hddl_text(domain, "(define (problem p) (:domain d) (:htn :subtasks (t)) (:init))")
    comparison = statehtn.compare_attitudes(problem)
    assert comparison.risk_costs == ((None,) * 3,) * 3
    assert comparison.rows == ()
    assert comparison.differences(0, 1) == ()
    assert str(comparison).count("unsolvable") == 3
    json.dumps(comparison.to_dict(), allow_nan=False)


def test_the_command(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["compare-attitudes", *AV, "--alpha", "0.9"]) == 0
    assert str(statehtn.compare_attitudes(statehtn.read_hddl(*AV), 0.9)) == capsys.readouterr().out.rstrip("\n")
    assert main(["compare-attitudes", *AV, "--alpha", "0.1", "0.9", "--json"]) == 0
    assert len(json.loads(capsys.readouterr().out)["agents"]) == 5
    assert main(["compare-attitudes", *AV, "--alpha", "0"]) == 2
    assert "alpha must be a positive finite number" in capsys.readouterr().err
    assert main(["compare-attitudes", *AV, "--time-limit", "0.000001"]) == 20
    assert "the time limit was reached" in capsys.readouterr().err  # while reading
