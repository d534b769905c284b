"""What policies are worth: known answers, and random ones against sums over all their runs."""

from __future__ import annotations

import math
from collections import defaultdict

import pytest
from hypothesis import given, settings

import statehtn
from statehtn.errors import InputError
from statehtn.model import CostDistribution, Step
from statehtn.model.cost.infinite import InfiniteMean
from statehtn.model.policy_graph import Branch, Decision, End, PolicyGraph, PolicyNode
from statehtn.policies.policy import Policy
from statehtn.risk import objective
from statehtn.risk.success import Success
from tests.made_policies import ferry_or_bridge, graphs, retry, tries

STEPS = 400
"""After so many decisions next to nothing of a random policy's runs goes on but those without an end."""


def policy(graph: PolicyGraph, wanted: str = "neutral", failure_cost: float | None = None) -> Policy:
    by = Success() if wanted == "success" else objective(wanted)
    return Policy(None, graph, by, failure_cost)


def test_retry() -> None:
    assert policy(retry()).value == pytest.approx(5, rel=1e-12)
    assert policy(retry()).success_probability == 1
    averse = policy(retry(), "averse 0.3").value
    e = math.exp(0.3)
    assert averse == pytest.approx(3 + math.log(0.5 * e / (1 - 0.5 * e)) / 0.3, rel=1e-12)
    seeking = policy(retry(), "seeking 0.3").value
    assert seeking == pytest.approx(3 - math.log(0.5 / e / (1 - 0.5 / e)) / 0.3, rel=1e-12)
    with pytest.raises(InfiniteMean):
        _ = policy(retry(), "averse 0.7").value
    with pytest.raises(InfiniteMean):  # the radius is 1 exactly
        _ = policy(retry(), f"averse {math.log(2)}").value


@pytest.mark.parametrize("count", range(1, 21))
def test_tries(count: int) -> None:
    assert policy(tries(count), "success").value == pytest.approx(1 - 0.5**count, rel=1e-12)
    spent = sum(0.5**k for k in range(count))
    assert policy(tries(count)).expected_cost == pytest.approx(spent, rel=1e-12)
    assert policy(tries(count), failure_cost=100).value == pytest.approx(spent + 100 * 0.5**count, rel=1e-12)
    late = policy(tries(count), "deadline 3", failure_cost=math.inf)
    assert late.value == pytest.approx(0.5 ** min(count, 3), rel=1e-12)


@pytest.mark.parametrize("count", [3, 60, 500])
def test_a_probability_of_1_is_certain(count: int) -> None:
    """So many tries all fail with 1/2 to that power, which is lost beside 1."""
    several = policy(tries(count))
    assert several.failure_probability == 0.5**count
    assert several.success_probability < 1
    assert several.success_probability == pytest.approx(1 - 0.5**count, rel=1e-15)
    assert (policy(retry()).failure_probability, policy(retry()).success_probability) == (0, 1)


def test_failing_costs_what_was_spent_and_the_failure_cost() -> None:
    law = policy(tries(3), failure_cost=10).cost_distribution()
    assert law.outcomes == ((0.5, 1), (0.25, 2), (0.125, 3), (0.125, 13))
    assert law.failed == 0.125
    assert law.given_failed is not None
    assert law.given_failed.outcomes == ((1, 3),)
    assert (law.quantile(0.875), law.quantile(0.876), law.most, law.cvar(0.875)) == (3, 13, 13, 13)
    assert "failed w.p. 0.125" in str(law)


def test_failing_that_costs_infinitely_much() -> None:
    law = policy(tries(3), "quantile 0.8", failure_cost=math.inf).cost_distribution()
    assert (law.quantile(0.8), law.quantile(0.9), law.mean, law.exceedance(2)) == (3, math.inf, math.inf, 0.25)
    assert law.cvar(0.5) == math.inf
    with pytest.raises(InputError, match="infinitely much"):
        law.expectation(lambda cost: cost)


