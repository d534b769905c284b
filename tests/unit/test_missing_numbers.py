"""Costs that need numbers which `:init` does not give: told, and refused where the best plan has them."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

import statehtn
from statehtn.cli.program import main
from statehtn.hddl import read_hddl_text
from statehtn.model import Problem
from statehtn.model.cost.probabilities import CostWarning
from statehtn.model.cost.unknown import MissingNumber
from statehtn.settings import SearchName

DOMAIN = """(define (domain crossing) (:types bank) (:predicates (here ?b - bank) (storm))
(:functions (fare ?a ?b - bank) (toll ?b - bank) (risk) (delay))
(:task reach :parameters (?b - bank))
(:method by-boat :parameters (?a ?b - bank) :task (reach ?b) :subtasks (sail ?a ?b))
(:method by-bridge :parameters (?a ?b - bank) :task (reach ?b) :subtasks (walk ?a ?b))
(:action sail :parameters (?a ?b - bank) :precondition (here ?a) :effect (and (not (here ?a)) (here ?b)
  (increase (total-cost) 2) (increase (total-cost) (fare ?a ?b))
  (when (storm) (probabilistic (risk) (increase (total-cost) (delay))))))
(:action walk :parameters (?a ?b - bank) :precondition (here ?a) :effect (and (not (here ?a)) (here ?b)
  (increase (total-cost) (toll ?b)))))"""
FARE = "the cost of (sail right right): the value of (fare right right) is not defined; add"


def crossing(init: str) -> Problem:
    problem = (
        f"(define (problem p) (:objects left right - bank) (:init (here left) {init}) (:htn :subtasks (reach right)))"
    )
    return read_hddl_text(DOMAIN, problem)


COMPLETE = "(= (toll left) 0) (= (toll right) 5) (= (fare left right) 1) (= (fare right left) 1)"


def test_a_number_that_the_best_plan_does_not_need() -> None:
    """Nothing leads from right to right, but for all that grounding knows the action can be reached."""
    with pytest.warns(CostWarning) as caught:
        result = statehtn.plan(crossing(COMPLETE))
    assert [str(step.step) for step in result.steps] == ["(sail left right)"]
    assert (result.status, result.risk_cost, result.lower_bound) == (statehtn.Status.OPTIMAL, 3, 3)
    assert str(caught[0].message).startswith(f"domain:7:29: {FARE}")
    assert len(caught) == 1


@pytest.mark.filterwarnings("ignore::statehtn.model.cost.probabilities.CostWarning")
@pytest.mark.parametrize("search", ["astar", "weighted", "greedy", "anytime"])
def test_a_number_that_the_best_plan_needs(search: SearchName) -> None:
    """Sailing costs 2 at least, walking 5: whether it is better depends on the fare."""
    with pytest.raises(MissingNumber, match=re.escape("the value of (fare left right) is not defined; add")):
        statehtn.plan(crossing(COMPLETE.replace("(fare left right)", "(fare right right)")), search=search)


@pytest.mark.filterwarnings("ignore::statehtn.model.cost.probabilities.CostWarning")
def test_known_parts_of_a_cost_count() -> None:
    """Whatever the fare is, walking for 1 is better than the 2 that sailing costs at least."""
    problem = crossing("(= (toll right) 1)")
    for solver in ("state", "plan"):
        result = statehtn.plan(problem, solver=solver)
        assert ([str(one.step) for one in result.steps], result.risk_cost) == (["(walk left right)"], 1)
    first = statehtn.top_plans(problem, 1)
    assert first.proven == 1
    with pytest.raises(MissingNumber):
        statehtn.top_plans(problem, 2)
    with pytest.raises(MissingNumber):
        statehtn.compare_attitudes(crossing(""), alpha=1.0)


@pytest.mark.filterwarnings("ignore::statehtn.model.cost.probabilities.CostWarning")
def test_numbers_of_conditional_parts() -> None:
    complete = f"{COMPLETE} (= (fare left left) 1) (= (fare right right) 1)"
    assert statehtn.plan(crossing(complete)).risk_cost == 3  # there is no storm
    with pytest.raises(MissingNumber, match=re.escape("the value of (risk) is not defined")):
        statehtn.plan(crossing(f"{complete} (storm)"))
    with pytest.raises(MissingNumber, match=re.escape("the value of (delay) is not defined")):
        statehtn.plan(crossing(f"{complete} (storm) (= (risk) 0.5)"))
    assert statehtn.plan(crossing(f"{complete} (storm) (= (risk) 0.5) (= (delay) 2)")).risk_cost == 4


@pytest.mark.filterwarnings("ignore::statehtn.model.cost.probabilities.CostWarning")
def test_a_plan_that_a_limit_leaves_unvalidated(monkeypatch: pytest.MonkeyPatch) -> None:
    def interrupted(*_: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr("statehtn.found_plan.validate", interrupted)
    with pytest.raises(MissingNumber):
        statehtn.plan(crossing(""))
    assert statehtn.plan(crossing(COMPLETE)).risk_cost == 3


def test_the_command_line(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    domain, problem = tmp_path / "d.hddl", tmp_path / "p.hddl"
    domain.write_text(DOMAIN)
    problem.write_text("(define (problem p) (:objects a b - bank) (:init (here a)) (:htn :subtasks (reach b)))")
    assert main(["plan", str(domain), str(problem)]) == 30
    assert "is not defined; add (= (" in capsys.readouterr().err
