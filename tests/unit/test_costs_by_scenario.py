"""Costs that hang together, from the problem to the result: values, scenarios, and what correlation is worth."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

import statehtn
from statehtn import Problem, Status, UnsupportedError, UsageError
from statehtn.cli.program import main
from statehtn.hddl import read_hddl_text

DOMAIN = """
(define (domain deliveries)
  (:predicates (snow))
  (:task deliver :parameters ())
  (:method both-by-road :parameters () :task (deliver) :ordered-subtasks (and (road) (road)))
  (:method road-and-rail :parameters () :task (deliver) :ordered-subtasks (and (road) (rail)))
  (:method by-ship :parameters () :task (deliver) :ordered-subtasks (and (ship)))
  (:action road :parameters () :effect (and (increase (total-cost) 2) (when (snow) (increase (total-cost) 8))))
  (:action rail :parameters () :effect (and (increase (total-cost) 3) (when (not (snow)) (increase (total-cost) 3))))
  (:action ship :parameters () :effect (increase (total-cost) 13.5)))
"""
PROBLEM = """
(define (problem p) (:domain deliveries)
  (:htn :ordered-subtasks (and (deliver)))
  (:init (probabilistic 0.25 (snow) 0.75 ())))
"""


@pytest.fixture
def problem() -> Problem:
    """Roads cost more in the snow, rails less: twice by road costs 20 or 4, by road and rail 13 or 8."""
    return read_hddl_text(DOMAIN, PROBLEM)


@pytest.mark.parametrize(
    ("objective", "steps", "value"),
    [
        ("neutral", "road road", 8),
        ("cvar 0.75", "road rail", 13),
        ("mean-cvar 0.75 0.5", "road rail", (9.25 + 13) / 2),
        ("deadline 13", "road rail", 0),
        ("deadline 7", "road road", 0.25),
        ("quantile 0.75", "road road", 4),
        ("quantile 0.8", "road rail", 13),
        ("overrun 12", "road rail", 0.25),
        ("piecewise 0:0 10:-1 20:-11", "road rail", 0.25 * 4 + 0.75 * 0.8),
    ],
)
def test_objectives_over_scenarios(problem: Problem, objective: str, steps: str, value: float) -> None:
    result = statehtn.plan(problem, objective=objective)
    assert result.status is Status.OPTIMAL
    assert " ".join(step.step.action for step in result.steps) == steps
    assert result.value == pytest.approx(value, rel=1e-9)
    assert result.lower_bound == pytest.approx(value, rel=1e-6)


def test_exponential_agents(problem: Problem) -> None:
    averse = statehtn.plan(problem, attitude="averse", alpha=0.5)
    assert [step.step.action for step in averse.steps] == ["road", "rail"]
    assert averse.plan is not None
    assert averse.risk_cost == averse.value == pytest.approx(averse.plan.cost_distribution().entropic(0.5))
    assert all(step.risk_cost is None for step in averse.steps)  # they do not add up
    seeking = statehtn.plan(problem, attitude="seeking", alpha=0.5)
    assert [step.step.action for step in seeking.steps] == ["road", "road"]
    assert statehtn.validate(problem, averse.plan).risk_cost(averse.utility) == pytest.approx(averse.value)


def test_jensen_with_mean_costs_to_come_is_no_bound() -> None:
    """One way costs 0 in the snow and 10 in the sun, what follows the reverse; together 10 whatever comes.

    The mean of what follows is 5. Added to what the way has cost, it would make the worst half of all cases cost 15.
    """
    domain = DOMAIN.replace("(increase (total-cost) 2) (when (snow) (increase (total-cost) 8))", "(when (snow) COST)")
    domain = domain.replace(
        "(increase (total-cost) 3) (when (not (snow)) (increase (total-cost) 3))", "(when SUN COST)"
    )
    domain = domain.replace("COST", "(increase (total-cost) 10)").replace("SUN", "(not (snow))")
    hedge = read_hddl_text(domain, PROBLEM.replace("0.25", "0.5").replace("0.75", "0.5"))
    result = statehtn.plan(hedge, objective="cvar 0.5")
    assert result.status is Status.OPTIMAL
    assert [step.step.action for step in result.steps] == ["road", "rail"]
    assert result.value == 10
    assert result.lower_bound is not None
    assert result.lower_bound <= 10


def test_what_correlation_is_worth(problem: Problem) -> None:
    result = statehtn.plan(problem, objective="deadline 13")
    given = {one.scenario.name: one.law.mean for one in result.scenarios}
    assert given == {"(snow)": 13, "no hidden fact": 8}
    correlation = result.correlation
    assert correlation is not None
    # As if independent, twice by road is late only where both are dear: one time in sixteen.
    assert [step.step.action for step in correlation.plan.steps] == ["road", "road"]
    assert correlation.believed == pytest.approx(1 / 16)
    assert (correlation.plan.value, correlation.difference) == (0.25, 0.25)
    assert "given (snow): 13 (probability 0.25)" in str(result)
    entry = result.to_dict()
    assert entry["scenarios"][0] == {
        "name": "(snow)",
        "probability": 0.25,
        "expected_cost": 13.0,
        "least": 13.0,
        "most": 13.0,
        "outcomes": [[1.0, 13.0]],
    }
    assert json.loads(json.dumps(entry))["correlation"]["difference"] == correlation.difference
    assert statehtn.plan(problem).correlation is None


def test_a_plan_that_is_chosen_as_if_costs_were_independent(problem: Problem) -> None:
    """By road and rail the worst quarter of all cases would cost up to 16 if costs were independent: 10 and 6."""
    result = statehtn.plan(problem, objective="cvar 0.75")
    correlation = result.correlation
    assert correlation is not None
    assert [step.step.action for step in correlation.plan.steps] == ["ship"]
    assert (correlation.plan.value, correlation.believed, correlation.difference) == (13.5, 13.5, 0.5)
    assert "correlation: knowing of it is worth 0.5: the plan chosen as if costs were independent is worth 13.5" in str(
        result
    )
    no_matter = statehtn.plan(problem, objective="overrun 30")
    assert "makes no difference" in str(no_matter)


def test_budgets_are_kept_over_all_scenarios(problem: Problem) -> None:
    result = statehtn.plan(problem, keep=["13 0.9"])
    assert [step.step.action for step in result.steps] == ["road", "rail"]
    assert result.keep[0].attained == 1
    none = statehtn.plan(problem, keep=["12 0.9"])
    assert none.status is Status.UNSOLVABLE
    assert none.keep[0].attained == 0.75


@pytest.mark.parametrize("objective", ["mean-variance 1", "mean-deviation 1"])
def test_measures_that_are_not_monotone(problem: Problem, objective: str) -> None:
    with pytest.raises(UnsupportedError, match=f"'{objective}' is not monotone: where costs hang together"):
        statehtn.plan(problem, objective=objective)


def test_what_does_not_go_together(problem: Problem) -> None:
    with pytest.raises(UsageError, match="the weighted search adds up prices of actions, which 'averse 0.5' has none"):
        statehtn.plan(problem, objective="averse 0.5", search="weighted")
    greedy = statehtn.plan(problem, objective="cvar 0.75", search="greedy")
    assert greedy.status is Status.SOLVED
    assert greedy.value is not None


def test_the_best_plans(problem: Problem) -> None:
    plans = statehtn.top_plans(problem, 3, objective="cvar 0.75")
    assert [ranked.value for ranked in plans] == [13, 13.5, 20]
    assert plans.is_all


def test_the_command_line(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "d.hddl").write_text(DOMAIN)
    (tmp_path / "p.hddl").write_text(PROBLEM)
    files = [str(tmp_path / "d.hddl"), str(tmp_path / "p.hddl")]
    assert main(["plan", *files, "--objective", "cvar 0.75"]) == 0
    shown = capsys.readouterr().out
    assert "given (snow)" in shown
    assert "correlation" in shown
    assert main(["plan", *files, "--objective", "cvar 0.75", "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["correlation"]["plan"] == ["(ship)"]
    assert main(["plan", *files, "--objective", "mean-deviation 1"]) == 31
