"""Facts that are decided by chance and never seen: reading, writing and building them, and what may not read them."""

from __future__ import annotations

import pytest

import statehtn
from statehtn import InputError, ProblemBuilder, UnsupportedError, UsageError, read_hddl_text, write_hddl
from statehtn.errors import Place
from statehtn.hddl import HddlWarning

DOMAIN = """
(define (domain roads)
  (:predicates (at-home) (snow) (jam) (chained))
  (:task go :parameters ())
  (:method by-car :parameters () :task (go) :ordered-subtasks (and (drive)))
  (:method with-chains :parameters () :task (go) :ordered-subtasks (and (chain) (drive)))
  (:action chain :parameters () :effect (and (chained) (increase (total-cost) 1)))
  (:action drive :parameters ()
    :precondition (at-home)
    :effect (and (not (at-home)) (increase (total-cost) 2)
      (when (and (snow) (not (chained))) (increase (total-cost) 10))
      (when (jam) (probabilistic 0.5 (increase (total-cost) 4) 0.5 (increase (total-cost) 8))))))
"""
INIT = "(at-home) (probabilistic 0.25 (snow) 0.75 ()) (probabilistic 0.5 (jam) 0.5 (and))"


def problem_text(init: str = INIT, goal: str = "()") -> str:
    return f"(define (problem p) (:domain roads)\n(:htn :ordered-subtasks (and (go)))\n(:init {init})\n(:goal {goal}))"


def test_scenarios_are_named_by_their_facts() -> None:
    problem = read_hddl_text(DOMAIN, problem_text())
    found = {scenario.name: scenario.probability for scenario in problem.scenarios}
    assert found == {"(snow) (jam)": 0.125, "(snow)": 0.125, "(jam)": 0.375, "no hidden fact": 0.375}
    assert "scenarios 4" in repr(problem)


def test_a_plan_has_a_law_in_each_scenario_and_the_mixture() -> None:
    problem = read_hddl_text(DOMAIN, problem_text())
    result = statehtn.plan(problem)
    assert [str(step.step) for step in result.steps] == ["(chain)", "(drive)"]
    assert result.plan is not None
    assert result.risk_cost == pytest.approx(1 + 2 + 0.5 * 6)
    assert result.plan.cost_distribution_given("(jam)") == statehtn.CostDistribution.of([(0.5, 7), (0.5, 11)])
    assert result.plan.cost_distribution_given(problem.scenarios[3]).mean == 3
    assert result.plan.cost_distribution() == statehtn.CostDistribution.of([(0.5, 3), (0.25, 7), (0.25, 11)])
    with pytest.raises(UsageError, match="no scenario 'sun'"):
        result.plan.cost_distribution_given("sun")
    draws = result.plan.simulate(4000, seed=1)
    assert draws.mean() == pytest.approx(6, abs=0.2)
    assert set(draws.tolist()) == {3, 7, 11}


def test_costs_of_one_scenario_add_up() -> None:
    """Two drives in the snow: both cost more, or none does; the mixture is no convolution."""
    domain = DOMAIN.replace("(:precondition (at-home)", "").replace("(not (at-home))", "")
    text = problem_text("(at-home) (probabilistic 0.25 (snow) 0.75 ())").replace("(and (go))", "(and (drive) (drive))")
    plan = statehtn.plan(read_hddl_text(domain, text)).plan
    assert plan is not None
    assert plan.cost_distribution() == statehtn.CostDistribution.of([(0.75, 4), (0.25, 24)])


def test_what_is_written_is_read_again() -> None:
    problem = read_hddl_text(DOMAIN, problem_text())
    assert read_hddl_text(*write_hddl(problem)) == problem
    assert ProblemBuilder.of(problem).build() == problem


def test_the_rest_of_probability_is_no_fact() -> None:
    with pytest.warns(HddlWarning, match="sum to 0.25; with the rest none of its facts holds"):
        problem = read_hddl_text(DOMAIN, problem_text("(at-home) (probabilistic 0.25 (snow))"))
    assert {scenario.name: scenario.probability for scenario in problem.scenarios} == {
        "(snow)": 0.25,
        "no hidden fact": 0.75,
    }


