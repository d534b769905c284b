"""The paper's four kinds of cost functions, as Python has them; errors of callables; tables of their answers."""

from __future__ import annotations

import re
import time
from collections.abc import Callable
from typing import Any

import pytest

import statehtn
from statehtn import CostDistribution, InputError, Problem, Status, UnsupportedError, UsageError, with_cost
from statehtn.model import Atom

DOMAIN = """
(define (domain trips)
  (:types place)
  (:constants hub - place)
  (:predicates (at ?p - place) (icy ?p - place) (road ?a ?b - place))
  (:task trip :parameters (?b - place))
  (:method direct :parameters (?a ?b - place) :task (trip ?b) :precondition (at ?a) :subtasks (drive ?a ?b))
  (:method by-hub :parameters (?a ?b - place) :task (trip ?b) :precondition (at ?a)
    :ordered-subtasks (and (drive ?a hub) (salt ?b) (drive hub ?b)))
  (:action drive :parameters (?a ?b - place) :precondition (and (at ?a) (road ?a ?b))
    :effect (and (not (at ?a)) (at ?b) (increase (total-cost) 1)))
  (:action salt :parameters (?p - place) :precondition (icy ?p)
    :effect (and (not (icy ?p)) (increase (total-cost) 1))))
"""
PROBLEM = """
(define (problem trip-1) (:domain trips)
  (:objects home work - place)
  (:htn :subtasks (trip work))
  (:init (at home) (icy work) (road home work) (road home hub) (road hub work)))
"""
HOURS = {("home", "work"): 2.0, ("home", "hub"): 1.0, ("hub", "work"): 4.0}


@pytest.fixture
def problem() -> Problem:
    return statehtn.read_hddl_text(DOMAIN, PROBLEM)


def costs(problem: Problem, **agent: Any) -> list[tuple[str, str]]:
    """The actions of the best plan with their costs."""
    result = statehtn.plan(problem, **agent)
    assert result.status is Status.OPTIMAL
    return [(str(step.step), str(step.law)) for step in result.steps]


def hours(origin: str, destination: str) -> float:
    return HOURS[origin, destination]


def test_constant(problem: Problem) -> None:
    changed = with_cost(problem, "drive", CostDistribution.of([(0.5, 2), (0.5, 4)]))
    assert costs(changed) == [("(drive home work)", "2 w.p. 0.5, 4 w.p. 0.5")]
    assert costs(problem) == [("(drive home work)", "1")]  # stays as it is


def test_state_dependent(problem: Problem) -> None:
    changed = with_cost(problem, "drive", 30, when="(icy ?b)")
    assert costs(changed) == [("(drive home hub)", "1"), ("(salt work)", "1"), ("(drive hub work)", "1")]
    assert with_cost(changed, "drive", 7, when=Atom("icy", ("?b",))) == with_cost(problem, "drive", 7, when="(icy ?b)")
    assert costs(with_cost(changed, "drive", 0.5, when="(icy ?b)")) == [("(drive home work)", "1.5")]


def test_external(problem: Problem) -> None:
    calls: list[tuple[str, str]] = []

    def traffic(origin: str, destination: str) -> CostDistribution:
        calls.append((origin, destination))
        return CostDistribution.of([(0.8, hours(origin, destination)), (0.2, 3 * hours(origin, destination))])

    changed = with_cost(problem, "drive", traffic)
    assert costs(changed) == [("(drive home work)", "2 w.p. 0.8, 6 w.p. 0.2")]
    statehtn.plan(changed, attitude="averse", alpha=1)
    assert sorted(calls) == sorted(HOURS)  # once for each, in both runs and their validations


def test_hybrid(problem: Problem) -> None:
    changed = with_cost(problem, "drive", hours)
    changed = with_cost(changed, "drive", lambda a, b: 10 * hours(a, b), when="(icy ?b)")
    assert costs(changed) == [("(drive home hub)", "1"), ("(salt work)", "1"), ("(drive hub work)", "4")]
    # Both were replaced: the callable is asked with the ground action's objects, in the states where it is due.
    assert costs(with_cost(changed, "drive", 1, when="(icy ?b)")) == [("(drive home work)", "3")]


