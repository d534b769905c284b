"""The plan-based solver's optimum is the optimum, with and without its refinements."""

from __future__ import annotations

from pathlib import Path

import pytest
from hypothesis import given

import statehtn
from statehtn import Status, validate
from statehtn.core.grounding import GroundingSwitches, ground
from statehtn.core.plan_based import BRANCHES, search_networks
from statehtn.core.pricing import price
from statehtn.core.search import last_of
from statehtn.core.searches import TAKES
from statehtn.model import Problem
from statehtn.risk import Utility
from tests.brute_force import optimal_risk_cost
from tests.differential.oracles import LIMITS, close_to, must_cost, must_have_ended, solve
from tests.shares import share_of_examples
from tests.strategies import grounding_switches, problems, utilities

DOMAINS = Path(__file__).parents[2] / "domains"


def check(problem: Problem, utility: Utility, result: statehtn.Result) -> None:
    optimum = optimal_risk_cost(problem, utility)
    assert result.problem_class.startswith("PP")
    if result.stopped is not None:  # a space that recursion makes infinite
        assert optimum is None or result.lower_bound is None or result.lower_bound <= optimum * (1 + 1e-9) + 1e-9
    must_have_ended(result.stopped)
    if optimum is None:
        assert result.status is Status.UNSOLVABLE
        assert result.plan is None
    else:
        assert result.status is Status.OPTIMAL
        assert validate(problem, result.plan).risk_cost(utility) == close_to(optimum)
        assert result.risk_cost == close_to(optimum)
        assert result.lower_bound == close_to(optimum)


@pytest.mark.parametrize("branch", BRANCHES)
@given(problem=problems(), utility=utilities())
def test_optimum(branch: str, problem: Problem, utility: Utility) -> None:
    check(problem, utility, solve(problem, utility, solver="plan", branch=branch))


@given(problem=problems(orders=("total",)), utility=utilities())
def test_optimum_of_totally_ordered_problems(problem: Problem, utility: Utility) -> None:
    check(problem, utility, solve(problem, utility, solver="plan"))


@given(problem=problems(orders=("none", "partial")), utility=utilities())
def test_optimum_of_partially_ordered_problems(problem: Problem, utility: Utility) -> None:
    check(problem, utility, solve(problem, utility, solver="plan"))


@pytest.mark.parametrize("checks_preconditions", [True, False])
@pytest.mark.parametrize("heuristic", TAKES["plan", "astar"])
@share_of_examples(2)  # for each heuristic
@given(problem=problems(), utility=utilities(), switches=grounding_switches())
def test_refinements_keep_the_optimum(
    checks_preconditions: bool, heuristic: str, problem: Problem, utility: Utility, switches: GroundingSwitches
) -> None:
    optimum = optimal_risk_cost(problem, utility)
    outcomes = search_networks(
        price(ground(problem, switches=switches), utility),
        heuristic=heuristic,
        checks_preconditions=checks_preconditions,
        limits=LIMITS,
    )
    outcome = last_of(outcomes)
    must_have_ended(outcome.stopped)
    assert (outcome.plan is None) == (optimum is None)
    if outcome.plan is not None:
        must_cost(problem, outcome.plan, utility, optimum)


@given(problem=problems(), utility=utilities())
def test_a_space_that_is_exhausted_is_exhausted_by_both_solvers(problem: Problem, utility: Utility) -> None:
    by_networks = solve(problem, utility, solver="plan")
    by_states = solve(problem, utility)
    must_have_ended(by_networks.stopped)
    must_have_ended(by_states.stopped)
    assert by_networks.status is by_states.status
    if by_states.plan is not None:
        assert by_networks.risk_cost == close_to(by_states.risk_cost)


def instances() -> list[tuple[Path, Path]]:
    names = ["av/p1", "av/p2", "av/p3", "av/p4", "av/p5", "marine/p1"]
    names += sorted(f"satellite/{path.stem}" for path in DOMAINS.glob("satellite/RA-*mod.hddl"))
    return [((DOMAINS / name).parent / "domain.hddl", DOMAINS / f"{name}.hddl") for name in names]


@pytest.mark.parametrize(("attitude", "alpha"), [("neutral", None), ("averse", 0.5), ("seeking", 0.5)])
@pytest.mark.parametrize(("domain", "problem"), instances(), ids=lambda path: path.stem)
def test_both_solvers_prove_the_same_risk_cost(domain: Path, problem: Path, attitude: str, alpha: float | None) -> None:
    read = statehtn.read_hddl(domain, problem)
    by_networks = statehtn.plan(read, attitude=attitude, alpha=alpha, solver="plan", time_limit=60)
    by_states = statehtn.plan(read, attitude=attitude, alpha=alpha)
    assert by_networks.status is Status.OPTIMAL
    assert by_networks.risk_cost == close_to(by_states.risk_cost)