@pytest.mark.parametrize(
    ("init", "message", "column"),
    [
        ("(probabilistic 0.8 (snow) 0.4 ())", "sum to 1.2, more than 1", 8),
        ("(probabilistic -0.1 (snow) 1.1 ())", "must not be negative, found -0.1", 23),
        ("(probabilistic 0.5 (snow) 0.5)", "pairs of a probability and facts after 'probabilistic', found 3", 8),
        ("(probabilistic p (snow))", "expected a probability, found 'p'", 23),
        ("(probabilistic 0.5 snow 0.5 ())", "expected a fact in parentheses, found 'snow'", 27),
        ("(probabilistic 0.5 (rain) 0.5 ())", "unknown predicate 'rain'", 28),
        ("(snow) (probabilistic 0.5 (snow) 0.5 ())", "stated as true and as a chance", 34),
    ],
)
def test_chances_that_make_no_sense(init: str, message: str, column: int) -> None:
    with pytest.raises(InputError, match=message) as caught:
        read_hddl_text(DOMAIN, problem_text(init))
    assert caught.value.place == Place("problem", 3, column)


@pytest.mark.parametrize(
    ("init", "message"),
    [
        ("(probabilistic 0.5 (not (snow)) 0.5 ())", "facts that are not in it are false"),
        ("(probabilistic 0.5 (probabilistic 1 (snow)) 0.5 ())", "an outcome of 'probabilistic' in ':init' is a fact"),
        (" ".join(["(probabilistic 0.5 (snow) 0.5 ())"] * 9), "makes 512 scenarios, and at most 256"),
        ("(oneof (snow) (jam))", "'oneof' is not supported in ':init'; what is uncertain has a"),
    ],
)
def test_chances_that_are_not_supported(init: str, message: str) -> None:
    with pytest.raises(UnsupportedError, match=message) as caught:
        read_hddl_text(DOMAIN, problem_text(init))
    assert caught.value.place is not None
    assert caught.value.place.file == "problem"


@pytest.mark.parametrize(
    ("old", "new", "message", "line"),
    [
        (":precondition (at-home)", ":precondition (and (at-home) (not (snow)))", "this reads a fact of 'snow'", 9),
        ("(and (not (at-home))", "(and (not (snow))", "this effect changes a fact of 'snow'", 10),
        ("(and (chained)", "(and (when (jam) (chained))", "this effect depends on a fact of 'jam'", 7),
        (":task (go) :ordered", ":task (go) :precondition (jam) :ordered", "this reads a fact of 'jam'", 5),
    ],
)
def test_only_costs_read_what_is_hidden(old: str, new: str, message: str, line: int) -> None:
    with pytest.raises(UnsupportedError, match=f"{message}; it is decided by chance") as caught:
        read_hddl_text(DOMAIN.replace(old, new, 1), problem_text())
    assert caught.value.place is not None
    assert (caught.value.place.file, caught.value.place.line) == ("domain", line)


def test_goals_do_not_read_what_is_hidden() -> None:
    with pytest.raises(UnsupportedError, match="this reads a fact of 'jam'") as caught:
        read_hddl_text(DOMAIN, problem_text(goal="(jam)"))
    assert caught.value.place == Place("problem", 4, 8)


def test_a_builder_has_chances() -> None:
    builder = ProblemBuilder("p")
    snow, jam = builder.predicate("snow"), builder.predicate("jam")
    drive = builder.action("drive", cost=[2, statehtn.when(snow(), 10), statehtn.when(~jam(), 1)])
    builder.set_network(drive())
    builder.initially_by_chance((0.3, snow()), (0.7, ()))
    builder.initially_by_chance((0.5, [jam(), snow()]), (0.5, []))
    problem = builder.build()
    assert [round(scenario.probability, 12) for scenario in problem.scenarios] == [
        0.5,
        0.15,
        0.35,
    ]  # equal facts are one scenario
    assert ProblemBuilder.of(problem).build() == problem
    assert statehtn.plan(problem).expected_cost == pytest.approx(2 + 10 * 0.65 + 0.5)
    with pytest.raises(UsageError, match="must sum to 1, found 0.9"):
        builder.initially_by_chance((0.2, snow()), (0.7, ()))
    with pytest.raises(UsageError, match="a hidden fact is an atom"):
        builder.initially_by_chance((1, "snow"))
    builder.action("shovel", precondition=snow())
    with pytest.raises(UnsupportedError, match="the precondition of action 'shovel' reads a fact of 'snow'"):
        builder.build()


def test_unified_planning_does_not_know_them() -> None:
    pytest.importorskip("unified_planning")
    with pytest.raises(UnsupportedError, match="decided by chance"):
        statehtn.to_unified_planning(read_hddl_text(DOMAIN, problem_text()))
