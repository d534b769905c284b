"""The Python interface: arguments, results, limits and endings."""

from __future__ import annotations

import json
import signal
import subprocess
import sys
import threading
import time
from decimal import Decimal
from fractions import Fraction

import pytest

import statehtn
from statehtn.core.searches import SEARCHES
from statehtn.settings import Settings
from tests.test_minimal import DOMAIN, PROBLEM

STATISTICS = {
    "expanded",
    "generated",
    "evaluated",
    "dead_ends",
    "facts",
    "actions",
    "tasks",
    "methods",
    "parse_seconds",
    "ground_seconds",
    "search_seconds",
    "validate_seconds",
    "peak_memory_mb",
}
KEYS = [
    "status",
    "problem_class",
    "solver",
    "heuristic",
    "objective",
    "attitude",
    "alpha",
    "plan",
    "length",
    "expected_cost",
    "risk_cost",
    "expected_utility",
    "log10_expected_utility",
    "value",
    "value_unit",
    "lower_bound",
    "gap",
    "keep",
    "scenarios",
    "correlation",
    "validated",
    "stopped",
    "unread",
    "statistics",
]
UNSOLVABLE = PROBLEM.replace("(away)", "(home)")
# One can be in any two of these places but never in all three; neither relaxed reachability nor pairs of facts tell
# that, and the networks grow for ever.
ENDLESS_DOMAIN = """
(define (domain endless)
  (:predicates (here) (there) (yonder))
  (:functions (total-cost) - number)
  (:task wander :parameters ())
  (:method on :parameters () :task (wander) :subtasks (and (go) (back) (forth) (wander) (wander)))
  (:method rest :parameters () :task (wander) :subtasks (and (go)))
  (:action go :parameters () :effect (and (yonder) (not (here)) (increase (total-cost) 1)))
  (:action back :parameters () :effect (and (here) (not (there)) (increase (total-cost) 1)))
  (:action forth :parameters () :effect (and (there) (not (yonder)) (increase (total-cost) 1)))
  (:action be-everywhere :parameters () :precondition (and (here) (there) (yonder))))
"""
ENDLESS_PROBLEM = """
(define (problem p) (:domain endless)
  (:htn :parameters () :ordered-subtasks (and (wander) (be-everywhere))) (:init (here) (there)))
"""


@pytest.fixture
def problem() -> statehtn.Problem:
    return statehtn.read_hddl_text(DOMAIN, PROBLEM)


@pytest.mark.parametrize(
    "arguments",
    [
        {"attitude": "averse"},
        {"attitude": "averse", "alpha": 0.0},
        {"attitude": "seeking", "alpha": -1.0},
        {"attitude": "seeking", "alpha": float("nan")},
        {"alpha": 0.5},
        {"attitude": "brave"},
        {"heuristic": "magic"},
        {"solver": "oracle"},
        {"solver": "plan", "heuristic": "lmcut"},
        {"solver": "plan", "search": "greedy"},
        {"solver": "plan", "branch": "none"},
        {"search": "greedy", "heuristic": "auto"},
        {"branch": "all"},
        {"search": "depth-first"},
        {"weight": 2.0},
        {"search": "weighted", "weight": 0.5},
        {"search": "weighted", "weight": float("inf")},
        {"search": "weighted", "weight": Fraction(1, 2)},
        {"time_limit": -1.0},
        {"time_limit": 0.0},
        {"memory_limit": -5.0},
        {"memory_limit": float("nan")},
    ],
)
def test_arguments_out_of_range(problem: statehtn.Problem, arguments: dict[str, object]) -> None:
    with pytest.raises(statehtn.UsageError):
        statehtn.plan(problem, **arguments)


