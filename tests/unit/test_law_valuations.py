"""Laws as labels: rules that are easily wrong, bounds by the graph of laws, grids that are coarse, budgets to keep."""

from __future__ import annotations

import math
from fractions import Fraction

import pytest

import statehtn._relax as _relax
from statehtn import CostDistribution, Problem, read_hddl
from statehtn.core.grounding import ground
from statehtn.core.label_search import search_labels
from statehtn.core.law_grid import Grid, LawGrid
from statehtn.core.law_labels import LawLabels
from statehtn.core.search_run import SearchOutcome
from statehtn.core.switches import LabelSwitches
from statehtn.hddl.reader import read_hddl_text
from statehtn.limits import Limits
from statehtn.model.cost.scipy_law import ScipyCost
from statehtn.model.status import Status
from statehtn.risk.deadline import Deadline
from statehtn.risk.keep import Keep
from statehtn.risk.objectives import objective
from tests.grid_laws import Law, add, shifted, summed

TWICE = """(define (domain d)
  (:task once :parameters ())
  (:task twice :parameters ())
  (:method carefully :parameters () :task (once) :ordered-subtasks (walk))
  (:method boldly :parameters () :task (once) :ordered-subtasks (run))
  (:method exactly :parameters () :task (twice) :ordered-subtasks (and (once) (once)))
  (:method more :parameters () :task (twice) :ordered-subtasks (and (once) (twice)))
  (:action walk :parameters () :effect (increase (total-cost) 2))
  (:action run :parameters ()
    :effect (probabilistic 0.5 (increase (total-cost) 1) 0.5 (increase (total-cost) 3))))"""


def test_several_laws_together_leave_nothing_out() -> None:
    """The third is below the upper envelope of the first two at every cost to come, and yet best of all.

    For each y, `P(X3 + y <= 2)` is at most that of the first or that of the second. What costs 1 or 2, half each,
    completes the third to 0.625, the others to 0.5.
    """
    kept = _relax.ExpectedDisutility(0.0, 0.0, [(2.0, 1.0, 0.0)])
    table = _relax.LawTable(kept.last, kept.is_flat_beyond)
    exact: list[Law] = [
        {1: Fraction(1)},
        {0: Fraction(1, 2), 3: Fraction(1, 2)},
        {0: Fraction(45, 100), 1: Fraction(35, 100), 3: Fraction(20, 100)},
    ]
    first, second, third = (add(table, law) for law in exact)
    to_come: Law = {1: Fraction(1, 2), 2: Fraction(1, 2)}
    late = [sum(p for cost, p in summed(law, to_come).items() if cost > 2) for law in exact]
    assert late[2] < min(late[:2])
    for more in range(4):
        alone = [sum(p for cost, p in shifted(law, more).items() if cost > 2) for law in exact]
        assert min(alone[:2]) <= alone[2]
    for one in (first, second):
        assert not _relax.is_as_good(kept, table, one, third, 0.0, _relax.LawOptions())


def test_laws_that_differ_by_rounding_are_as_good_as_each_other() -> None:
    table = _relax.LawTable()
    thirds = {0: Fraction(1, 3), 1: Fraction(1, 3), 7: Fraction(1, 3)}
    tenths = {0: Fraction(1, 10), 2: Fraction(9, 10)}
    laws = [add(table, law) for law in (thirds, tenths)] * 6
    forth = back = 0
    for law in laws:
        forth = table.sum(forth, law)
    for law in sorted(laws):
        back = table.sum(back, law)
    assert forth != back  # else this test says nothing
    for objective_ in (
        _relax.ExpectedDisutility(0.0, 0.0, [(30.0, 1.0, 0.0)]),
        _relax.QuantileOfLaw(0.9, 1.0),
        _relax.MeanCvarOfLaw(0.9, 1.0, 1.0),
    ):
        for one, other in ((forth, back), (back, forth)):
            assert _relax.is_as_good(objective_, table, one, other, 0.0, _relax.LawOptions())


