"""What plans are compared by, from every door of the planner: mistakes in it, and what comes out."""

from __future__ import annotations

import io
import json
import math
import pickle
from pathlib import Path

import pytest

import statehtn
from statehtn import UsageError
from statehtn.cli import main
from statehtn.display.result import readable_result
from statehtn.experiments.run import Grid, Instance
from statehtn.risk import MeanVariance
from statehtn.settings import Settings
from tests.test_minimal import DOMAIN, PROBLEM
from tests.unit.test_costs_by_scenario import DOMAIN as SNOW_DOMAIN
from tests.unit.test_costs_by_scenario import PROBLEM as SNOW_PROBLEM
from tests.unit.test_planner import UNSOLVABLE

AV = ("domains/av/domain.hddl", "domains/av/p1.hddl")
Capture = pytest.CaptureFixture[str]
BEST = 19.4
"""The least cost that is certain, in the first vehicle problem."""


@pytest.fixture(scope="module")
def vehicle() -> statehtn.Problem:
    return statehtn.read_hddl(*AV)


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (["--objective", "cvr 0.95"], "unknown objective 'cvr' (did you mean 'cvar'?)"),
        (["--objective", "cvar 1"], "the level must be above 0 and below 1, such as 0.95, found 1"),
        (["--objective", "quantile 95"], "the level must be above 0 and below 1"),
        (["--objective", "evar -0.5"], "the level must be above 0 and below 1"),
        (["--objective", "cvar"], "it takes 1 number, found 0; write cvar LEVEL"),
        (["--objective", "cvar high"], "'high' is no number"),
        (["--objective", "mean-variance -1"], "must be a finite number of at least 0, found -1"),
        (["--objective", "mean-deviation -1"], "must be a finite number of at least 0, found -1"),
        (["--objective", "exponentials linear=1 0.5:-1"], "found -1"),
        (["--objective", "piecewise 0:0 10:1"], "rise"),
        (["--objective", "piecewise 10:0 0:-1"], "10"),
        (["--objective", "averse 0.9", "--attitude", "averse"], "leave out --attitude"),
        (["--objective", "averse 0.9", "--alpha", "0.9"], "leave out --alpha"),
        (["--keep", "25 1.5"], "must be above 0 and at most 1, such as 0.95, found 1.5"),
        (["--keep", "25 0"], "must be above 0 and at most 1"),
        (["--keep", "-1 0.5"], "at least 0, found -1"),
        (["--keep", "25"], "written BUDGET PROBABILITY, such as '25 0.95'; found '25'"),
        (["--keep", "soon likely"], "found 'soon likely'"),
        (["--precision", "0"], "the precision must be between 0 and 1, such as 1e-6, found 0"),
        (["--objective", "cvar 0.95", "--search", "weighted"], "take astar or anytime"),
        (["--keep", "25 0.9", "--search", "weighted"], "take astar or anytime"),
        (["--keep", "25 0.9", "--search", "greedy"], "greedy search looks at no budgets"),
        (["--objective", "cvar 0.95", "--heuristic", "ff"], "'ff' may estimate more than is true"),
        (["--objective", "cvar 0.95", "--without", "endings"], "has no refinement 'endings'"),
    ],
)
def test_a_mistake_is_one_line_and_an_error_of_usage(options: list[str], words: str, capsys: Capture) -> None:
    assert main(["plan", *AV, *options]) == 2
    captured = capsys.readouterr()
    assert captured.out == ""
    assert captured.err.startswith("error: ")
    assert captured.err.count("\n") == 1
    assert words in captured.err


@pytest.mark.parametrize("command", [["top", "2", *AV], ["compare-attitudes", *AV]])
def test_other_commands_say_the_same(command: list[str], capsys: Capture) -> None:
    assert main([*command, "--objective", "cvr 0.95"]) == 2
    assert "did you mean 'cvar'?" in capsys.readouterr().err
    assert main([*command, "--keep", "25 1.5"]) == 2
    assert "found 1.5" in capsys.readouterr().err