def test_result_of_an_optimal_plan(problem: statehtn.Problem) -> None:
    result = statehtn.plan(problem, attitude="averse", alpha=0.9)
    found = result.to_dict()
    assert list(found) == KEYS
    assert set(found["statistics"]) == STATISTICS
    assert json.loads(json.dumps(found, allow_nan=False)) == found
    assert found["plan"] == [
        {"action": "take-train", "arguments": [], "expected_cost": 4.0, "risk_cost": 4.0, "outcomes": [[1.0, 4.0]]}
    ]
    assert (found["status"], found["length"], found["problem_class"]) == ("optimal", 1, "PS10110")
    assert found["expected_cost"] == found["risk_cost"] == 4.0
    assert found["lower_bound"] == pytest.approx(4.0, rel=1e-9)
    assert found["lower_bound"] <= found["risk_cost"]
    assert float(found["expected_utility"]) == pytest.approx(-40.66470493)
    assert bool(result)
    assert "take-train" in str(result)


def test_neutral_result_has_no_logarithm(problem: statehtn.Problem) -> None:
    result = statehtn.plan(problem)
    assert result.problem_class == "PS10011"
    assert result.log10_expected_utility is None
    assert result.alpha is None
    assert float(result.expected_utility or "nan") == pytest.approx(-3.4)


def test_unsolvable_is_a_value() -> None:
    result = statehtn.plan(statehtn.read_hddl_text(DOMAIN, UNSOLVABLE))
    assert result.status is statehtn.Status.UNSOLVABLE
    assert not result
    found = result.to_dict()
    unknown = ("plan", "length", "expected_cost", "risk_cost", "expected_utility", "lower_bound")
    assert all(found[key] is None for key in unknown)
    assert "unsolvable" in str(result)


@pytest.mark.parametrize("search", statehtn.SEARCHES)
@pytest.mark.parametrize("heuristic", statehtn.HEURISTICS)
def test_every_registered_choice_finds_a_valid_plan(problem: statehtn.Problem, heuristic: str, search: str) -> None:
    if search != "greedy" and not statehtn.HEURISTICS[heuristic].admissible:
        with pytest.raises(statehtn.UsageError, match=f"'{heuristic}' may estimate more than is true.*greedy search"):
            statehtn.plan(problem, heuristic=heuristic, search=search)
        return
    result = statehtn.plan(problem, heuristic=heuristic, search=search)
    assert result.plan is not None
    assert result.heuristic == heuristic
    assert result.lower_bound is not None
    assert result.lower_bound <= (result.risk_cost or 0.0)
    if search in ("astar", "anytime"):
        assert result.status is statehtn.Status.OPTIMAL


def test_time_limit_is_a_value(problem: statehtn.Problem) -> None:
    result = statehtn.plan(problem, time_limit=1e-9)
    assert result.status in (statehtn.Status.TIME_LIMIT, statehtn.Status.OPTIMAL)
    assert result.statistics.ground_seconds is not None


@pytest.mark.parametrize("solver", statehtn.SOLVERS)
def test_endless_search_ends_at_the_time_limit_with_a_bound(solver: str) -> None:
    endless = statehtn.read_hddl_text(ENDLESS_DOMAIN, ENDLESS_PROBLEM)
    seen: list[statehtn.Progress] = []
    result = statehtn.plan(endless, solver=solver, time_limit=0.5, progress=seen.append)
    assert result.status is statehtn.Status.TIME_LIMIT
    assert result.lower_bound is not None
    assert result.lower_bound > 0
    assert result.statistics.search_seconds == pytest.approx(0.5, abs=0.3)
    assert 2 <= len(seen) <= 20
    assert [progress.expanded for progress in seen] == sorted(progress.expanded for progress in seen)


def test_endless_search_ends_at_the_memory_limit_with_a_bound() -> None:
    # In a process of its own: memory that other tests have freed would have to be filled first.
    script = f"""
import statehtn
from statehtn.limits import resident_mb

endless = statehtn.read_hddl_text({ENDLESS_DOMAIN!r}, {ENDLESS_PROBLEM!r})
limit = resident_mb() + 40
result = statehtn.plan(endless, heuristic="blind", memory_limit=limit, time_limit=30)
assert result.status is statehtn.Status.MEMORY_LIMIT, result.status
assert result.lower_bound is not None
assert resident_mb() < limit + 20
"""
    run = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=False)
    assert run.returncode == 0, run.stderr


