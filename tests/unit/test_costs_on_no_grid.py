"""Where no grid is exact, or none that is fine enough, the best plan is proven all the same."""

from __future__ import annotations

from pathlib import Path

import pytest

import statehtn
from statehtn import Status

PROBLEM = "(define (problem p) (:domain d) (:htn :ordered-subtasks (and (t))))"


def problem(*costs: str) -> statehtn.Problem:
    """One task, done by any of several actions of these costs."""
    names = [f"a{i}" for i in range(len(costs))]
    methods = (f"(:method m-{name} :parameters () :task (t) :ordered-subtasks (and ({name})))" for name in names)
    actions = (f"(:action {name} :parameters () :effect (and {cost}))" for name, cost in zip(names, costs, strict=True))
    domain = f"(define (domain d) (:task t :parameters ()) {' '.join(methods)} {' '.join(actions)})"
    return statehtn.read_hddl_text(domain, PROBLEM)


def either(*costs: str) -> str:
    """A cost with outcomes of the same probability."""
    share = 1 / len(costs)
    return f"(probabilistic {' '.join(f'{share} (increase (total-cost) {cost})' for cost in costs)})"


THIRDS = problem(either("1/3", "2/3"), either("1"))
FAR_APART = problem(either("12.34567", "99.123456"), either("100000"))
MANY_DIGITS = problem(either("3.14159265358979", "1.41421356237309"), either("2.71828182845905"))


@pytest.mark.parametrize(
    ("wanted", "objective", "value"),
    [
        (THIRDS, "cvar 0.9", 2 / 3),
        (THIRDS, "quantile 0.9", 2 / 3),
        (THIRDS, "overrun 0", 0.5),
        (THIRDS, "deadline 0.3333333333333333", 0.5),
        (FAR_APART, "cvar 0.6", 99.123456),
        (FAR_APART, "deadline 12.34567", 0.5),
        (MANY_DIGITS, "cvar 0.9", 2.71828182845905),
        (MANY_DIGITS, "deadline 1.41421356237309", 0.5),
    ],
)
def test_lists_of_costs(wanted: statehtn.Problem, objective: str, value: float) -> None:
    found = statehtn.plan(wanted, objective=objective)
    assert found.status is Status.OPTIMAL
    assert found.value == pytest.approx(value)


@pytest.mark.parametrize(
    ("law", "objective", "value"),
    [
        ("pert = [0, 50, 1e9]", "cvar 0.9", 1.2),
        ("distribution = 'gamma'\nparameters = { a = 2, scale = 1.5 }", "deadline 1", 0.8557),
        ("distribution = 'lognorm'\nparameters = { s = 0.5 }", "quantile 0.9", 1.2),
        ("distribution = 'pareto'\nparameters = { b = 1.2 }", "cvar 0.9", 1.2),
    ],
)
def test_continuous_laws(tmp_path: Path, law: str, objective: str, value: float) -> None:
    """Values are exact; only what no plan of the list has is bounded by a grid."""
    file = tmp_path / "costs.toml"
    file.write_text(f"[[costs]]\naction = 'a0'\n{law}\n", encoding="utf-8")
    wanted = statehtn.read_costs(file).apply(problem("", either("1.2")))
    found = statehtn.plan(wanted, objective=objective)
    assert found.status is Status.OPTIMAL
    assert found.value == pytest.approx(value, abs=1e-4)


def test_budgets_that_grids_cannot_tell_are_kept_or_not() -> None:
    wanted = problem(either("0.000001", "1000000", "2.0000005"), either("2", "3"))
    found = statehtn.plan(wanted, keep=["2.0000004 0.5"])
    assert found.status is Status.OPTIMAL
    assert [str(step) for step in found.plan.steps] == ["(a1)"]
    assert statehtn.plan(wanted, keep=["2.0000004 0.6"]).status is Status.UNSOLVABLE


def test_what_is_listed_beyond_the_wanted_plans_is_no_answer() -> None:
    seen: list[object] = []
    assert len(statehtn.plan(MANY_DIGITS, objective="cvar 0.9", progress=seen.append).steps) == 1
    assert all(isinstance(progress, statehtn.Progress) for progress in seen)
    best = statehtn.top_plans(FAR_APART, 1, objective="deadline 12.34567")
    assert (len(best), best.proven) == (1, 1)


@pytest.mark.parametrize("objective", ["deadline 1e200", "overrun 1e200", "piecewise 0:0 1e200:-1"])
def test_budgets_far_beyond_all_costs(objective: str) -> None:
    found = statehtn.plan(problem("(increase (total-cost) 1e-200)"), objective=objective, keep=["1e200 0.9"])
    assert (found.status, found.value) == (Status.OPTIMAL, 0)