def test_equal_callables_make_equal_problems(problem: Problem) -> None:
    assert with_cost(problem, "drive", hours) == with_cost(problem, "drive", hours)
    assert with_cost(problem, "drive", hours) != with_cost(problem, "drive", lambda a, b: hours(a, b))


def broken(_origin: str, _destination: str) -> float:
    return 1 / 0


@pytest.mark.parametrize(
    ("function", "message"),
    [
        (broken, "(drive home hub): 'broken' failed with ZeroDivisionError: division by zero"),
        (lambda a, b: {}[a, b], "the lambda function failed with KeyError: ('home', 'hub')"),
        (
            lambda *_: CostDistribution.of([(0.5, 1)]),
            "failed with the probabilities of a cost must sum to 1, found 0.5",
        ),
        (lambda *_: float("nan"), "(drive home hub) must be finite, found nan"),
        (lambda *_: float("inf"), "(drive home hub) must be finite, found inf"),
        (lambda *_: -2, "(drive home hub): a cost must not be negative, found -2"),
        (lambda *_: None, "(drive home hub) must be a number or CostDistribution, found None"),
        (lambda *_: "2", "(drive home hub) must be a number or CostDistribution, found '2'"),
        (lambda *_: [(0.5, 1), (0.5, 2)], "(drive home hub) must be a number or CostDistribution, found [(0.5, 1)"),
    ],
)
def test_wrong_answers_name_the_action_and_its_arguments(
    problem: Problem, function: Callable[..., Any], message: str
) -> None:
    changed = with_cost(problem, "drive", function)
    with pytest.raises(InputError, match=re.escape("the external cost of (drive ")) as caught:
        statehtn.plan(changed)
    # Which of the instances comes first is the grounder's choice.
    expected = re.escape(message).replace("home\\ hub", r"\w+ \w+").replace("'home',\\ 'hub'", r"'\w+', '\w+'")
    assert re.search(expected, str(caught.value))
    if function is broken:
        assert isinstance(caught.value.__cause__, ZeroDivisionError)


def test_wrong_calls(problem: Problem) -> None:
    with pytest.raises(UsageError, match="unknown action 'drvie'; did you mean 'drive'"):
        with_cost(problem, "drvie", 1)
    with pytest.raises(UsageError, match="expected a cost for action 'drive', found none"):
        with_cost(problem, "drive")
    with pytest.raises(UsageError, match=re.escape("called with its arguments (?a ?b), but the lambda function takes")):
        with_cost(problem, "drive", lambda _: 1)
    for text, message in (
        ("(icy ?c)", "the condition '(icy ?c)': unknown variable '?c'"),
        ("(rod ?a ?b)", "unknown predicate 'rod'; did you mean 'road'"),
        ("icy ?b", "expected a section in parentheses, found 'icy'"),
        ("(icy ?a) (icy ?b)", "expected one formula in parentheses"),
        ("(icy ?a", "unbalanced parentheses"),
    ):
        with pytest.raises(UsageError, match=re.escape(message)):
            with_cost(problem, "drive", 1, when=text)


def test_slow_callables_end_at_the_time_limit(problem: Problem) -> None:
    changed = with_cost(problem, "drive", lambda *_: time.sleep(0.2) or 1.0)
    assert statehtn.plan(changed, time_limit=0.1).status is Status.TIME_LIMIT


def test_callables_are_written_as_tables(problem: Problem) -> None:
    def traffic(origin: str, destination: str) -> float | CostDistribution:
        if destination == "hub":
            return hours(origin, destination)
        return CostDistribution.of([(1 / 3, hours(origin, destination)), (2 / 3, 0.1)])

    changed = with_cost(with_cost(problem, "drive", traffic), "drive", lambda *_: 5, when="(icy ?b)")
    with pytest.raises(UnsupportedError, match="statehtn.tabulate_costs"):
        statehtn.write_hddl(changed)
    tables = statehtn.tabulate_costs(changed)
    assert statehtn.tabulate_costs(problem) is problem
    again = statehtn.read_hddl_text(*statehtn.write_hddl(tables), strict=True)
    assert again == tables
    for agent in ({}, {"attitude": "averse", "alpha": 0.7}, {"attitude": "seeking", "alpha": 0.7}):
        assert costs(again, **agent) == costs(changed, **agent)
        assert statehtn.plan(again, **agent).risk_cost == pytest.approx(statehtn.plan(changed, **agent).risk_cost)
