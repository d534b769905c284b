"""The k best plans: what a caller meets, on problems made to ask one question each."""

from __future__ import annotations

import json
import os
import signal
import threading
from pathlib import Path

import pytest

import statehtn
from statehtn import RankedPlan, Status, TopPlans, TopProgress, UsageError, validate
from statehtn.cli import main
from tests.test_minimal import DOMAIN, PROBLEM
from tests.unit.test_cli import Files
from tests.unit.test_cli import files as files  # a fixture
from tests.unit.test_planner import ENDLESS_DOMAIN, ENDLESS_PROBLEM, UNSOLVABLE

KEYS = [
    *("status", "stopped", "k", "distinct", "problem_class", "heuristic", "objective", "value_unit"),
    *("attitude", "alpha", "plans", "proven", "all", "lower_bound", "keep", "unread", "statistics"),
]
PLAN_KEYS = [
    *("rank", "proven", "validated", "plan", "length", "expected_cost", "risk_cost"),
    *("expected_utility", "log10_expected_utility", "value", "keep"),
]
MOST = 50

# `look` costs and changes nothing; `pay` costs 1; everything else is in the methods of `t`.
FREE = """
(define (domain d) (:predicates (seen)) (:functions (total-cost))
  (:task t :parameters ()) (:task u :parameters ())
  {methods}
  (:action look :parameters () :effect (and))
  (:action pay :parameters () :effect (increase (total-cost) 1)))
"""


def find(methods: str, tasks: str, k: int, **options: object) -> TopPlans:
    """The best plans of a problem in FREE; `methods`: a task and its subtasks on each line."""
    lines = [line.split(None, 1) for line in methods.strip().splitlines()]
    text = " ".join(
        f"(:method m{number} :parameters () :task ({task}) {subtasks})" for number, (task, subtasks) in enumerate(lines)
    )
    problem = statehtn.read_hddl_text(
        FREE.format(methods=text), f"(define (problem p) (:domain d) (:htn {tasks}) (:init))"
    )
    result = statehtn.top_plans(problem, k, **{"time_limit": 20, **options})
    assert all(validate(problem, ranked.plan).valid for ranked in result)
    return result


class Interruption:
    """Presses Ctrl-C, some time after the search has found a plan."""

    def __init__(self) -> None:
        self.is_sent = False

    def __call__(self, progress: TopProgress) -> None:
        if progress.proven and not self.is_sent:
            self.is_sent = True
            threading.Timer(0.1, lambda: os.kill(os.getpid(), signal.SIGINT)).start()


def words(result: TopPlans) -> list[str]:
    return [" ".join(step.action for step in ranked.plan.steps) for ranked in result]


# `close` makes what both others cost depend on their order; before it `second` might be free for all that bounds know.
TWO_ORDERS = """
(define (domain d) (:predicates (open) (one) (two)) (:functions (total-cost))
  (:action close :parameters () :effect (not (open)))
  (:action first :parameters () :effect (and (one) (when (two) (increase (total-cost) 1))))
  (:action second :parameters () :effect (and (two)
    (when (and (not (open)) (one)) (increase (total-cost) 6))
    (when (and (not (open)) (not (one))) (increase (total-cost) 2)))))
"""


@pytest.mark.parametrize("k", [1, 2])
@pytest.mark.parametrize(
    ("then", "order"), [("", ""), ("(4 (close))", "(< 2 4) (< 3 4)")], ids=["a plan", "a node on the way"]
)
def test_the_cheaper_order_of_the_same_actions_may_be_found_last(then: str, order: str, k: int) -> None:
    problem = statehtn.read_hddl_text(
        TWO_ORDERS,
        f"""(define (problem p) (:domain d) (:init (open)) (:htn
          :subtasks (and (1 (close)) (2 (first)) (3 (second)) {then})
          :ordering (and (< 1 2) (< 1 3) {order})))""",
    )
    result = statehtn.top_plans(problem, k, distinct="multiset", heuristic="blind", time_limit=20)
    assert [ranked.risk_cost for ranked in result] == [3.0]
    assert words(result)[0].startswith("close second first")


def test_decompositions_of_the_same_actions_are_one_plan() -> None:
    methods = """
    t :ordered-subtasks (and (u) (pay))
    t :ordered-subtasks (and (pay) (u))
    u :ordered-subtasks (and (pay))
    """
    result = find(methods, ":ordered-subtasks (and (t))", 5)
    assert words(result) == ["pay pay"]
    assert result.is_all
    assert result.status is Status.OPTIMAL


