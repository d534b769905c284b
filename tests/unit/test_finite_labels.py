"""Plans by objectives of several sums: prices that are far apart, none at all or infinite, and what is proven first."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path

import pytest

import statehtn
from statehtn import InputError, Status, objective
from statehtn.core.finite_prices import FinitePrices
from statehtn.core.grounding import Grounding, ground
from statehtn.core.hull import best_mean
from statehtn.core.label_run import PRECISION
from statehtn.core.label_search import search_labels
from statehtn.core.pricing import price
from statehtn.core.search import last_of
from statehtn.core.search_run import SearchOutcome
from statehtn.core.switches import LabelSwitches
from statehtn.hddl.reader import read_hddl_text
from statehtn.limits import Limits
from statehtn.risk import Attitude, Exponential, Neutral

AV = Path(__file__).parents[2] / "domains" / "av"
TEXTS = ("one-switch alpha=0.1 tradeoff=1 wealth=10", "mean-deviation 1", "exponentials linear=0 -1:1 1:1")
SEVERAL_WAYS = LabelSwitches(), LabelSwitches(one_price_first=False)


def detour(recursive: str, last: str) -> statehtn.Problem:
    """Some steps of the first cost, as many as wanted, and then one of the other."""
    domain = f"""(define (domain d) (:task t :parameters ())
      (:method again :parameters () :task (t) :ordered-subtasks (and (a) (t)))
      (:method done :parameters () :task (t) :ordered-subtasks (and (b)))
      (:action a :parameters () :precondition () :effect (and {recursive}))
      (:action b :parameters () :precondition () :effect (and {last})))"""
    return read_hddl_text(domain, "(define (problem p) (:domain d) (:htn :ordered-subtasks (and (t))) (:init))")


def found(grounding: Grounding, text: str, switches: LabelSwitches = LabelSwitches()) -> SearchOutcome:
    return last_of(search_labels(grounding, objective(text), switches=switches))


@pytest.mark.parametrize("switches", SEVERAL_WAYS)
@pytest.mark.parametrize("text", TEXTS)
@pytest.mark.parametrize(
    ("recursive", "last"),
    [
        ("(increase (total-cost) 0)", "(increase (total-cost) 0)"),
        ("(increase (total-cost) 1e-9)", "(increase (total-cost) 1e12)"),
        (
            "(increase (total-cost) 1e12)",
            "(probabilistic 0.5 (increase (total-cost) 1e-9) 0.5 (increase (total-cost) 1))",
        ),
        (
            "(increase (total-cost) 1)",
            "(probabilistic 0.5 (increase (total-cost) 1e-9) 0.5 (increase (total-cost) 1e30))",
        ),
    ],
)
def test_costs_may_be_nothing_or_far_apart(recursive: str, last: str, text: str, switches: LabelSwitches) -> None:
    grounding = ground(detour(recursive, last))
    outcome = found(grounding, text, switches)
    assert outcome.status is Status.OPTIMAL
    assert outcome.plan is not None
    assert [step.action for step in outcome.plan.steps] == ["b"]
    names = [grounding.action_text(action) for action in range(len(grounding.laws))]
    value = objective(text).value(grounding.laws[names.index("(b)")])
    assert outcome.lower_bound is not None
    assert value - outcome.lower_bound <= PRECISION * max(1.0, value)
    assert outcome.lower_bound <= value


@pytest.mark.parametrize(
    ("law", "parameters", "text"),
    [("lognorm", (1,), "one-switch alpha=0.1 tradeoff=1 wealth=10"), ("pareto", (1.5,), "mean-deviation 1")],
)
def test_a_cost_without_a_finite_price_is_named(law: str, parameters: tuple[float, ...], text: str) -> None:
    stats = pytest.importorskip("scipy.stats")
    problem = detour("(increase (total-cost) 1)", "(increase (total-cost) 1)")
    priced = statehtn.with_cost(problem, "b", getattr(stats, law)(*parameters))
    with pytest.raises(InputError, match=r"the cost of \(b\)"):
        list(search_labels(ground(priced), objective(text)))


def test_a_limit_leaves_what_is_proven() -> None:
    grounding = ground(statehtn.read_hddl(AV / "domain.hddl", AV / "p9.hddl"))
    wanted = objective("one-switch alpha=0.9 tradeoff=20 wealth=200")
    outcome = last_of(search_labels(grounding, wanted, limits=Limits(steps=300)))
    best = found(grounding, str(wanted)).lower_bound
    assert outcome.stopped is Status.TIME_LIMIT
    assert outcome.status is not Status.OPTIMAL
    assert best is not None
    assert outcome.lower_bound is None or outcome.lower_bound <= best + PRECISION * best


@pytest.mark.parametrize(("wealth", "cost"), [(10, 19.4), (24, 19.4), (40, 18.35)])
def test_one_switch_agents_on_p1(wealth: int, cost: float) -> None:
    """Poor agents take the averse plan, a rich one a plan of the neutral one's mean."""
    grounding = ground(statehtn.read_hddl(AV / "domain.hddl", AV / "p1.hddl"))
    text = f"one-switch alpha=0.9 tradeoff=20 wealth={wealth}"
    outcomes = [found(grounding, text, switches) for switches in SEVERAL_WAYS]
    for outcome in outcomes:
        assert outcome.status is Status.OPTIMAL
        assert outcome.plan is not None
        assert outcome.plan.cost_distribution().mean == pytest.approx(cost)


def test_the_best_mean_of_points() -> None:
    """Of e^x + e^y between (2, 0) and (0, 2) it is (1, 1), where there is nothing better; else it is the better end."""

    def gradient(point: Sequence[float]) -> list[float]:
        return [math.exp(number) for number in point]

    assert best_mean([(2, 0), (0, 2)], gradient) == pytest.approx([1, 1])
    assert best_mean([(2, 0), (0, 2), (0.5, 0.5)], gradient) == pytest.approx([0.5, 0.5])
    assert best_mean([(3, 3), (2, 2)], gradient) == pytest.approx([2, 2])
    assert best_mean([(1, 4)], gradient) == [1, 4]


def test_a_mix_in_units_is_a_sum_of_prices_in_units() -> None:
    """No sum of whole prices is less, times the weights, than the mix of each, and hardly more."""
    grounding = ground(statehtn.read_hddl(AV / "domain.hddl", AV / "p2.hddl"))
    problems = [price(grounding, agent) for agent in (Neutral(), Exponential(Attitude.AVERSE, 0.9))]
    prices = FinitePrices(grounding, problems)
    mix = prices.mix([0.3, 7.0])
    assert mix.weights == pytest.approx([0.3 / 7, 1], rel=1e-5)
    for row, mixed in zip(zip(*(one.actions for one in problems), strict=True), mix.problem.actions, strict=True):
        units = [scale.units([one.bound])[0] for scale, one in zip(prices.scales, row, strict=True)]
        total = math.fsum(weight * unit for weight, unit in zip(mix.core_weights, units, strict=True))
        assert mixed.cost == pytest.approx(math.fsum(w * one.cost for w, one in zip(mix.weights, row, strict=True)))
        assert math.ldexp(total, -mix.exponent) == pytest.approx(mixed.cost, rel=1e-9)