def test_objectives_beside_attitudes_are_two_ways_to_say_one_thing(vehicle: statehtn.Problem, capsys: Capture) -> None:
    with pytest.raises(UsageError, match="two ways to say one thing"):
        statehtn.plan(vehicle, objective="neutral", attitude="averse")
    with pytest.raises(UsageError, match="two ways to say one thing"):
        statehtn.top_plans(vehicle, 2, objective="neutral", alpha=0.5)
    with pytest.raises(UsageError, match="either objectives or attitudes"):
        statehtn.compare_attitudes(vehicle, 0.9, objectives=["neutral"])
    with pytest.raises(UsageError, match="no objectives to compare"):
        statehtn.compare_attitudes(vehicle, objectives=[])
    assert main(["compare-attitudes", *AV, "--objective", "neutral", "--alpha", "1"]) == 2
    assert "either objectives or attitudes" in capsys.readouterr().err


def test_what_is_no_objective(vehicle: statehtn.Problem) -> None:
    for wrong in (3, MeanVariance, ["cvar 0.95"]):
        with pytest.raises(UsageError, match="an objective is its text form"):
            statehtn.plan(vehicle, objective=wrong)  # type: ignore[arg-type]
    with pytest.raises(UsageError, match="'keep' must be a list"):
        statehtn.plan(vehicle, keep=25)  # type: ignore[arg-type]


@pytest.mark.parametrize(("attitude", "alpha"), [("neutral", None), ("averse", 0.9), ("seeking", 0.25)])
def test_short_forms_are_objectives(vehicle: statehtn.Problem, attitude: str, alpha: float | None) -> None:
    text = attitude if alpha is None else f"{attitude} {alpha}"
    short = statehtn.plan(vehicle, attitude=attitude, alpha=alpha)  # type: ignore[arg-type]
    long = statehtn.plan(vehicle, objective=text)
    assert long.objective == short.objective
    assert str(short.objective) == text
    assert long.plan == short.plan
    assert (short.value, short.value_unit, short.attitude, short.alpha) == (short.risk_cost, "cost", attitude, alpha)
    assert short.lower_bound is not None
    assert short.value is not None
    assert short.gap == short.value - short.lower_bound


def test_mean_variance_has_prices(vehicle: statehtn.Problem) -> None:
    for solver in ("state", "plan"):
        result = statehtn.plan(vehicle, objective=MeanVariance(0.5), solver=solver)  # type: ignore[arg-type]
        assert result.status is statehtn.Status.OPTIMAL
        assert result.value == result.risk_cost == pytest.approx(BEST)
        assert sum(step.risk_cost or 0 for step in result.steps) == pytest.approx(BEST)
        assert (result.attitude, result.alpha, result.expected_utility, result.log10_expected_utility) == (None,) * 4
    assert result.problem_class == "PP10211"