def test_recursion_without_an_action_is_no_other_plan() -> None:
    methods = """
    t :ordered-subtasks (and (u) (t))
    t :ordered-subtasks (and (pay))
    u :subtasks ()
    """
    result = find(methods, ":ordered-subtasks (and (t))", 5)
    assert words(result) == ["pay"]
    assert result.is_all


def test_a_loop_that_costs_nothing_is_a_plan_each_time() -> None:
    methods = """
    t :ordered-subtasks (and (look) (t))
    t :subtasks ()
    """
    for distinct in ("sequence", "multiset"):
        result = find(methods, ":ordered-subtasks (and (t))", 4, distinct=distinct)
        assert words(result) == ["", "look", "look look", "look look look"]
        assert not result.is_all
        assert result.lower_bound == 0


def test_networks_that_grow_for_ever_end_with_what_is_known() -> None:
    methods = """
    t :ordered-subtasks (and (t) (t))
    t :subtasks ()
    """
    result = find(methods, ":ordered-subtasks (and (t))", 2, progress=Interruption())
    assert words(result) == [""]
    assert result.status is Status.SOLVED
    assert result.stopped is Status.INTERRUPTED
    assert not result.is_all
    assert result.proven == 1  # nothing costs less than nothing
    assert result.lower_bound == 0


@pytest.mark.parametrize(("distinct", "expected"), [("sequence", 6), ("multiset", 1)])
def test_orders_of_the_same_actions(distinct: str, expected: int) -> None:
    # An action that costs and changes nothing has its place in a sequence all the same.
    result = find("t :subtasks ()", ":subtasks (and (pay) (pay) (look) (look))", MOST, distinct=distinct)
    assert len(result) == expected
    assert result.is_all


def test_a_multiset_comes_in_its_cheapest_order() -> None:
    domain = """
    (define (domain d) (:predicates (wet)) (:functions (total-cost)) (:requirements :conditional-effects)
      (:action rain :parameters () :effect (wet))
      (:action walk :parameters () :effect (when (wet) (increase (total-cost) 7))))
    """
    problem = statehtn.read_hddl_text(
        domain, "(define (problem p) (:domain d) (:htn :subtasks (and (rain) (walk))) (:init))"
    )
    assert [ranked.risk_cost for ranked in statehtn.top_plans(problem, 5)] == [0, 7]
    (only,) = statehtn.top_plans(problem, 5, distinct="multiset")
    assert [step.action for step in only.plan.steps] == ["walk", "rain"]


def test_it_is_a_sequence() -> None:
    result = statehtn.top_plans(statehtn.read_hddl_text(DOMAIN, PROBLEM), 2, attitude="averse", alpha=0.9)
    assert len(result) == 2
    assert isinstance(result[0], RankedPlan)
    assert [ranked.rank for ranked in result] == [1, 2]
    assert result[-1].rank == 2
    assert [ranked.rank for ranked in result[1:]] == [2]
    assert result[0].risk_cost < result[1].risk_cost
    assert "(take-train)" in str(result)
    assert "<td" in result._repr_html_()
    assert result.to_dict()["plans"][1]["plan"][0]["action"] == "take-car"


def test_no_plans() -> None:
    result = statehtn.top_plans(statehtn.read_hddl_text(DOMAIN, UNSOLVABLE), 3)
    assert result.status is Status.UNSOLVABLE
    assert not result
    assert result.is_all
    assert "unsolvable" in str(result)


def test_a_limit_leaves_what_was_proven_and_progress_is_told() -> None:
    seen: list[TopProgress] = []
    endless = statehtn.read_hddl_text(ENDLESS_DOMAIN, ENDLESS_PROBLEM.replace(" (be-everywhere)", ""))
    result = statehtn.top_plans(endless, 100_000, time_limit=0.5, progress=seen.append)
    assert result.stopped is Status.TIME_LIMIT
    assert result.status is (Status.SOLVED if result.plans else Status.TIME_LIMIT)
    assert [progress.proven for progress in seen] == sorted(progress.proven for progress in seen)
    assert len(seen) > 1
    if result.plans:
        assert result.proven == sum(ranked.risk_cost <= result.lower_bound for ranked in result)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"k": 0}, "the number of plans must be from 1 to 1000000000, found 0"),
        ({"k": 10**30}, "must be from 1"),
        ({"k": 10**5000}, "must be from 1"),
        ({"k": 1, "distinct": "set"}, "'set'; there are sequence, multiset"),
        ({"k": 1, "heuristic": "ff"}, "'ff' may estimate more than is true.*take one of blind, tdg.*potential-hmax$"),
        ({"k": 1, "heuristic": "auto"}, "heuristic for the best plans 'auto'.*there are blind, tdg.*potential-hmax$"),
        ({"k": 1, "attitude": "averse"}, "alpha"),
        ({"k": 1, "time_limit": -1}, "time limit"),
    ],
)
def test_wrong_arguments(arguments: dict[str, object], message: str) -> None:
    with pytest.raises(UsageError, match=message):
        statehtn.top_plans(statehtn.read_hddl_text(DOMAIN, PROBLEM), **arguments)