def test_what_is_left_decides() -> None:
    assert policy(ferry_or_bridge(), "deadline 15").value == 0
    assert policy(ferry_or_bridge()).value == pytest.approx(0.75 * (4 + 5.5) + 0.25 * 15)


@settings(deadline=None)
@given(graphs())
def test_values_are_sums_over_all_runs(graph: PolicyGraph) -> None:
    """Runs are followed decision by decision, whatever they cost; those that go on after that never end."""
    done, failed, left = _followed(graph)
    law = policy(graph).cost_distribution()
    assert math.isclose(policy(graph).success_probability, math.fsum(done.values()), abs_tol=1e-9 + left)
    assert math.isclose(law.failed, 1 - math.fsum(done.values()), abs_tol=1e-9 + left)
    if left > 1e-13:
        return  # no sum over all runs: some never end, or not yet
    for failure in (0.0, 5.0):
        costs = dict(done)
        for cost, p in failed.items():
            costs[cost + failure] = costs.get(cost + failure, 0.0) + p
        priced = policy(graph, failure_cost=failure)
        assert math.isclose(priced.value, math.fsum(p * c for c, p in costs.items()), rel_tol=1e-9, abs_tol=1e-9)
        law = priced.cost_distribution()
        assert math.isclose(law.least, law.outcomes[0][1], abs_tol=1e-9)
        most = math.inf if law.infinite or law.totals.cut else law.outcomes[-1][1]
        assert law.most == most or math.isclose(law.most, most, rel_tol=1e-9)
        for budget in range(8):
            late = math.fsum(p for cost, p in costs.items() if cost > budget)
            assert math.isclose(law.exceedance(budget), late, abs_tol=1e-9)
        for slope in (-0.4, 0.01):
            expected = math.log(math.fsum(p * math.exp(slope * cost) for cost, p in costs.items())) / slope
            assert math.isclose(law.exponential_mean(slope), expected, rel_tol=1e-6, abs_tol=1e-6)


def test_runs_without_an_end() -> None:
    """A loop without a way out is a failed run; it costs infinitely much if each round costs something."""
    never = retry(probability=0)
    assert policy(never, "success").value == 0
    assert policy(retry(probability=0)).expected_cost == math.inf
    assert policy(retry(probability=0, cost=0)).expected_cost == 0
    assert policy(retry(probability=0, cost=0), failure_cost=7).expected_cost == 7
    free = policy(retry(probability=0, cost=0), failure_cost=7).cost_distribution()
    assert (free.outcomes, free.least, free.most) == (((1, 7),), 7, 7)
    paid = policy(never).cost_distribution()
    assert (paid.least, paid.most) == (math.inf, math.inf)


def chain_of(*rows: tuple[tuple[float, float, int], ...]) -> PolicyGraph:
    """A policy whose nodes have branches (probability, cost, successor)."""
    nodes = []
    for index, row in enumerate(rows):
        branches = (Branch(p, CostDistribution.certain(cost), to) for p, cost, to in row)
        nodes.append(PolicyNode(frozenset(), (), (), Decision(0, Step(f"a{index}"), tuple(branches))))
    return PolicyGraph.of(nodes)


@pytest.mark.parametrize("before", [((0.5, 0, 0), (0.5, 0, 1)), ((1.0, 0, 1),)], ids=["loop", "step"])
def test_what_leads_to_runs_without_an_end(before: tuple[tuple[float, float, int], ...]) -> None:
    """A loop that is left is no failed run yet, though what it leads to never ends."""
    paid = policy(chain_of(before, ((1.0, 1, 1),)), failure_cost=7).cost_distribution()
    assert paid.infinite == 1
    assert paid.mean == math.inf
    assert [paid.chain.exponential_mean(slope, 7) for slope in (0.3, -0.3)] == [math.inf, math.inf]
    free = policy(chain_of(before, ((1.0, 0, 1),)), failure_cost=7).cost_distribution()
    assert free.mean == 7
    assert free.exponential_mean(0.3) == pytest.approx(7, rel=1e-12)
    assert free.exponential_mean(-0.3) == pytest.approx(7, rel=1e-12)


