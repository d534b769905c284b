"""What `optimal` means: the best plan to 1e-9 of its cost, however far apart the costs of a problem are."""

from __future__ import annotations

from fractions import Fraction

import pytest
from hypothesis import given
from hypothesis import strategies as st

import statehtn
from statehtn import Problem, Result, Status
from statehtn.core.scale import Scale

SEARCHES = [{}, {"search": "anytime"}, {"solver": "plan"}, {"heuristic": "lmcut"}, {"search": "weighted", "weight": 1}]
NEUTRAL: dict[str, object] = {}
FAR = Fraction(10) ** 13  # times as much as what matters

DOMAIN = """(define (domain d) (:predicates (done ?n)) (:functions (total-cost))
  (:task t :parameters ())
  {ways})"""


def problem_of(ways: list[str], repeated: int, again: str = "") -> Problem:
    """A task, so many times in the network, with a method for each way, which is what an action costs.

    Tasks that are to be done `again` follow the last way.
    """
    texts = [
        f"(:method m{number} :parameters () :task (t) "
        f":ordered-subtasks (and (way-{number}) {again if number == len(ways) - 1 else ''}))"
        f"(:action way-{number} :parameters () :effect {way})"
        for number, way in enumerate(ways)
    ]
    network = f"(:htn :ordered-subtasks (and {'(t) ' * repeated}))"
    return statehtn.read_hddl_text(
        DOMAIN.format(ways="\n".join(texts)), f"(define (problem p) (:domain d) {network} (:init))"
    )


def certain(cost: Fraction) -> str:
    return f"(increase (total-cost) {decimal(cost)})"


def decimal(number: Fraction) -> str:
    """Write a number that is a multiple of 1e-320 out in full."""
    whole, rest = divmod(number, 1)
    return f"{whole}.{int(rest * 10**320):0320}"


def steps(result: Result) -> list[str]:
    assert result.plan is not None
    return [str(step) for step in result.plan.steps]


def check(result: Result, cost: float) -> None:
    assert result.status is Status.OPTIMAL
    assert result.risk_cost == pytest.approx(cost, rel=1e-9, abs=0.0)
    assert result.risk_cost is not None
    assert result.lower_bound is not None
    assert result.lower_bound <= cost * (1 + 1e-12)
    assert 0 <= result.risk_cost - result.lower_bound <= 1e-9 * result.risk_cost


@pytest.mark.parametrize("options", SEARCHES)
@pytest.mark.parametrize("attitude", ["neutral", "averse", "seeking"])
@pytest.mark.parametrize("scale", ["1", "1e-9", "1e-280", "1e200"])
def test_an_action_that_no_good_plan_uses(options: dict[str, object], attitude: str, scale: str) -> None:
    size = Fraction(scale)
    ways = [certain(size * Fraction("2.7")), certain(size * Fraction("2.6")), certain(size * FAR)]
    alpha = None if attitude == "neutral" else 0.3 / float(size)
    result = statehtn.plan(problem_of(ways, 4), attitude=attitude, alpha=alpha, **options)
    assert steps(result) == ["(way-1)"] * 4
    check(result, 4 * 2.6 * float(size))


@pytest.mark.parametrize("options", SEARCHES)
def test_an_outcome_that_only_an_averse_agent_fears(options: dict[str, object]) -> None:
    rare = f"(probabilistic 0.99999 (increase (total-cost) 1) 0.00001 {certain(FAR)})"
    problem = problem_of([certain(Fraction("2.7")), certain(Fraction("2.6")), rare], 3)
    result = statehtn.plan(problem, attitude="averse", alpha=0.2, **options)
    assert steps(result) == ["(way-1)"] * 3
    check(result, 3 * 2.6)
    bold = statehtn.plan(problem, attitude="seeking", alpha=0.2, **options)
    assert steps(bold) == ["(way-2)"] * 3


def test_every_plan_has_to_pay_much() -> None:
    ways = [certain(FAR + Fraction("0.03")), certain(FAR + Fraction("0.02")), certain(FAR * FAR)]
    problem = problem_of(ways, 2)
    check(statehtn.plan(problem), 2 * float(FAR))
    cheap = statehtn.with_cost(problem, "way-2", 1e-12)
    result = statehtn.plan(cheap)
    assert steps(result) == ["(way-2)"] * 2
    check(result, 2e-12)


@pytest.mark.parametrize("options", SEARCHES)
def test_costs_that_are_all_beyond_the_first_cap(options: dict[str, object]) -> None:
    """Recursion that is next to free must not become free, or the search would go down for ever."""
    ways = [certain(Fraction(10) ** power) for power in (60, 40, 80, -30)]
    result = statehtn.plan(problem_of(ways, 2, again="(t) (t)"), time_limit=30, **options)
    assert steps(result) == ["(way-1)"] * 2
    check(result, 2e40)


