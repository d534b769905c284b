"""What is said of objectives: by errors, by endings, and by tables."""

from __future__ import annotations

import io
from collections.abc import Callable

import pytest
from scipy import stats

import statehtn
from statehtn import InputError, Problem, StateHtnError
from statehtn.cli import main
from statehtn.display.result import readable_result
from statehtn.display.top_plans import readable_top_plans
from statehtn.expected import did_you_mean
from statehtn.experiments.records import Row
from statehtn.experiments.summary import summarise
from tests.unit.test_costs_by_scenario import DOMAIN as SNOW_DOMAIN
from tests.unit.test_costs_by_scenario import PROBLEM as SNOW_PROBLEM

AIRPORT = ("domains/airport/domain.hddl", "domains/airport/p1.hddl")
Capture = pytest.CaptureFixture[str]


@pytest.fixture(scope="module")
def airport() -> Problem:
    return statehtn.read_hddl(*AIRPORT)


@pytest.mark.parametrize(
    ("asked", "words"),
    [
        (
            ["--objective", "cvar 0.9", "--solver", "plan", "--heuristic", "blind"],
            "the heuristic tdg alone by 'cvar 0.9'",
        ),
        (["--keep", "60 0.5", "--solver", "plan", "--heuristic", "blind"], "tdg alone with a budget to keep (--keep)"),
        (["--solver", "plan", "--heuristic", "lmcut"], "has no state, which 'lmcut' needs; its heuristics are tdg and"),
        (["--objective", "CVAR 0.9"], "unknown objective 'CVAR' (did you mean 'cvar'?)"),
        (["--objective", "EVAR 0.9"], "unknown objective 'EVAR' (did you mean 'evar'?)"),
        (["--objective", "Mean-Deviation 1"], "(did you mean 'mean-deviation'?)"),
    ],
)
def test_what_is_wrong_is_true_and_says_what_to_write(asked: list[str], words: str, capsys: Capture) -> None:
    assert main(["plan", *AIRPORT, *asked]) == 2
    assert words in capsys.readouterr().err


@pytest.mark.parametrize("solver", [["--heuristic", "blind"], ["--heuristic", "tdg"]])
def test_the_solver_plan_takes_both_where_prices_add_up(solver: list[str], capsys: Capture) -> None:
    assert main(["plan", *AIRPORT, "--solver", "plan", *solver, "--objective", "mean-variance 0.1"]) == 0
    assert "optimal" in capsys.readouterr().out


@pytest.mark.parametrize("command", [["policy"], ["export", "--prism", "-", "--policy"]])
def test_that_policies_keep_no_budgets_is_said(command: list[str], capsys: Capture) -> None:
    assert main([*command, *AIRPORT, "--keep", "60 0.5"]) == 2
    assert "policies keep no budgets (--keep), since the best one might have to draw lots" in capsys.readouterr().err
    assert main([command[0], "--help"]) == 0
    assert "--keep" not in capsys.readouterr().out


@pytest.mark.parametrize(
    "make",
    [
        lambda problem: statehtn.plan(problem, objective="neutral", attitude="averse", alpha=2),
        lambda problem: statehtn.plan(problem, objective="neutral", alpha=2),
        lambda problem: statehtn.policy(problem, objective="neutral", attitude="averse", alpha=2),
        lambda problem: statehtn.compare_attitudes(problem, objectives=["neutral"], alpha=2),
    ],
)
def test_nothing_is_quoted_that_nobody_wrote(make: Callable[[Problem], object], airport: Problem) -> None:
    with pytest.raises(StateHtnError, match=r"leave one out; as objectives, agents .* 'averse A' and") as error:
        make(airport)
    assert "0.9" not in error.value.message


