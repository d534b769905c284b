"""`optimal` means within 1e-9 of the optimum, in exact arithmetic, however far apart costs are; bounds are bounds."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable
from itertools import pairwise

from hypothesis import given, settings
from hypothesis import strategies as st

import statehtn
from statehtn import Problem, Result, Status, TopPlans
from statehtn.risk import Utility, utility_for
from tests.brute_force import GaveUp, best_risk_costs, optimal_risk_cost
from tests.differential.oracles import ADMISSIBLE
from tests.exact import ExactUtility
from tests.far_apart import agents, problems

SECONDS = 2.0  # in which nearly all searches end that end at all
DECIDED = 0.8  # of the examples
LEAST_EXAMPLES = 100  # of fewer, now and then too many would be undecided
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


def check(result: Result, optimum: object, search: object) -> bool:
    """Compare a result with the optimum, None for no plan; returns whether the search came to an end."""
    if optimum is None:
        assert result.plan is None
        return result.status is Status.UNSOLVABLE
    least = float(optimum)  # type: ignore[arg-type]
    assert result.status is not Status.UNSOLVABLE
    bound = result.lower_bound
    assert bound is None or bound <= least * (1 + ROUNDING)
    if result.risk_cost is None:
        return False
    assert bound is not None
    assert least * (1 - ROUNDING) <= result.risk_cost
    assert bound <= result.risk_cost
    if result.status is Status.OPTIMAL:
        assert result.risk_cost <= least * (1 + TOLERANCE)
        assert result.risk_cost - bound <= TOLERANCE * result.risk_cost
    if result.stopped is not None:
        return False
    if search == "weighted":
        assert result.risk_cost <= WEIGHT * least * (1 + TOLERANCE)
        assert result.risk_cost <= WEIGHT * bound * (1 + TOLERANCE)
    elif search != "greedy":
        assert result.status is Status.OPTIMAL
    return True


def check_top(result: TopPlans, expected: list[object]) -> bool:
    """Compare the best plans with their costs in exact arithmetic, and that of the next one if there is one."""
    best = [float(cost) for cost in expected]  # type: ignore[arg-type]
    costs = [ranked.risk_cost for ranked in result]
    assert all(cost <= after * (1 + EQUAL) for cost, after in pairwise(costs))
    for cost, least in zip(costs[: result.proven], best, strict=False):
        assert least * (1 - ROUNDING) <= cost <= least * (1 + TOLERANCE)
    if result.stopped is not None:
        return False
    assert result.proven == len(costs) == min(result.k, len(best))
    assert result.status is (Status.OPTIMAL if best else Status.UNSOLVABLE)
    if len(best) > result.k:
        assert result.lower_bound is not None
        assert costs[-1] * (1 - TOLERANCE) <= result.lower_bound <= best[result.k] * (1 + ROUNDING)
    return True


def decided(test: Callable[[Callable[[bool], None]], None]) -> None:
    """Run a property test; fail if too few of its examples say anything."""
    answers: Counter[bool] = Counter()

    def note(is_decided: bool) -> None:
        answers[is_decided] += 1

    test(note)
    print(f"{answers.total()} problems, {answers[True]} decided")
    assert answers[True] >= DECIDED * answers.total()


def optimality(note: Callable[[bool], None]) -> None:
    @settings(max_examples=max(LEAST_EXAMPLES, settings().max_examples))
    @given(problem=problems(), agent=agents(), options=st.sampled_from(SEARCHES))
    def search(problem: Problem, agent: tuple[str, float | None], options: dict[str, object]) -> None:
        utility = utility_for(*agent)
        try:
            optimum = optimal_risk_cost(problem, ExactUtility(utility), MOST_NODES)  # type: ignore[arg-type]
        except GaveUp:
            note(False)
            return
        result = plan(problem, utility, **options)
        note(check(result, optimum, options.get("search")))

    search()


def plan(problem: Problem, utility: Utility, **options: object) -> Result:
    return statehtn.plan(
        problem,
        attitude=utility.attitude,
        alpha=utility.alpha,
        time_limit=SECONDS,
        **options,  # type: ignore[arg-type]
    )


def ranking(note: Callable[[bool], None]) -> None:
    @settings(max_examples=max(LEAST_EXAMPLES, settings().max_examples))
    @given(
        problem=problems(),
        agent=agents(),
        k=st.integers(1, 4),
        distinct=st.sampled_from(("sequence", "multiset")),
        heuristic=st.sampled_from(("potential", *ADMISSIBLE)),
    )
    def search(problem: Problem, agent: tuple[str, float | None], k: int, distinct: str, heuristic: str) -> None:
        utility = utility_for(*agent)
        try:
            expected = best_risk_costs(problem, ExactUtility(utility), k + 1, distinct, MOST_NODES)  # type: ignore[arg-type]
        except GaveUp:
            note(False)
            return
        result = statehtn.top_plans(
            problem,
            k,
            attitude=utility.attitude,
            alpha=utility.alpha,
            distinct=distinct,  # type: ignore[arg-type]
            heuristic=heuristic,  # type: ignore[arg-type]
            time_limit=SECONDS,
        )
        note(check_top(result, list(expected)))

    search()


def test_optimal_is_optimal() -> None:
    decided(optimality)


def test_the_best_are_the_best() -> None:
    decided(ranking)
