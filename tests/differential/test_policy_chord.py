"""Lines below the certainty equivalents of all policies: random problems against the best policies of their graphs."""

from __future__ import annotations

from fractions import Fraction
from functools import partial

from hypothesis import given
from hypothesis import strategies as st

from statehtn import Problem, Status
from statehtn.core.policy_search import search_policy
from statehtn.effort import Meter
from statehtn.limits import Limits
from statehtn.risk import Attitude, Exponential
from statehtn.session import Session
from statehtn.sweeps.minorants import minorant
from tests.brute_force import GaveUp
from tests.explicit_graph import explicit_graph
from tests.explicit_policies import best_policy
from tests.random_outcomes import chance_problems, wide_problems
from tests.shares import share_of_examples

LIMITS = Limits(steps=100_000)
NEAR = 1e-8
NOTHING = (-1e300, -1e300)
EVERYTHING = (1e300, 1e300)


@share_of_examples(1)
@given(
    problem=st.one_of(chance_problems(), wide_problems()),
    high=st.sampled_from(("0.5", "2", "10", "40")),
    low=st.sampled_from(("0", "0.1", "0.6", "0.95")),
    touching=st.sampled_from(("0.01", "0.3", "0.9", "1")),
    price=st.sampled_from((None, None, Fraction(2), Fraction(10))),
    explores_more=st.booleans(),
)
def test_no_policy_is_below_a_chord(
    problem: Problem, high: str, low: str, touching: str, price: Fraction | None, explores_more: bool
) -> None:
    """At both ends and between them; where it touches at the upper end and costs are certain, it is V there."""
    graph = explicit_graph(problem)
    top = Fraction(high)
    bottom = Fraction(low) * top
    at = bottom + Fraction(touching) * (top - bottom)
    grounding = Session(problem).ground_for_policies(LIMITS, Meter())
    failure = None if price is None else float(price)
    agent = Exponential(Attitude.AVERSE, float(1 / top))
    found = search_policy(grounding, agent, failure_cost=failure, adaptive=True, precision=1e-9, limits=LIMITS)
    if found.stopped is not None:
        raise GaveUp
    if found.explored is None:
        return
    ends = float(bottom), min(float(top), found.explored.x)
    point = min(float(at), ends[1])
    lines = partial(minorant, low=ends[0], high=ends[1], at=point)
    chord = found.explored.chord(lines, *ends, point, EVERYTHING if explores_more else NOTHING, LIMITS)
    for share in map(Fraction, ("0", "0.1", "0.5", "1")):
        x = bottom + share * (top - bottom)
        value = best_policy(graph, f"averse {1 / x}", price).value if x > 0 else None
        if chord is not None and value is not None:
            bound = chord[0] + float(share) * (chord[1] - chord[0])
            assert bound <= float(value) + NEAR * max(1, float(value))
    if touching == "1" and found.status is Status.OPTIMAL:
        assert chord is not None
        if all(law.least == law.most for law in (*grounding.laws, *grounding.part_laws)):
            assert found.upper is not None
            assert chord[1] >= found.upper - NEAR * max(1, found.upper)
