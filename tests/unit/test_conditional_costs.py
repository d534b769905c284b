"""Costs that depend on the state: parts of one ground action, each due where its condition holds."""

from __future__ import annotations

import itertools
from collections.abc import Callable

import pytest

import statehtn
from statehtn import InputError, Problem, Status
from statehtn.core.grounding import ground
from statehtn.core.heuristics import HeuristicEvaluator
from statehtn.core.search import find_plans
from statehtn.core.switches import SearchSwitches
from statehtn.hddl.reader import read_hddl_text
from statehtn.risk import utility_for


def house(heating: str, network: str, windows: int = 3, wide_open: range | None = None, **more: str) -> Problem:
    """Windows that may be open or shut, and a house to be heated, at a cost."""
    domain = f"""(define (domain house)
      (:types window)
      (:constants w0 w1 w2 - window)
      (:predicates (open ?w - window) (dirty ?w - window) (warm))
      (:task night :parameters ())
      (:task see-to :parameters (?w - window))
      (:method m-night :parameters () :task (night) :ordered-subtasks (heat))
      (:method m-leave :parameters (?w - window) :task (see-to ?w) :ordered-subtasks ())
      (:method m-shut :parameters (?w - window) :task (see-to ?w) :ordered-subtasks (shut ?w))
      (:action shut :parameters (?w - window) :precondition (open ?w)
        :effect (and (not (open ?w)) (increase (total-cost) 2)))
      (:action open-it :parameters (?w - window) :effect (and (open ?w) (dirty ?w)))
      (:action clean :parameters (?w - window) :effect (not (dirty ?w)))
      (:action heat :parameters () :effect (and {more.get("effect", "(warm)")} {heating})))"""
    names = [f"w{number}" for number in range(windows)]
    more_windows = " ".join(f"{name} - window" for name in names[3:])
    facts = " ".join(f"(open {names[number]})" for number in (range(windows) if wide_open is None else wide_open))
    return read_hddl_text(
        domain,
        f"(define (problem p) (:domain house) (:objects {more_windows}) (:htn {network}) (:init {facts}))",
    )


EACH = "(forall (?w - window) (when (open ?w) (increase (total-cost) 3)))"


@pytest.mark.parametrize("heuristic", ["lmcut", "potential", "auto"])
def test_effort_does_not_double_with_every_condition(heuristic: str) -> None:
    count = 40
    network = " ".join(f"(see-to w{number})" for number in range(count))
    problem = house(EACH, f":ordered-subtasks (and {network} (night))", count)
    grounding = ground(problem)
    assert grounding.action_count == count + 1
    outcome = find_plans(grounding, utility_for("neutral"), heuristic=heuristic)
    assert outcome.status is Status.OPTIMAL
    assert outcome.lower_bound == pytest.approx(2 * count)
    assert outcome.effort.expanded < 100 * count


CONDITIONS: dict[str, Callable[[set[int]], bool]] = {
    "(or (open w0) (open w1))": lambda opened: bool(opened & {0, 1}),
    "(and (open w0) (not (open w1)))": lambda opened: 0 in opened and 1 not in opened,
    "(exists (?w - window) (open ?w))": lambda opened: len(opened) > 0,
    "(not (forall (?w - window) (open ?w)))": lambda opened: len(opened) < 3,
    "(and (or (open w0) (open w1)) (or (open w1) (not (open w2))))": lambda opened: 1 in opened or opened == {0},
    "(or (open w0) (not (open w0)))": lambda opened: len(opened) <= 3,
    "(imply (open w0) (open w2))": lambda opened: 0 not in opened or 2 in opened,
}


@pytest.mark.parametrize("condition", CONDITIONS)
def test_a_part_is_due_once_exactly_where_its_condition_holds(condition: str) -> None:
    heating = f"(increase (total-cost) 1) (when {condition} (increase (total-cost) 10))"
    problem = house(heating, ":ordered-subtasks (and (see-to w0) (see-to w1) (see-to w2) (heat))")
    plans = statehtn.top_plans(problem, 20).plans
    expected = [
        2.0 * (3 - count) + 1 + (10 if CONDITIONS[condition](set(opened)) else 0)
        for count in range(4)
        for opened in itertools.combinations(range(3), count)
    ]
    assert [plan.risk_cost for plan in plans] == pytest.approx(sorted(expected))


