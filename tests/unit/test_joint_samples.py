"""Costs that were observed together, from a CSV file: what it may say, and what plans cost then."""

from __future__ import annotations

from pathlib import Path

import pytest

import statehtn
from statehtn import CostDistribution, InputError, Problem, UnsupportedError
from statehtn.hddl import read_hddl_text

DOMAIN = """
(define (domain roads)
  (:types place)
  (:predicates (open))
  (:task go :parameters (?to - place))
  (:method over-land :parameters (?to - place) :task (go ?to) :ordered-subtasks (and (drive ?to) (drive ?to)))
  (:method by-sea :parameters (?to - place) :task (go ?to) :ordered-subtasks (and (sail ?to)))
  (:action drive :parameters (?to - place) :effect (increase (total-cost) 3))
  (:action sail :parameters (?to - place) :effect (increase (total-cost) 7)))
"""
PROBLEM = (
    "(define (problem p) (:domain roads) (:objects home shop - place) (:htn :ordered-subtasks (and (go shop))) (:init))"
)
GOOD = "day,drive shop,(Sail SHOP)\nmonday,1,9\ntuesday,5,9\nmonday,3,0.5\n"


@pytest.fixture
def problem() -> Problem:
    return read_hddl_text(DOMAIN, PROBLEM)


def written(folder: Path, text: str) -> Path:
    file = folder / "days.csv"
    file.write_text(text, encoding="utf-8")
    return file


def test_each_day_is_a_scenario(problem: Problem, tmp_path: Path) -> None:
    days = statehtn.read_joint_samples(written(tmp_path, GOOD))
    assert repr(days) == "<cost table: 0 entries, 2 columns of 3 days>"
    observed = days.apply(problem)
    assert [scenario.name for scenario in observed.scenarios] == ["monday", "tuesday", "monday (line 4)"]
    assert [scenario.probability for scenario in observed.scenarios] == [pytest.approx(1 / 3)] * 3
    result = statehtn.plan(observed)
    assert result.plan is not None
    assert result.risk_cost == pytest.approx((2 + 10 + 6) / 3)  # what is done twice costs that day's cost twice
    assert result.plan.cost_distribution_given("tuesday") == CostDistribution.certain(10)
    law = result.plan.cost_distribution()
    assert isinstance(law, CostDistribution)
    assert [cost for _, cost in law.outcomes] == [2, 6, 10]


def test_actions_without_a_column_keep_their_cost(problem: Problem, tmp_path: Path) -> None:
    file = tmp_path / "costs.toml"
    written(tmp_path, "drive shop\n8\n9\n")
    file.write_text('[joint]\nsamples = "days.csv"\n[[costs]]\naction = "sail"\noutcomes = [[0.5, 4], [0.5, 6]]\n')
    table = statehtn.read_costs(file)
    assert table.files == (str(tmp_path / "days.csv"),)
    observed = table.apply(problem)
    assert [scenario.name for scenario in observed.scenarios] == ["day 1", "day 2"]
    result = statehtn.plan(observed)
    assert [str(step.step) for step in result.steps] == ["(sail shop)"]
    assert result.risk_cost == 5


def test_days_and_hidden_facts_are_independent(tmp_path: Path) -> None:
    text = PROBLEM.replace("(:init)", "(:init (probabilistic 0.5 (open) 0.5 ()))")
    domain = DOMAIN.replace("(increase (total-cost) 7)", "(when (open) (increase (total-cost) 7))")
    observed = statehtn.read_joint_samples(written(tmp_path, "drive shop\n1\n5\n")).apply(read_hddl_text(domain, text))
    assert [scenario.name for scenario in observed.scenarios] == ["(open) day 1", "(open) day 2", "day 1", "day 2"]
    assert statehtn.plan(observed).risk_cost == pytest.approx(3.5)