def test_readable(files: Files, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["top", "9", files["domain"], files["problem"], "--attitude", "seeking", "--alpha", "0.9"]) == 0
    captured = capsys.readouterr()
    assert captured.err == ""
    for text in ("All 2 plans for a risk-seeking agent with alpha 0.9", "log10 EU", "(take-train)", "no other plans"):
        assert text in captured.out
    assert all(line == line.rstrip() for line in captured.out.splitlines())
    assert main(["top", "1", files["domain"], files["problem"]]) == 0
    assert "no other plan has a higher expected utility" in capsys.readouterr().out


def test_json_and_quiet(files: Files, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["top", "2", files["domain"], files["problem"], "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert list(found) == KEYS
    assert [list(entry) for entry in found["plans"]] == [PLAN_KEYS] * 2
    assert main(["top", "2", files["domain"], files["problem"], "--quiet"]) == 0
    assert capsys.readouterr().out == "(take-car)\n(take-train)\n"


def test_every_ending_has_its_exit_code_and_object(files: Files, capsys: pytest.CaptureFixture[str]) -> None:
    endless = [files["endless-domain"], files["endless"]]
    for arguments, code in (
        ([files["domain"], files["unsolvable"]], 10),
        ([*endless, "--time-limit", "0.2"], 20),
        ([*endless, "--time-limit", "0.000001"], 20),
        ([*endless, "--memory-limit", "1"], 21),
    ):
        assert main(["top", "3", *arguments, "--json"]) == code
        found = json.loads(capsys.readouterr().out)
        assert list(found) == KEYS
        assert found["plans"] == []
    for arguments, code in ((["0"], 2), (["three"], 2), (["2", "--heuristic", "ff"], 2)):
        assert main(["top", *arguments[:1], files["domain"], files["problem"], *arguments[1:]]) == code
        assert capsys.readouterr().err.startswith("error: ")
    assert main(["top", "3", files["domain"], "nowhere.hddl"]) == 30


def test_an_interruption_ends_in_what_is_known() -> None:
    endless = statehtn.read_hddl_text(ENDLESS_DOMAIN, ENDLESS_PROBLEM.replace(" (be-everywhere)", ""))
    result = statehtn.top_plans(endless, 100_000, progress=Interruption(), time_limit=20)
    assert result.stopped is Status.INTERRUPTED
    assert result.status is Status.SOLVED
    assert result.proven > 0
    assert not result.is_all


def test_output(files: Files, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    folder = tmp_path / "plans"
    top = ["top", "2", files["domain"], files["problem"], "--quiet", "--output"]
    assert main([*top, str(folder)]) == 0
    assert sorted(path.name for path in folder.iterdir()) == ["plan-1.txt", "plan-2.txt"]
    for path in folder.iterdir():
        assert main(["validate", files["domain"], files["problem"], str(path)]) == 0
    capsys.readouterr()
    for wrong, reason in (
        (folder, "holds plans already ('plan-1.txt')"),
        (folder / "plan-1.txt", "it is not a directory"),
        (tmp_path / "no" / "where", "there is no directory"),
    ):
        assert main([*top, str(wrong)]) == 2
        assert reason in capsys.readouterr().err
    assert main(["top", "2", files["domain"], files["unsolvable"], "--output", str(tmp_path / "none")]) == 10
    assert not (tmp_path / "none").exists()


UNORDERED = """(define (domain d) (:functions (total-cost) - number)
  (:task t :parameters ())
  (:method m :parameters () :task (t) :subtasks (and (a) (b)))
  (:action a :parameters () :effect (increase (total-cost) 1))
  (:action b :parameters () :effect (increase (total-cost) 2)))"""


def test_the_best_plan_alone_leaves_others_that_differ_in_order() -> None:
    """One plan is found without a look at the other orders of its actions, so nothing is known of their number."""
    problem = statehtn.read_hddl_text(UNORDERED, "(define (problem p) (:domain d) (:htn :subtasks (and (t))) (:init))")
    one = statehtn.top_plans(problem, 1)
    assert (one.status, one.is_all, one.proven, one.lower_bound) == (Status.OPTIMAL, False, 1, 3)
    all_of_them = statehtn.top_plans(problem, 3)
    assert (len(all_of_them.plans), all_of_them.is_all) == (2, True)
    assert statehtn.top_plans(problem, 1, distinct="multiset").is_all
