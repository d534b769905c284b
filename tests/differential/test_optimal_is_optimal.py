"""`optimal` means within 1e-9 of the optimum, in exact arithmetic, however far apart costs are; bounds are bounds."""

from __future__ import annotations

from itertools import pairwise

from hypothesis import given, settings
from hypothesis import strategies as st

from statehtn import Problem, Result, Status, TopPlans
from statehtn.risk import utility_for
from tests.brute_force import best_risk_costs, optimal_risk_cost
from tests.differential.oracles import ADMISSIBLE, must_have_ended, solve, solve_top
from tests.exact import ExactUtility
from tests.far_apart import agents, problems

LEAST_EXAMPLES = 100
MOST_NODES = 2000
TOLERANCE = 1e-9
ROUNDING = 1e-12
EQUAL = 1e-13  # plans whose costs have the same fourteen digits are in the order of their lengths
WEIGHT = 1.5
SEARCHES: list[dict[str, object]] = [
    *({"heuristic": heuristic} for heuristic in ("auto", *ADMISSIBLE)),
    *({"search": "anytime", "heuristic": heuristic} for heuristic in ("auto", "lmcut")),
    *({"search": "weighted", "weight": WEIGHT, "heuristic": heuristic} for heuristic in ("auto", "hmax")),
    {"search": "greedy"},
    {"solver": "plan"},
    {"solver": "plan", "branch": "all"},
]


def check(result: Result, optimum: object, search: object) -> None:
    """Compare a result with the optimum, None for no plan."""
    if optimum is None:
        assert result.plan is None
        must_have_ended(result.stopped)
        assert result.status is Status.UNSOLVABLE
        return
    least = float(optimum)
    assert result.status is not Status.UNSOLVABLE
    bound = result.lower_bound
    assert bound is None or bound <= least * (1 + ROUNDING)
    if result.risk_cost is None:
        must_have_ended(result.stopped)
    assert result.risk_cost is not None
    assert bound is not None
    assert least * (1 - ROUNDING) <= result.risk_cost
    assert bound <= result.risk_cost
    if result.status is Status.OPTIMAL:
        assert result.risk_cost <= least * (1 + TOLERANCE)
        assert result.risk_cost - bound <= TOLERANCE * result.risk_cost
    must_have_ended(result.stopped)
    if search == "weighted":
        assert result.risk_cost <= WEIGHT * least * (1 + TOLERANCE)
        assert result.risk_cost <= WEIGHT * bound * (1 + TOLERANCE)
    elif search != "greedy":
        assert result.status is Status.OPTIMAL


def check_top(result: TopPlans, expected: list[object]) -> None:
    """Compare the best plans with their costs in exact arithmetic, and that of the next one if there is one."""
    best = [float(cost) for cost in expected]
    costs = [ranked.risk_cost for ranked in result]
    assert all(cost <= after * (1 + EQUAL) for cost, after in pairwise(costs))
    for cost, least in zip(costs[: result.proven], best, strict=False):
        assert least * (1 - ROUNDING) <= cost <= least * (1 + TOLERANCE)
    must_have_ended(result.stopped)
    assert result.proven == len(costs) == min(result.k, len(best))
    assert result.status is (Status.OPTIMAL if best else Status.UNSOLVABLE)
    if len(best) > result.k:
        assert result.lower_bound is not None
        assert costs[-1] * (1 - TOLERANCE) <= result.lower_bound <= best[result.k] * (1 + ROUNDING)


def examples() -> settings:
    """More of them than the development profile has: there are many searches to choose from."""
    return settings(max_examples=max(LEAST_EXAMPLES, settings().max_examples))


@examples()
@given(problem=problems(), agent=agents(), options=st.sampled_from(SEARCHES))
def test_optimal_is_optimal(problem: Problem, agent: tuple[str, float | None], options: dict[str, object]) -> None:
    utility = utility_for(*agent)
    optimum = optimal_risk_cost(problem, ExactUtility(utility), MOST_NODES)
    check(solve(problem, utility, **options), optimum, options.get("search"))


@examples()
@given(
    problem=problems(),
    agent=agents(),
    k=st.integers(1, 4),
    distinct=st.sampled_from(("sequence", "multiset")),
    heuristic=st.sampled_from(("potential", *ADMISSIBLE)),
)
def test_the_best_are_the_best(
    problem: Problem, agent: tuple[str, float | None], k: int, distinct: str, heuristic: str
) -> None:
    utility = utility_for(*agent)
    expected = best_risk_costs(problem, ExactUtility(utility), k + 1, distinct, MOST_NODES)
    check_top(solve_top(problem, utility, k, distinct=distinct, heuristic=heuristic), list(expected))
