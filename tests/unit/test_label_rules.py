"""When one way makes another superfluous: for conditions of the rules, the smallest cases in which they matter."""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction

import pytest

import statehtn._relax as _relax
from statehtn import Problem, Status, read_hddl_text
from statehtn.core.grounding import ground
from statehtn.core.label_search import search_labels
from statehtn.core.labels import Support
from statehtn.core.scenario_labels import ScenarioLabels
from statehtn.core.search import last_of
from statehtn.limits import Limits
from statehtn.risk.keep import Keep
from statehtn.risk.objectives import objective
from tests.exact_disutility import ExactDisutility
from tests.grid_laws import Law, add
from tests.property.test_exponential_sums import Ways

HALF = Fraction(1, 2)
CERTAIN_5: Law = {5: Fraction(1)}
LATE_AFTER_4 = _relax.ExpectedDisutility(0.0, 0.0, [(4.0, 1.0, 0.0)])


def is_as_good(objective: _relax.LawObjective, one: Law, other: Law, least: float = 0.0) -> bool:
    table = _relax.LawTable(objective.last, objective.is_flat_beyond)
    return _relax.is_as_good(objective, table, add(table, one), add(table, other), least, _relax.LawOptions())


@pytest.mark.parametrize("lines", [((1.0, 0.0),), ((1.0, 0.0), (1.0, 0.0))], ids=["a line each", "a box"])
def test_a_lower_mean_makes_up_for_more_risk_only_while_little_is_to_come(
    lines: tuple[tuple[float, float], ...],
) -> None:
    """0 + e^2 t is below 8 + e t if t = e^k, which grows with the risk k to come, is at most 8 / (e^2 - e) = 1.7."""
    disutility = ExactDisutility(1.0, lines)
    rows = [[0, 2, *([0] * (len(lines) - 1))], [8, 1, *([0] * (len(lines) - 1))]]
    for cutoff, is_superfluous in ((None, False), (2.5, False), (2.2, True)):
        ways = Ways(disutility, rows, [0] * disutility.size)
        bold, safe = ways.labels
        if cutoff is not None:
            ways.core.set_cutoff(_relax.order_of(cutoff))
        if len(lines) == 1 or not is_superfluous:
            assert ways.core.are_as_good([bold], safe, [0] * disutility.size) == is_superfluous


def test_less_expected_excess_is_not_enough_to_be_in_time() -> None:
    assert not is_as_good(LATE_AFTER_4, CERTAIN_5, {4: HALF, 7: HALF})
    assert not is_as_good(_relax.QuantileOfLaw(0.5, 1.0), CERTAIN_5, {4: Fraction(3, 5), 10: Fraction(2, 5)})
    over = _relax.ExpectedDisutility(0.0, 0.0, [(4.0, 0.0, 1.0)])
    assert is_as_good(over, CERTAIN_5, {4: HALF, 7: HALF})


def test_the_stochastic_order_is_asked_about_every_cost_up_to_the_last() -> None:
    """The one is cheaper most often, and later than 4 more often."""
    quantile = _relax.QuantileOfLaw(0.9, 1.0)
    for late in (LATE_AFTER_4, quantile):
        assert not is_as_good(late, {0: HALF, 5: HALF}, {1: Fraction(2, 5), 2: Fraction(3, 5)})
        assert is_as_good(late, {0: HALF, 2: HALF}, {1: Fraction(2, 5), 2: Fraction(3, 5)})


BUDGET = """(define (domain d) (:functions (total-cost)) (:task go :parameters ()) (:task end :parameters ())
  (:method a :parameters () :task (go) :ordered-subtasks (and (surely)))
  (:method b :parameters () :task (go) :ordered-subtasks (and (mostly)))
  (:method c :parameters () :task (end) :ordered-subtasks (and (rest)))
  (:method d :parameters () :task (end) :ordered-subtasks (and (wait)))
  (:action wait :parameters () :effect (increase (total-cost) 6))
  (:action surely :parameters () :effect (increase (total-cost) 8))
  (:action mostly :parameters () :effect
    (probabilistic 0.9 (increase (total-cost) 7) 0.1 (increase (total-cost) 18)))
  (:action rest :parameters () :effect
    (probabilistic 0.05 (increase (total-cost) 2) 0.95 (increase (total-cost) 3))))"""


def budget_problem() -> Problem:
    return read_hddl_text(BUDGET, "(define (problem p) (:domain d) (:htn :ordered-subtasks (and (go) (end))) (:init))")


def test_a_budget_is_kept_by_the_way_that_leaves_enough_of_it() -> None:
    """8 leaves 2 for certain, which is the least that is to come, but 3 mostly is; 7 leaves 3, or nothing at all."""
    outcome = last_of(search_labels(ground(budget_problem()), objective("neutral"), keep=(Keep(10.0, 0.8),)))
    assert outcome.status is Status.OPTIMAL
    assert [step.action for step in next(iter(outcome.plans)).steps] == ["mostly", "rest"]


SNOW = """(define (domain d) (:predicates (snow)) (:functions (total-cost))
  (:task go :parameters ()) (:task end :parameters ())
  (:method a :parameters () :task (go) :ordered-subtasks (and (road)))
  (:method b :parameters () :task (go) :ordered-subtasks (and (rail)))
  (:method c :parameters () :task (end) :ordered-subtasks (and (unload)))
  (:method d :parameters () :task (end) :ordered-subtasks (and (wait)))
  (:action road :parameters () :effect (and (increase (total-cost) 3) (when (snow) (increase (total-cost) 6))))
  (:action rail :parameters () :effect (increase (total-cost) 6))
  (:action unload :parameters () :effect (increase (total-cost) 1))
  (:action wait :parameters () :effect (increase (total-cost) 6)))"""


def test_a_scenario_is_decided_where_what_is_to_come_is_over_for_certain() -> None:
    """By road it is late in the snow, by rail never: 6 and 1 are less than 8, so that the snow has not decided yet."""
    support = ScenarioLabels.support

    def nothing_known(labels: ScenarioLabels, limits: Limits, share: float = 0.25) -> Iterator[Support]:
        for _ in support(labels, limits, share):
            pass
        yield Support()

    problem = read_hddl_text(
        SNOW,
        """(define (problem p) (:domain d) (:htn :ordered-subtasks (and (go) (end)))
        (:init (probabilistic 0.5 (snow) 0.5 ())))""",
    )
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(ScenarioLabels, "support", nothing_known)
        outcome = last_of(search_labels(ground(problem), objective("deadline 8")))
    assert outcome.status is Status.OPTIMAL
    assert [step.action for step in next(iter(outcome.plans)).steps] == ["rail", "unload"]