def test_a_progress_callback_may_raise() -> None:
    endless = statehtn.read_hddl_text(ENDLESS_DOMAIN, ENDLESS_PROBLEM)

    def refuse(_: statehtn.Progress) -> None:
        raise RuntimeError("enough")

    with pytest.raises(RuntimeError, match="enough"):
        statehtn.plan(endless, time_limit=10, progress=refuse)


@pytest.mark.parametrize("solver", statehtn.SOLVERS)
def test_an_interrupt_is_a_value(solver: str) -> None:
    endless = statehtn.read_hddl_text(ENDLESS_DOMAIN, ENDLESS_PROBLEM)
    timer = threading.Timer(0.3, lambda: signal.raise_signal(signal.SIGINT))
    timer.start()
    start = time.monotonic()
    result = statehtn.plan(endless, solver=solver, time_limit=60)
    timer.join()
    assert result.status is statehtn.Status.INTERRUPTED
    assert time.monotonic() - start < 20
    assert result.lower_bound is not None


def test_huge_limits_are_none(problem: statehtn.Problem) -> None:
    assert statehtn.plan(problem, time_limit=float("inf"), memory_limit=1e9).status is statehtn.Status.OPTIMAL
    for beyond_all_clocks_and_machines in (2**63 / 1e6, 1.8e13, 1.9e13, 1e30, 1e308):
        limits = {"time_limit": beyond_all_clocks_and_machines, "memory_limit": beyond_all_clocks_and_machines}
        assert statehtn.plan(problem, **limits).status is statehtn.Status.OPTIMAL
        assert len(statehtn.top_plans(problem, 2, **limits)) > 0


def test_every_search_has_a_heuristic_of_its_own() -> None:
    assert [Settings.of(search=search).heuristic for search in SEARCHES] == ["auto", "auto", "ff", "auto"]
    assert Settings.of(search="greedy", heuristic="tdg").heuristic == "tdg"


def test_greedy_search_goes_on_for_a_cheaper_plan() -> None:
    """One way costs 9, the other one, with more to do, 3."""
    domain = """
    (define (domain d) (:predicates (p)) (:functions (total-cost)) (:task go :parameters ())
      (:method a :parameters () :task (go) :ordered-subtasks (and (dear)))
      (:method b :parameters () :task (go) :ordered-subtasks (and (cheap) (cheap) (cheap)))
      (:action dear :parameters () :effect (increase (total-cost) 9))
      (:action cheap :parameters () :effect (increase (total-cost) 1)))
    """
    lifted = statehtn.read_hddl_text(domain, "(define (problem p) (:domain d) (:htn :subtasks (and (go))) (:init))")
    result = statehtn.plan(lifted, search="greedy", heuristic="blind")
    assert result.risk_cost == 3


def test_the_weighted_search_has_a_default_weight() -> None:
    assert Settings.of(search="weighted").weight == 2.0
    assert Settings.of(search="weighted", weight=1.5).weight == 1.5
    assert type(Settings.of(search="weighted", weight=Decimal("2.5")).weight) is float
    assert Settings.of().weight == 1.0


def test_import_loads_nothing_but_the_standard_library() -> None:
    code = "import sys; before = set(sys.modules); import statehtn; print(*(set(sys.modules) - before))"
    loaded = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout.split()
    assert {name.partition(".")[0] for name in loaded} <= sys.stdlib_module_names | {"statehtn"}
    own = {name.split(".")[1] for name in loaded if name.startswith("statehtn.")}
    later = {
        "_relax",
        "build",
        "cli",
        "core",
        "decomposition",
        "display",
        "experiments",
        "hddl",
        "interop",
        "planner",
        "reference",
        "semantics",
        "validation",
    }
    assert "model" in own
    assert own.isdisjoint(later)


def test_the_old_name_of_a_status_warns_of_the_new_one() -> None:
    with pytest.warns(DeprecationWarning, match="GAVE_UP"):
        status = getattr(statehtn.Status, "EXHAUSTED")  # noqa: B009 - not known to type checkers
    assert status is statehtn.Status.GAVE_UP