def test_json_says_the_objective(capsys: Capture) -> None:
    assert main(["plan", *AV, "--objective", "mean-variance 0.5", "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert (found["objective"], found["value_unit"], found["attitude"]) == ("mean-variance 0.5", "cost", None)
    assert found["value"] == found["risk_cost"] == pytest.approx(BEST)
    assert found["gap"] == pytest.approx(found["value"] - found["lower_bound"])
    assert found["keep"] == []


def test_greedy_search_goes_by_the_mean_and_reports_the_value(vehicle: statehtn.Problem) -> None:
    result = statehtn.plan(vehicle, objective="cvar 0.95", search="greedy")
    assert result.plan is not None
    law = result.plan.cost_distribution()
    assert result.status is statehtn.Status.SOLVED
    assert (result.lower_bound, result.gap) == (None, None)
    assert result.value == result.risk_cost == pytest.approx(law.cvar(0.95))
    assert all(step.risk_cost is None for step in result.steps)
    late = statehtn.plan(vehicle, objective="deadline 15", search="greedy")
    assert late.value == pytest.approx(law.exceedance(15))
    assert (late.value_unit, late.risk_cost) == ("probability", None)
    assert "(probability)" in str(late)


def test_objectives_are_compared_in_their_order(vehicle: statehtn.Problem) -> None:
    comparison = statehtn.compare_attitudes(vehicle, objectives=["mean-variance 0.5", "neutral", "neutral"])
    assert comparison.agents == ("mean-variance 0.5", "neutral")
    ((first, _), (_, last)) = comparison.values
    assert first == pytest.approx(BEST)
    assert last == pytest.approx(18.35)
    assert comparison.values == comparison.risk_costs
    found = comparison.to_dict()
    assert found["agents"][0] == {"attitude": None, "alpha": None, "objective": "mean-variance 0.5"}
    assert "by mean-variance 0.5" in str(comparison)


def test_a_suite_with_objectives(tmp_path: Path, capsys: Capture) -> None:
    (tmp_path / "domain.hddl").write_text(DOMAIN)
    (tmp_path / "p1.hddl").write_text(PROBLEM)
    suite = tmp_path / "my.toml"
    runs = '[[runs]]\ndomain = "domain.hddl"\nproblems = "p1.hddl"\nname = "errands"\n'
    suite.write_text(f'objectives = ["neutral", "mean-variance 0.5"]\nattitudes = "averse"\nalphas = 0.9\n{runs}')
    table = tmp_path / "r.csv"
    assert main(["compare", "--suite", str(suite), "--output", str(table), "--quiet"]) == 0
    head, *rows = (line.split(",") for line in table.read_text().splitlines())
    named = [dict(zip(head, row, strict=True)) for row in rows]
    objectives = [row["objective"] for row in named]
    assert objectives == ["averse 0.9", "neutral", "mean-variance 0.5"]
    assert [(row["attitude"], row["alpha"]) for row in named] == [("averse", "0.9"), ("neutral", ""), ("", "")]
    assert all(row["value"] == row["risk_cost"] != "" for row in named)
    for wrong, words in (
        ('objectives = "cvr"', "did you mean 'cvar'?"),
        ('keep = "25 2"', "('keep')"),
        ("objectives = 7", "'objectives': expected text"),
        ("objective = 7", "unknown key 'objective'"),
    ):
        suite.write_text(f"{wrong}\n{runs}")
        assert main(["compare", "--suite", str(suite)]) == 30
        assert words in capsys.readouterr().err


def test_a_run_of_a_suite_that_no_search_can_do_is_left_out(capsys: Capture) -> None:
    options = ["--suite", "paper", "--domain", "av", "--problem", "p1", "--objective", "neutral", "deadline 25"]
    assert main(["compare", *options, "--solver", "state", "--search", "weighted", "--quiet"]) == 0
    captured = capsys.readouterr()
    assert "left out: state/weighted" in captured.err
    assert "the objective 'deadline 25' does not have" in captured.err
    assert captured.out.count("av,p1,neutral") == 1
    assert "deadline" not in captured.out


def test_a_budget_that_is_kept(capsys: Capture) -> None:
    assert main(["plan", *AV, "--objective", "cvar 0.5", "--keep", "25 0.99", "--keep", "20 1", "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert found["keep"] == [
        {"budget": 25.0, "probability": 0.99, "attained": 1.0, "at_most": None},
        {"budget": 20.0, "probability": 1.0, "attained": 1.0, "at_most": None},
    ]
    assert (found["status"], found["value"]) == ("optimal", pytest.approx(BEST))
    assert main(["plan", *AV, "--keep", "20 0.9"]) == 0
    shown = capsys.readouterr().out
    assert "optimal: no plan of this problem that keeps 20 with probability 0.9 has a higher expected utility" in shown
    assert "within 20             with probability 1" in shown


@pytest.mark.parametrize("command", [["plan"], ["top", "3"]])
def test_budgets_that_no_plan_keeps(command: list[str], capsys: Capture) -> None:
    budgets = ["--keep", "12 0.01", "--keep", "20 1"]
    assert main([*command, *AV, "--keep", "12 0.9"]) == 10
    shown = capsys.readouterr().out
    assert "unsolvable: it is proven that no plan of this problem keeps 12 with probability 0.9" in shown
    assert "with probability 0.2 at most" in shown
    assert main([*command, *AV, *budgets]) == 10
    assert "each of these budgets can be kept, but no plan keeps all of them" in capsys.readouterr().out
    assert main([*command, *AV, *budgets, "--json"]) == 10
    found = json.loads(capsys.readouterr().out)
    assert [kept["attained"] for kept in found["keep"]] == [pytest.approx(0.2), 1.0]


def test_what_is_known_of_a_budget_with_continuous_costs(tmp_path: Path, capsys: Capture) -> None:
    """Two ways: a gamma law, which has no exact grid, and 8 for certain. The first keeps 3 with probability 0.594."""
    text = """(define (domain d) (:predicates (p)) (:task go :parameters ())
      (:method one :parameters () :task (go) :ordered-subtasks (and (a)))
      (:method two :parameters () :task (go) :ordered-subtasks (and (b)))
      (:action a :parameters () :effect (p)) (:action b :parameters () :effect (p)))"""
    costs = """[[costs]]
      action = "a"
      distribution = "gamma"
      parameters = { a = 2, scale = 1.5 }
      [[costs]]
      action = "b"
      cost = 8"""
    files = [tmp_path / name for name in ("domain.hddl", "problem.hddl", "costs.toml")]
    network = "(define (problem p) (:domain d) (:htn :ordered-subtasks (and (go))) (:init))"
    for file, content in zip(files, (text, network, costs), strict=True):
        file.write_text(content)
    asked = [*map(str, files[:2]), "--costs", str(files[2]), "--keep", "3 0.9"]
    largest = 1 - 3 * math.exp(-2)
    for command in (["plan"], ["top", "2"]):
        assert main([*command, *asked, "--json"]) == 10
        (kept,) = json.loads(capsys.readouterr().out)["keep"]
        assert kept["attained"] == pytest.approx(largest)
        assert kept["attained"] <= kept["at_most"] < largest + 2e-3
    for command in (["plan"], ["top", "2"], ["compare-attitudes", "--alpha=0.1"]):
        assert main([*command, *asked, "--precision", "0.1"]) == 10
        shown = " ".join(capsys.readouterr().out.split())
        assert "unsolvable: it is proven that no plan of this problem keeps 3 with probability 0.9" in shown
        assert "with probability 0.593994" in shown
        assert "by the best plan that was found for it, and 0.6" in shown
        assert "at most by any" in shown


def test_agents_none_of_whom_has_a_plan(tmp_path: Path, capsys: Capture) -> None:
    domain, problem = tmp_path / "domain.hddl", tmp_path / "problem.hddl"
    domain.write_text(DOMAIN)
    problem.write_text(UNSOLVABLE)
    for keep in ([], ["--keep", "12 0.9"]):
        assert main(["compare-attitudes", str(domain), str(problem), *keep]) == 10
        shown = capsys.readouterr().out
        assert "why: " in shown
        assert "no plan of this problem keeps" not in shown
    assert main(["compare-attitudes", *AV, "--keep", "12 0.9", "--keep", "20 1"]) == 10
    shown = capsys.readouterr().out
    assert shown.count("no plan of this problem keeps 12 with probability 0.9 and 20 with probability 1") == 1
    assert "within 12: with probability 0.2 at most, by the plan that is best at it" in shown
    assert "why: " not in shown


def test_budgets_of_a_problem_without_a_plan() -> None:
    result = statehtn.plan(statehtn.read_hddl_text(DOMAIN, UNSOLVABLE), keep="12 0.9")
    assert result.status is statehtn.Status.UNSOLVABLE
    assert [kept.attained for kept in result.keep] == [None]
    assert "no plan of this problem keeps" not in str(result)


def test_a_deadline_that_no_plan_can_meet_is_a_result(vehicle: statehtn.Problem) -> None:
    result = statehtn.plan(vehicle, objective="deadline 3")
    assert result.status is statehtn.Status.OPTIMAL
    assert (result.value, result.value_unit, result.risk_cost) == (1.0, "probability", None)


def test_a_utility_that_rises_is_no_utility(vehicle: statehtn.Problem) -> None:
    with pytest.raises(UsageError, match=r"the utility 'rising' rises: .*; costs are positive and utilities maximised"):
        statehtn.plan(vehicle, objective=rising)


def rising(cost: float) -> float:
    """Likes to pay."""
    return cost


def test_a_function_has_a_certainty_equivalent_where_it_falls(vehicle: statehtn.Problem) -> None:
    result = statehtn.plan(vehicle, objective=lambda cost: -(cost**2))
    assert result.plan is not None
    law = result.plan.cost_distribution()
    assert result.value == pytest.approx(law.standard_deviation**2 + law.mean**2)
    assert result.risk_cost == pytest.approx((result.value or 0) ** 0.5)
    assert str(result.objective) == "utility <lambda>"
    late = statehtn.plan(vehicle, objective=lambda cost: -float(cost > 17))
    assert late.value == pytest.approx(0.424)
    assert late.risk_cost is None
    assert str(statehtn.plan(vehicle, objective=lambda cost: -float(cost > 20)).value) == "0.0"  # no negative zero


def test_better_plans_come_one_after_the_other(vehicle: statehtn.Problem) -> None:
    *_, last = statehtn.improving(vehicle, objective="deadline 17")
    assert last.status is statehtn.Status.OPTIMAL
    assert last.value == pytest.approx(0.424)
    values = [one.value for one in statehtn.improving(vehicle, objective="cvar 0.95", keep="25 0.5")]
    assert values == sorted(values, key=lambda value: -(value or 0))
    assert values[-1] == pytest.approx(BEST)


def test_what_is_not_proven_to_the_precision_has_a_gap(vehicle: statehtn.Problem) -> None:
    wanted = "one-switch alpha=0.9 tradeoff=20 wealth=40"
    result = statehtn.plan(
        vehicle, objective=wanted, solver="plan", precision=1e-15
    )  # more than floating point can hold
    assert result.status is statehtn.Status.SOLVED
    assert result.value is not None
    assert result.lower_bound is not None
    assert 0 < (result.gap or 0) == result.value - result.lower_bound < 1e-8
    assert f"(gap {result.gap:.4g})" in readable_result(result, io.StringIO())


def test_notebooks_show_every_objective(vehicle: statehtn.Problem) -> None:
    result = statehtn.plan(vehicle, objective="cvar 0.95", keep="25 0.5")
    page = result._repr_html_()
    assert "cvar 0.95" in page
    assert "within 25" in page
    assert "certainty equivalent" not in page
    assert "certainty equivalent" not in result.steps._repr_html_()
    top = statehtn.top_plans(vehicle, 2, objective="deadline 17")
    assert "value" in top._repr_html_()
    assert "by deadline 17" in statehtn.compare_attitudes(vehicle, objectives=["deadline 17", "neutral"])._repr_html_()


def test_agents_are_compared_where_costs_hang_together() -> None:
    problem = statehtn.read_hddl_text(SNOW_DOMAIN, SNOW_PROBLEM)
    comparison = statehtn.compare_attitudes(problem, objectives=["neutral", "averse 1", "cvar 0.75"])
    for row, own in zip(comparison.values, comparison.results, strict=True):
        assert own.plan is not None
        law = own.plan.cost_distribution()
        assert row == pytest.approx([agent.objective.value(law) for agent in comparison.results])
    (careful,) = comparison.differences(1, 0)  # of a careful agent no part of a plan has a price
    assert (careful.own_cost, careful.other_cost) == (None, None)
    (indifferent,) = comparison.differences(0, 1)
    assert indifferent.own_cost is not None
    assert "averse 1 instead of neutral" in str(comparison)


def test_runs_with_objectives_travel() -> None:
    wanted = [*map(statehtn.objective, ("cvar 0.95", "piecewise 0:0 10:-1", "one-switch alpha=1 tradeoff=2 wealth=3"))]
    grid = Grid(objectives=wanted, keep=(statehtn.Keep(25, 0.95),), precision=1e-4)
    runs = grid.runs([Instance("d", "p", "d.hddl", "p.hddl")])
    assert pickle.loads(pickle.dumps(runs)) == runs
    assert [run.key[2:4] for run in runs] == [(str(one), "25 0.95") for one in wanted]
    assert all("--keep" in run.arguments() and "0.0001" in run.arguments() for run in runs)


@pytest.mark.parametrize(
    "name", ["mean-deviation 1", "one-switch alpha=0.1 tradeoff=2 wealth=60", "exponentials linear=1 0.1:1"]
)
def test_how_precise_a_search_is_unless_said_otherwise(name: str, capsys: Capture) -> None:
    """Sums are told apart to 1e-9, but not where laws say whether budgets are kept; the help says so, too."""
    problem = statehtn.read_hddl("domains/airport/domain.hddl", "domains/airport/p1.hddl")
    for keep, precision in (((), 1e-9), (("75 0.5",), 1e-6)):
        assert Settings.of(name, keep=keep).precision == precision
        result = statehtn.plan(problem, objective=name, keep=keep)
        assert result.status is statehtn.Status.OPTIMAL
        assert result.gap is not None
        assert result.value is not None
        assert result.gap <= precision * result.value
    assert main(["plan", "--help"]) == 0
    shown = " ".join(capsys.readouterr().out.split())
    assert "default: 1e-06 (one-switch, exponentials, mean-deviation without --keep: 1e-09)" in shown