def test_conditions_whose_negation_has_a_great_many_cases() -> None:
    heating = "(when (exists (?w - window) (and (open ?w) (dirty ?w))) (increase (total-cost) 50))"
    count = 30
    opened = " ".join(f"(open-it w{number})" for number in range(count))
    cleaned = " ".join(f"(clean w{number})" for number in range(1, count))
    problem = house(heating, f":ordered-subtasks (and {opened} {cleaned} (see-to w0) (night))", count)
    result = statehtn.plan(problem)
    assert (result.status, result.risk_cost) == (Status.OPTIMAL, 2)


@pytest.mark.parametrize("solver", ["state", "plan"])
def test_actions_that_change_what_another_one_pays_do_not_commute(solver: str) -> None:
    problem = house(EACH, ":subtasks (and (heat) (shut w0) (shut w2) (open-it w1))", wide_open=range(0, 3, 2))
    result = statehtn.plan(problem, solver=solver)
    assert (result.status, result.risk_cost) == (Status.OPTIMAL, 4)
    assert result.plan.steps[2].action == "heat"


@pytest.mark.parametrize("solver", ["state", "plan"])
def test_what_changes_nothing_but_costs_in_some_states_is_not_done_at_once(solver: str) -> None:
    problem = house(EACH, ":subtasks (and (heat) (shut w0) (shut w1) (shut w2))", effect="")
    result = statehtn.plan(problem, solver=solver)
    assert (result.status, result.risk_cost) == (Status.OPTIMAL, 6)


def test_states_that_differ_in_what_a_cost_depends_on_are_not_one() -> None:
    problem = house(EACH, ":ordered-subtasks (and (see-to w0) (heat) (heat))", windows=1)
    for forget_facts, merge_sequences in itertools.product((False, True), repeat=2):
        switches = SearchSwitches(forget_facts=forget_facts, merge_sequences=merge_sequences)
        outcome = find_plans(ground(problem), utility_for("neutral"), switches=switches)
        assert outcome.lower_bound == pytest.approx(2)


def test_the_lesser_cost_of_two_alternatives_is_due_in_any_case() -> None:
    heating = "(when (open w0) (increase (total-cost) 9)) (when (not (open w0)) (increase (total-cost) 4))"
    problem = house(heating, ":ordered-subtasks (and (see-to w0) (heat))", windows=1)
    grounding = ground(problem)
    state, network = grounding.handle.initial_state, [grounding.handle.initial_task]
    values = {
        name: HeuristicEvaluator(grounding, utility_for("neutral"), name)(state, network) for name in ("tdg", "lmcut")
    }
    assert values == {"tdg": pytest.approx(4), "lmcut": pytest.approx(6)}


def test_many_alternatives_are_told_apart_at_once() -> None:
    """Each window costs one thing open and another one shut, whatever the other windows are."""
    heating = f"{EACH} (forall (?w - window) (when (not (open ?w)) (increase (total-cost) 1)))"
    count = 150
    network = " ".join(f"(see-to w{number})" for number in range(count))
    problem = house(heating, f":ordered-subtasks (and {network} (night))", count)
    outcome = find_plans(ground(problem), utility_for("neutral"), heuristic="lmcut")
    assert outcome.status is Status.OPTIMAL
    assert outcome.lower_bound == pytest.approx(3 * count)
    assert outcome.effort.expanded < 5 * count


def test_blocks_on_the_same_condition_are_one_part() -> None:
    heating = f"{EACH} (forall (?w - window) (when (open ?w) (probabilistic 0.5 (increase (total-cost) 4) 0.5 ())))"
    problem = house(heating, ":ordered-subtasks (and (see-to w0) (heat))", windows=1)
    grounding = ground(problem)
    assert [law.mean for law in grounding.part_laws] == [5]
    assert statehtn.plan(problem).risk_cost == 2


def test_a_part_without_a_finite_price_is_named() -> None:
    scipy_stats = pytest.importorskip("scipy.stats")
    problem = house("(increase (total-cost) 1)", ":ordered-subtasks (and (see-to w0) (heat))", windows=1)
    heavy = statehtn.with_cost(
        problem, "heat", statehtn.CostDistribution.from_scipy(scipy_stats.lognorm(1)), when="(open w0)"
    )
    with pytest.raises(InputError, match=r"\(heat\)"):
        statehtn.plan(heavy, attitude="averse", alpha=1.0)
