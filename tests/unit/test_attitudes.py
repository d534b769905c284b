"""Comparisons of attitudes: side by side, priced for each other, and explained."""

from __future__ import annotations

import json
import math
from collections.abc import Sequence
from dataclasses import replace
from itertools import chain

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import statehtn
from statehtn.attitudes import AttitudeComparison, _merged
from statehtn.cli import main
from statehtn.found_plan import PricedStep
from statehtn.model import CostDistribution, CostLaw
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
    assert found["agents"][1] == {"attitude": "neutral", "alpha": None, "objective": "neutral"}
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


def _ways(*ways: Sequence[CostLaw]) -> statehtn.Problem:
    """Return a problem with ten steps that all plans share, and then one of some ways, with a cost for each step."""
    shared = [f"s{number}" for number in range(10)]
    own = [[f"w{way}-{step}" for step in range(len(laws))] for way, laws in enumerate(ways)]
    domain = "(:task choose) " + " ".join(f"(:action {name})" for name in (*shared, *chain(*own)))
    for way, names in enumerate(own):
        domain += f" (:method m{way} :task (choose) :ordered-subtasks (and {' '.join(f'({name})' for name in names)}))"
    subtasks = " ".join(f"({name})" for name in (*shared, "choose"))
    problem = f"(define (problem p) (:htn :ordered-subtasks (and {subtasks})) (:init))"
    builder = statehtn.ProblemBuilder.of(statehtn.read_hddl_text(f"(define (domain d) {domain})", problem))
    for name, law in zip(chain(*own), chain(*ways), strict=True):
        builder.set_cost(name, law)
    return builder.build()


def test_long_stretches_are_shortened() -> None:
    """The risk has a mean of 1, is worth about half of that to a seeking agent, and has no upper end."""
    certain = CostDistribution.certain(0.4)
    risk = CostDistribution.from_scipy(pytest.importorskip("scipy.stats").lomax(2))
    problem = _ways([certain, certain], [risk])
    comparison = statehtn.compare_attitudes(problem, attitudes=["neutral", "seeking"])
    lines = [line.split() for line in str(comparison).splitlines()]
    assert lines[2:11] == [
        *([f"(s{number})"] * 2 for number in range(3)),
        ["...", "4", "more", "that", "all", "share"],
        *([f"(s{number})"] * 2 for number in range(7, 10)),
        ["|", "(w0-0)", "(w1-0)"],
        ["|", "(w0-1)"],
    ]
    rows = [line[2:] for line in lines if line[:2] == ["of", "the"]]
    assert rows[0] == ["neutral", "0.8", "0.8", "0.8", "0.8*", "0.8"]
    assert rows[1][:-1] == ["seeking", "1", "0", "1", "unbounded", "1"]
    assert "*" in rows[1][-1]
    unproven = [replace(result, status=statehtn.Status.SOLVED) for result in comparison.results]
    assert str(AttitudeComparison(tuple(unproven))).count("*") == 1  # that of the note


def test_plans_that_tie_are_equally_good() -> None:
    """The averse agent finds the gamble as good as its own plan; for the neutral one that plan costs a little more."""
    spread = 0.000447
    gamble = CostDistribution.of([(0.5, 2.5 - spread), (0.5, 2.5 + spread)])
    certain = CostDistribution.certain(2.5 + math.log(math.cosh(spread)) - 2.5e-10)
    comparison = statehtn.compare_attitudes(_ways([certain], [gamble]), attitudes=["averse", "neutral"])
    lines = str(comparison).splitlines()
    assert [line.split()[-2:] for line in lines if line.startswith("of the")] == [["2.5*", "2.5"], ["2.5*", "2.5*"]]
    assert [line for line in lines if "own" in line] == [
        "averse 1: the plan of neutral is as good as its own, 2.5, by its own measure",
        "neutral instead of averse 1: 2.5, not 2.5000001, by its own measure",
    ]


@pytest.mark.filterwarnings("ignore:.*leads to no plan")
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
