"""The paper's Algorithm 3 as readable code is a second oracle: it agrees with both compiled solvers."""

from __future__ import annotations

import pytest
from hypothesis import given

import statehtn
from statehtn import Status, validate
from statehtn.core.grounding import PLAIN, ground
from statehtn.model import Problem
from statehtn.reference import plan_based
from statehtn.risk import Utility, utility_for
from tests.differential.oracles import close_to, must_agree
from tests.strategies import problems, utilities

MOST_EXPANSIONS = 300


@pytest.mark.parametrize("solver", ["plan", "state"])
@given(problem=problems(), utility=utilities())
def test_same_optimum(solver: str, problem: Problem, utility: Utility) -> None:
    solution = plan_based(ground(problem, switches=PLAIN).to_model(), utility, most_expansions=MOST_EXPANSIONS)
    must_agree(problem, utility, solution, solver=solver)


def test_costs_that_depend_on_the_state() -> None:
    """The cheaper network by its bound is the more expensive one in every order: it goes back into the fringe."""
    domain = """
    (define (domain d) (:predicates (icy)) (:functions (total-cost)) (:task go)
      (:method by-road :parameters () :task (go) :ordered-subtasks (and (freeze) (drive)))
      (:method by-boat :parameters () :task (go) :ordered-subtasks (and (sail)))
      (:action freeze :parameters () :effect (icy))
      (:action sail :parameters () :effect (increase (total-cost) 2))
      (:action drive :parameters ()
        :effect (and (increase (total-cost) 1) (when (icy) (increase (total-cost) 3)))))
    """
    problem = statehtn.read_hddl_text(domain, "(define (problem p) (:domain d) (:htn :subtasks (and (go))) (:init))")
    solution = plan_based(ground(problem, switches=PLAIN).to_model(), utility_for("neutral"))
    assert solution.plan is not None
    assert [step.action for step in solution.plan.steps] == ["sail"]
    assert solution.risk_cost == 2
    assert solution.expanded == 4  # the root, `go`, and the two primitive networks


def test_the_papers_problem(p1: Problem) -> None:
    solution = plan_based(ground(p1, switches=PLAIN).to_model(), utility_for("averse", 0.9))
    assert solution.plan is not None
    assert validate(p1, solution.plan).valid
    assert solution.risk_cost == close_to(19.4)


def test_it_gives_up_when_told_to(p1: Problem) -> None:
    solution = plan_based(ground(p1, switches=PLAIN).to_model(), utility_for("neutral"), most_expansions=3)
    assert solution.status is Status.GAVE_UP
    assert solution.expanded == 3


def test_grounding_has_to_be_plain(p1: Problem) -> None:
    with pytest.raises(ValueError, match="plain"):
        plan_based(ground(p1).to_model(), utility_for("neutral"))


def test_the_old_name_of_algorithm_1_warns() -> None:
    with pytest.warns(DeprecationWarning, match="statehtn.reference"):
        from statehtn.decomposition import compute_utilities
    assert compute_utilities is statehtn.reference.compute_utilities