def test_written_problems_have_the_days(problem: Problem, tmp_path: Path) -> None:
    observed = statehtn.read_joint_samples(written(tmp_path, GOOD)).apply(problem)
    with pytest.warns(statehtn.HddlWarning, match="is an object of the problem"):
        again = read_hddl_text(*statehtn.write_hddl(observed))
    before, after = statehtn.plan(observed).plan, statehtn.plan(again).plan
    assert before is not None
    assert after is not None
    assert before.cost_distribution() == after.cost_distribution()


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "expected a first line with an action instance for each column, found none"),
        ("day\n1\n", "expected a first line with an action instance for each column, found none"),
        ("drive shop\n", "expected a line of costs for each observed day, found none"),
        ("drive shop,sail shop\n1,\n", "line 2, column 'sail shop': expected a cost, found nothing"),
        ("drive shop,sail shop\n1\n", "line 2: expected 2 columns, found 1"),
        ("drive shop,sail shop\n1,2\n\n3,-4\n", "line 4, column 'sail shop': a cost must be a finite number and at"),
        ("drive shop\ninf\n", "line 2, column 'drive shop': a cost must be a finite number"),
        ("drive shop\nmuch\n", "line 2, column 'drive shop': expected a cost, found 'much'"),
        ("drive shop,(DRIVE  shop)\n1,2\n", r"column '\(DRIVE  shop\)': this is the second column for \(DRIVE shop\)"),
        ("drive *\n1\n", r"column 'drive \*': expected an action with its objects"),
        ('drive shop\n"1\n', "this is no CSV"),
    ],
)
def test_files_that_make_no_sense(text: str, message: str, tmp_path: Path) -> None:
    with pytest.raises(InputError, match=message) as caught:
        statehtn.read_joint_samples(written(tmp_path, text))
    assert "days.csv" in caught.value.message
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("drvie shop\n1\n", "column 'drvie shop': 'action': unknown action 'drvie'; did you mean 'drive'"),
        ("drive shp\n1\n", "column 'drive shp': 'arguments': unknown object 'shp'"),
        ("drive\n1\n", r"column 'drive': 'arguments': expected 1 for \(drive \?to - place\), found 0"),
    ],
)
def test_columns_that_are_no_action(text: str, message: str, problem: Problem, tmp_path: Path) -> None:
    with pytest.raises(InputError, match=message):
        statehtn.read_joint_samples(written(tmp_path, text)).apply(problem)


def test_an_entry_that_never_counts(problem: Problem, tmp_path: Path) -> None:
    file = tmp_path / "costs.toml"
    written(tmp_path, GOOD)
    file.write_text('joint.samples = "days.csv"\n[[costs]]\naction = "sail"\narguments = ["shop"]\ncost = 1\n')
    with pytest.raises(InputError, match=r"entry 1 of 'costs': it never counts, as column '\(Sail SHOP\)' says the"):
        statehtn.read_costs(file).apply(problem)


def test_a_side_file_that_makes_no_sense(tmp_path: Path) -> None:
    file = tmp_path / "costs.toml"
    file.write_text("joint = 3\n")
    with pytest.raises(InputError, match=r"'joint': expected a table such as \[joint\] in TOML, found 3"):
        statehtn.read_costs(file)
    file.write_text("[joint]\nfile = 'days.csv'\n")
    with pytest.raises(InputError, match="'joint': unknown key 'file'; there are samples"):
        statehtn.read_costs(file)
    file.write_text("[joint]\nsamples = 'days.csv'\n")
    with pytest.raises(InputError, match=r"cannot read '.*days\.csv': No such file"):
        statehtn.read_costs(file)


def test_too_many_days(tmp_path: Path) -> None:
    file = written(tmp_path, "drive shop\n" + "1\n" * 257)
    with pytest.raises(UnsupportedError, match="found 257 days, and at most 256"):
        statehtn.read_joint_samples(file)
    chance = "(probabilistic 0.5 (open) 0.5 ())"
    hidden = read_hddl_text(DOMAIN, PROBLEM.replace("(:init)", f"(:init {chance})"))
    file = written(tmp_path, "drive shop\n" + "1\n" * 200)
    with pytest.raises(UnsupportedError, match="makes 400 scenarios"):
        statehtn.read_joint_samples(file).apply(hidden)