@pytest.fixture(scope="module")
def vehicle() -> Problem:
    return read_hddl("domains/av/domain.hddl", "domains/av/p1.hddl")


def search(problem: Problem, text: str, keep: tuple[Keep, ...] = ()) -> SearchOutcome:
    *_, outcome = search_labels(ground(problem), objective(text), keep=keep)
    return outcome


def test_budgets_hold_at_the_very_probability(vehicle: Problem) -> None:
    """The neutral plan costs at most 23 with probability 0.9 or so; what it attains is kept, a little more is not."""
    grounding = ground(vehicle)
    labels = LawLabels(grounding, Deadline(23.0), LabelSwitches(), Limits())
    outcome = search(vehicle, "neutral")
    law = labels.law(outcome.plans.results[0])
    attained = law.cdf(23.0)
    assert 0 < attained < 1
    kept = search(vehicle, "neutral", (Keep(23.0, attained),))
    assert kept.status is Status.OPTIMAL
    assert labels.law(kept.plans.results[0]).mean == pytest.approx(law.mean)
    more = search(vehicle, "neutral", (Keep(23.0, attained + 1e-9),))
    assert more.status is Status.OPTIMAL
    assert labels.law(more.plans.results[0]).mean > law.mean


def test_budgets_that_no_plan_keeps(vehicle: Problem) -> None:
    assert search(vehicle, "neutral", (Keep(10.0, 0.5),)).status is Status.UNSOLVABLE


@pytest.mark.filterwarnings("ignore::statehtn.hddl.HddlWarning")
@pytest.mark.parametrize(
    "text", ["mean-deviation 1", "one-switch alpha=1 tradeoff=1 wealth=3", "deadline 5", "neutral"]
)
def test_budgets_where_there_is_no_plan_at_all(text: str) -> None:
    """No search with one price has found that out before: there is no task in the ground problem."""
    domain = """(define (domain d) (:predicates (p)) (:task t :parameters ())
      (:method m :parameters () :task (t) :ordered-subtasks (a)) (:action a :parameters () :precondition (p)))"""
    grounding = ground(read_hddl_text(domain, "(define (problem x) (:domain d) (:htn :subtasks (t)) (:init))"))
    assert not grounding.handle.solvable
    switches = LabelSwitches(one_price_first=False)
    *_, outcome = search_labels(grounding, objective(text), keep=(Keep(5.0, 0.5),), switches=switches)
    assert outcome.status is Status.UNSOLVABLE


@pytest.mark.parametrize(
    ("costs", "step"),
    [(("1", "2.5"), "0.5"), (("4", "6"), "2"), (("0", "0.3", "1.1"), "0.1"), (("0",), "1")],
)
def test_grids_are_exact_for_decimals(costs: tuple[str, ...], step: str) -> None:
    grid = Grid.first([CostDistribution.of([(1 / len(costs), float(cost)) for cost in costs])])
    assert grid.is_exact
    assert grid.step == Fraction(step)


def test_fine_decimals_come_later() -> None:
    law = CostDistribution.of([(0.5, 1.000001), (0.5, 99.999999)])
    grid = Grid.first([law])
    grids = [grid]
    while (finer := grids[-1].finer(100.0)) is not None:
        grids.append(finer)
    assert not grids[0].is_exact
    assert grids[-1].is_exact
    for coarse in grids:
        at, probabilities = coarse.outcomes(law)
        assert probabilities == [0.5, 0.5]
        for step, cost in zip(at, ("1.000001", "99.999999"), strict=True):
            assert coarse.step * int(step) <= Fraction(cost) < coarse.step * (int(step) + 1)


def test_continuous_laws_are_rounded_down() -> None:
    stats = pytest.importorskip("scipy.stats")
    for frozen in (stats.gamma(2, scale=3), stats.uniform(1, 4), stats.poisson(3)):
        law = CostDistribution.from_scipy(frozen)
        assert isinstance(law, ScipyCost)
        grid = Grid.first([law])
        at, probabilities = grid.outcomes(law)
        assert math.fsum(probabilities) == pytest.approx(1.0)
        below = 0.0
        for step, probability in zip(at, probabilities, strict=True):
            below += probability
            assert below >= law.cdf(float(grid.step) * step) - 1e-12
            if step < at[-1] and not law.is_discrete:
                assert below <= law.cdf(float(grid.step) * (step + 1)) + 1e-12