@pytest.mark.parametrize("distinct", ["sequence", "multiset"])
def test_the_best_plans_in_the_order_of_their_costs(distinct: str) -> None:
    ways = [certain(Fraction(cost)) for cost in ("1", "9e-9", "6e-9", "7e-9", "1e9")]
    result = statehtn.top_plans(problem_of(ways, 1), 4, distinct=distinct)
    assert result.status is Status.OPTIMAL
    assert [ranked.risk_cost for ranked in result] == [6e-9, 7e-9, 9e-9, 1.0]
    assert result.proven == 4
    assert result.lower_bound == 1.0
    few = statehtn.top_plans(problem_of(ways, 1), 2, distinct=distinct)
    assert [ranked.risk_cost for ranked in few] == [6e-9, 7e-9]
    assert few.lower_bound == pytest.approx(7e-9, rel=1e-9, abs=0.0)
    everything = statehtn.top_plans(problem_of(ways, 1), 6, distinct=distinct)
    assert everything.is_all
    assert [ranked.risk_cost for ranked in everything] == [6e-9, 7e-9, 9e-9, 1.0, 1e9]


def test_the_best_plans_beside_a_cost_that_all_have() -> None:
    """What tells the plans apart is in the thirteenth digit of their costs."""
    domain = """(define (domain d) (:types thing) (:functions (total-cost))
      (:task do :parameters (?t - thing))
      (:method slowly :parameters (?t - thing) :task (do ?t) :ordered-subtasks (slow ?t))
      (:method fast :parameters (?t - thing) :task (do ?t) :ordered-subtasks (fast ?t))
      (:action slow :parameters (?t - thing) :effect (increase (total-cost) 1.2))
      (:action fast :parameters (?t - thing) :effect (increase (total-cost) 1.9))
      (:action big :parameters () :effect (increase (total-cost) 1e11)))"""
    problem = statehtn.read_hddl_text(
        domain,
        "(define (problem p) (:domain d) (:objects a b c - thing)"
        " (:htn :ordered-subtasks (and (do a) (do b) (do c) (big))) (:init))",
    )
    best = statehtn.top_plans(problem, 3)
    slow = [[step.step.action for step in ranked.steps].count("slow") for ranked in best]
    assert slow == [3, 2, 2]


@pytest.mark.parametrize("options", [*(SEARCHES[place] for place in (0, 1, 3, 4)), {"search": "greedy"}])
def test_a_plan_that_costs_more_than_fixed_point_holds_at_first(options: dict[str, object]) -> None:
    """Costs are 2^20 apart, so that the first scale is a fine one, on which 2^13 expensive steps exceed 2^62 units."""
    doubling = "\n".join(
        f"(:task t{level} :parameters ()) (:method m{level} :parameters () :task (t{level}) "
        f":ordered-subtasks (and {f'(t{level - 1}) ' * 2 if level else '(much)'}))"
        for level in range(14)
    )
    domain = f"""(define (domain d) (:functions (total-cost)) {doubling}
      (:action much :parameters () :effect (increase (total-cost) {2**20}.5))
      (:action little :parameters () :effect (increase (total-cost) 1)))"""
    problem = statehtn.read_hddl_text(
        domain, "(define (problem p) (:domain d) (:htn :ordered-subtasks (and (little) (t13))) (:init))"
    )
    result = statehtn.plan(problem, **options)
    assert len(steps(result)) == 2**13 + 1
    assert result.risk_cost == 2**13 * (2**20 + 0.5) + 1
    assert result.lower_bound is not None
    if options != {"search": "greedy"}:
        check(result, result.risk_cost)
    if options == SEARCHES[0]:
        best = statehtn.top_plans(problem, 3)
        assert best.is_all
        assert len(best) == 1


def test_scales() -> None:
    usual = Scale.first([0.0, 3.0, 5.0, 7.0])
    assert usual.cost(1) == 2**-37
    assert usual.units([0.0, 3.0, 7.0]) == [0, 3 * 2**37, 7 * 2**37]
    wide = Scale.first([1e-12, 1e15])
    least, most = wide.units([1e-12, 1e15])
    assert (least >= 2**10, most) == (True, wide.cap + 1)
    assert wide.cost(most) < 1e15
    assert Scale.first([0.0]).units([0.0]) == [0]
    sharp = Scale.after(3.6, 3.0)
    assert 2**50 <= sharp.cap < 2**51
    assert sharp.cost(sharp.cap) <= 3.6
    assert sharp.units([3.7, 1e300]) == [sharp.cap + 1] * 2
    assert Scale.after(1e100, 2.0) == Scale.after(None, 2.0)
    assert Scale.after(5e-324, 5e-324).units([5e-324]) == [2**50]
    assert Scale.first([1e-300, 1e300]).cost(2**62) > 1e-300


PRICES = st.lists(st.floats(0.0, 1e300) | st.floats(0.0, 100.0), min_size=1, max_size=5)


@given(prices=PRICES, bound=st.floats(1e-200, 1e200), best=st.none() | st.floats(1e-200, 1e200))
def test_prices_are_rounded_down(prices: list[float], bound: float, best: float | None) -> None:
    """By less than a unit, or to one unit beyond the cap: a bound of their sums is a bound of the true costs."""
    for scale in (Scale.first(prices), Scale.after(best, bound)):
        for price, units in zip(prices, scale.units(prices), strict=True):
            exact = Fraction(price) * Fraction(2) ** scale.exponent
            assert units == min(exact // 1, scale.cap + 1)