def test_a_loop_that_costs_something_before_runs_fail() -> None:
    law = policy(chain_of(((0.5, 1, 0), (0.5, 1, 1)), ((1.0, 0, 1),)), failure_cost=7).cost_distribution()
    assert law.mean == pytest.approx(9, rel=1e-12)
    e = math.exp(0.3)
    assert law.exponential_mean(0.3) == pytest.approx(7 + math.log(0.5 * e / (1 - 0.5 * e)) / 0.3, rel=1e-12)
    assert law.failed == 1


@settings(deadline=None)
@given(graphs())
def test_means_are_infinite_where_runs_may_pay_for_ever(graph: PolicyGraph) -> None:
    law = policy(graph, failure_cost=5.0).cost_distribution()
    if law.infinite > 0:
        assert law.mean == math.inf
    elif law.totals.cut < 1e-12:
        assert math.isclose(law.mean, math.fsum(p * cost for p, cost in law.outcomes), rel_tol=1e-9, abs_tol=1e-9)


def _followed(graph: PolicyGraph) -> tuple[dict[float, float], dict[float, float], float]:
    """Return the probability of each cost among runs that are done and that fail, and of those that go on."""
    flat = graph.flat
    done: dict[float, float] = defaultdict(float)
    failed: dict[float, float] = defaultdict(float)
    masses: dict[tuple[int, float], float] = {(0, 0.0): 1.0}
    for _ in range(STEPS):
        after: dict[tuple[int, float], float] = defaultdict(float)
        for (node, spent), mass in masses.items():
            if flat.ends[node] is not None:
                (done if flat.ends[node] is End.DONE else failed)[spent] += mass
                continue
            for branch in flat.branches(node):
                law = flat.laws[branch]
                assert isinstance(law, CostDistribution)
                for p, cost in law.outcomes:
                    after[flat.successors[branch], spent + cost] += mass * flat.probabilities[branch] * p
        masses = {key: mass for key, mass in after.items() if mass > 1e-14}
    return done, failed, math.fsum(masses.values())


def test_steep_exponentials_of_a_loop_are_infinite_where_numbers_differ_by_orders_of_magnitude() -> None:
    """A negative number of a solution looked like a rounding error beside the largest one, and the mean finite."""
    text = """(define (domain d) (:predicates (p) (q))
      (:task t :parameters ())
      (:method done :parameters () :task (t) :precondition (not (p)) :subtasks ())
      (:method again :parameters () :task (t) :ordered-subtasks (and (a) (t)))
      (:action a :parameters () :effect (and (increase (total-cost) 1)
        (probabilistic 0.5 (and (p) (probabilistic 0.4 (increase (total-cost) 2) 0.6 (increase (total-cost) 4))) 0.5 ())
        (probabilistic 0.6 (and (q) (probabilistic 0.1 (increase (total-cost) 1) 0.9 (increase (total-cost) 0)))
          0.4 (not (p))))))"""
    problem = statehtn.read_hddl_text(
        text, "(define (problem p) (:domain d) (:htn :ordered-subtasks (and (a) (a) (t))) (:init (p)))"
    )
    found = statehtn.policy(problem, objective="evar 0.9")
    assert found.policy is not None
    law = found.policy.cost_distribution()
    for slope in (0.1, 1, 5, 10, 15.6, 22.5, 25.5, 28.8, 46.9, 53.0, 110.4, 1000):
        with pytest.raises(InfiniteMean):
            law.exponential_mean(slope)
    assert found.value == pytest.approx(70.6, abs=0.1)
    assert found.value == pytest.approx(law.evar(0.9))