@pytest.mark.parametrize("cost", ["19.4", "1234.5", "0.125"])
def test_lists_of_outcomes_beside_continuous_laws_are_exact(cost: str) -> None:
    stats = pytest.importorskip("scipy.stats")
    certain = CostDistribution.certain(float(cost))
    grid = Grid.first([certain, CostDistribution.from_scipy(stats.gamma(2, scale=3))])
    assert not grid.is_exact
    finer = grid.finer(50.0)
    for one in (grid, finer) if finer else (grid,):
        ((at,), _) = one.outcomes(certain)
        assert one.step * int(at) == Fraction(cost)


def test_the_graph_of_laws_is_a_bound_that_recursion_does_not_spoil() -> None:
    """`twice` does `once` two times or more; `once` costs 1 or 3, or 2."""
    grounding = ground(read_hddl_text(TWICE, "(define (problem p) (:domain d) (:htn :subtasks (twice)))"))
    labels = LawLabels(grounding, Deadline(4.0), LabelSwitches(), Limits())
    valuation = labels.valuation
    assert isinstance(valuation, _relax.LawValuation)
    at, probabilities = valuation.law_of_task(grounding.handle.initial_task)
    below = [math.fsum(probabilities[: number + 1]) for number in range(len(at))]
    assert dict(zip(at, below, strict=True)) == pytest.approx({2: 0.25, 3: 0.75, 4: 1.0}, abs=1e-8)


CASES = """(define (domain d)
  (:predicates (icy) (careful))
  (:task go :parameters ())
  (:method well-prepared :parameters () :task (go) :ordered-subtasks (and (salt) (relax) (drive)))
  (:method at-once :parameters () :task (go) :ordered-subtasks (drive))
  (:action salt :parameters () :effect (not (icy)))
  (:action relax :parameters () :effect (not (careful)))
  (:action drive :parameters ()
    :effect (and (increase (total-cost) 10)
      (when (and (icy) (careful)) (probabilistic 0.5 (increase (total-cost) 2) 0.5 (increase (total-cost) 6)))
      (when (and (icy) (not (careful))) (probabilistic 0.75 (increase (total-cost) 4) 0.25 (increase (total-cost) 5)))
      (when (not (icy)) (increase (total-cost) 4.5))
      (when (careful) (increase (total-cost) 1)))))"""


@pytest.mark.parametrize(
    ("graph_parts", "law"),
    [(True, {13: 0.5, 14: 0.75, 14.5: 1.0}), (False, {10: 1.0})],
    ids=["with all cases", "without"],
)
def test_the_graph_of_laws_counts_what_is_due_in_some_way_or_other(graph_parts: bool, law: dict[float, float]) -> None:
    """Beside 10, `drive` costs 3 or 7, half each; 4 or 5; 4.5; or 5.5, which is more than in the case before."""
    problem = "(define (problem p) (:domain d) (:init (icy) (careful)) (:htn :subtasks (go)))"
    grounding = ground(read_hddl_text(CASES, problem))
    labels = LawLabels(grounding, Deadline(40.0), LabelSwitches(graph_parts=graph_parts), Limits())
    valuation = labels.valuation
    assert isinstance(valuation, _relax.LawValuation)
    at, probabilities = valuation.law_of_task(grounding.handle.initial_task)
    below = [math.fsum(probabilities[: number + 1]) for number in range(len(at))]
    costs = [float(labels.grid.grid.step * int(one)) for one in at]
    assert dict(zip(costs, below, strict=True)) == pytest.approx(law, abs=1e-8)


def test_means_are_prices_rounded_down(vehicle: Problem) -> None:
    grid = LawGrid.first(ground(vehicle), Limits())
    assert grid.grid.is_exact
    assert grid.units_per_step >= 2**20