def test_how_much_better_no_plan_is(airport: Problem) -> None:
    """A gap that is no rounding is told where it is said that the plan is the best."""
    settled = statehtn.plan(airport, objective="deadline 70")
    assert settled.gap == 0
    assert "has a lower value of 'deadline 70'" in _shown(settled)
    assert "by more than the precision" not in _shown(settled)
    open_ = statehtn.plan(airport, objective="mean-deviation 1", keep="75 0.5", precision=0.01)
    assert open_.status is statehtn.Status.OPTIMAL
    assert open_.gap is not None
    assert open_.gap > 0
    assert "has a lower value of 'mean-deviation 1' by more than the precision" in _shown(open_)
    top = statehtn.top_plans(airport, 2, objective="cvar 0.9", precision=0.01)
    gap = top.plans[-1].value - (top.lower_bound or 0.0)
    assert ("by more than the precision" in readable_top_plans(top)) == (gap > 0)
    assert "by more than the precision" not in _shown(statehtn.plan(airport))  # its gap is rounding


def _shown(result: statehtn.Result) -> str:
    return " ".join(readable_result(result, io.StringIO()).split())


@pytest.mark.parametrize(("objective", "keep"), [("mean-deviation 0", ()), ("mean-variance 0", ("9 0.5",))])
def test_a_weight_of_nothing_where_costs_hang_together(objective: str, keep: tuple[str, ...]) -> None:
    problem = statehtn.read_hddl_text(SNOW_DOMAIN, SNOW_PROBLEM)
    with pytest.raises(StateHtnError, match=r"hang together are not compared by .*; take 'neutral', which is the same"):
        statehtn.plan(problem, objective=objective, keep=keep)


def test_budgets_are_named_in_the_table_of_a_comparison() -> None:
    row: Row = dict.fromkeys(("facts", "parse_seconds", "ground_seconds", "search_seconds"), "")
    row |= {"domain": "d", "objective": "cvar 0.9", "keep": "75 0.5", "solver": "state", "heuristic": "potential"}
    (summary,) = summarise([{**row, "status": "time-limit"}])
    assert summary.settings == "cvar 0.9 keep 75 0.5 state potential"


def test_similar_names_in_any_case() -> None:
    assert did_you_mean("NEUTRL", ["neutral", "cvar"]) == " (did you mean 'neutral'?)"
    assert did_you_mean("lmcuT", ["LMCUT", "cvar"]) == " (did you mean 'LMCUT'?)"
    assert did_you_mean("xyz", ["neutral"]) == ""


TWO_WAYS = """(define (domain d) (:predicates (p)) (:task go :parameters ())
  (:method one :parameters () :task (go) :ordered-subtasks (and (b) (a)))
  (:method two :parameters () :task (go) :ordered-subtasks (and (b) (b)))
  (:action a :parameters () :effect (p)) (:action b :parameters () :effect (p)))"""
ONE_TASK = "(define (problem p) (:domain d) (:htn :ordered-subtasks (and (go))) (:init))"


@pytest.mark.parametrize("law", [stats.lognorm(1, scale=1.5), stats.pareto(1.5)])
@pytest.mark.parametrize(
    "make",
    [
        lambda problem: statehtn.plan(problem, objective="evar 0.9"),
        lambda problem: statehtn.plan(problem, objective="evar 0.9", solver="plan"),
        lambda problem: statehtn.plan(problem, objective="evar 0.9", keep="50 0.1"),
        lambda problem: statehtn.top_plans(problem, 2, objective="evar 0.9"),
        lambda problem: statehtn.compare_attitudes(problem, objectives=["neutral", "evar 0.9"]),
        lambda problem: statehtn.plan(problem, objective="one-switch alpha=0.1 tradeoff=2 wealth=10"),
    ],
)
def test_the_action_is_named_whose_cost_has_no_value(law: object, make: Callable[[Problem], object]) -> None:
    problem = statehtn.with_cost(statehtn.with_cost(statehtn.read_hddl_text(TWO_WAYS, ONE_TASK), "b", 8), "a", law)
    with pytest.raises(InputError, match=r"the cost of \(a\): (lognorm|pareto).* infinite"):
        make(problem)


def test_a_plan_without_such_an_action_has_a_value() -> None:
    problem = statehtn.with_cost(statehtn.read_hddl_text(TWO_WAYS, ONE_TASK), "b", 8)
    assert statehtn.plan(statehtn.with_cost(problem, "a", stats.lognorm(1, scale=15)), objective="evar 0.9").value == 16
