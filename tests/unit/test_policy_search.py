"""The policy search on a small problem: failures on the grid of costs, limits, reasons, and what is refused."""

from __future__ import annotations

import pytest

import statehtn
from statehtn.core.grounding import Grounding, ground
from statehtn.core.policy_outcome import PolicyOutcome
from statehtn.core.policy_search import search_policy
from statehtn.errors import UnsupportedError, UsageError
from statehtn.limits import Limits
from statehtn.model.policy_graph import End
from statehtn.model.status import Status
from statehtn.risk.success import Success

DOMAIN = """
(define (domain retry)
 (:predicates (ok) (broken))
 (:functions (total-cost) - number)
 (:task solve :parameters ())
 (:method stop :parameters () :task (solve) :precondition (ok) :ordered-subtasks ())
 (:method go :parameters () :task (solve) :ordered-subtasks (and (try) (solve)))
 (:action try :parameters () :precondition (not (broken))
  :effect (and (increase (total-cost) 4) (probabilistic {probabilities}))))
"""
PROBLEM = "(define (problem p) (:domain retry) (:htn :ordered-subtasks (and (solve))) (:init))"
HALF = "0.5 (ok) 0.5 ()"
BREAKS = "0.5 (ok) 0.3 () 0.2 (broken)"


def grounding(probabilities: str) -> Grounding:
    return ground(statehtn.read_hddl_text(DOMAIN.format(probabilities=probabilities), PROBLEM))


def search(probabilities: str, text: str, failure_cost: float | None = None) -> PolicyOutcome:
    return search_policy(grounding(probabilities), statehtn.objective(text), failure_cost=failure_cost)


@pytest.mark.parametrize(
    ("text", "failure_cost", "value"),
    [
        ("neutral", None, 8.0),
        ("neutral", 5.0, 5.0),  # give up at once
        ("deadline 7", 2.0, 0.0),  # 4 + 2 is in time, though neither is a multiple of 4
        ("deadline 9", 10.0, 0.25),  # two tries are in time, giving up never is
        ("overrun 5", 2.0, 0.0),
        ("cvar 0.9", 6.0, 6.0),
        ("overrun 5", 2.0003, 0.0),  # a grid of 20 000 steps for a try
    ],
)
def test_values(text: str, failure_cost: float | None, value: float) -> None:
    outcome = search(HALF, text, failure_cost)
    assert outcome.status is Status.OPTIMAL
    assert outcome.lower == pytest.approx(value, abs=1e-6)
    assert outcome.upper == pytest.approx(value, abs=1e-6)


def test_success_stops_where_it_has_become_impossible() -> None:
    outcome = search_policy(grounding(BREAKS), Success())
    assert outcome.lower == pytest.approx(0.5 / 0.7, rel=1e-9)
    assert outcome.graph is not None
    assert {End.DONE} < {end for end in outcome.graph.flat.ends if end is not None}


def test_no_policy_is_done_for_certain() -> None:
    outcome = search(BREAKS, "neutral")
    assert outcome.status is Status.UNSOLVABLE
    assert outcome.most_success == pytest.approx(0.5 / 0.7, rel=1e-9)
    assert "probability 1" in (outcome.reason or "")


def test_no_amount_is_enough_for_a_quantile() -> None:
    """The largest probability of being done is 0.714, whatever is spent."""
    outcome = search(BREAKS, "quantile 0.8", float("inf"))
    assert outcome.status is Status.UNSOLVABLE
    assert outcome.most_success == pytest.approx(0.5 / 0.7, rel=1e-9)
    assert "probability 0.8" in (outcome.reason or "")
    enough = search(BREAKS, "quantile 0.7", float("inf"))
    assert (enough.status, enough.upper) == (Status.OPTIMAL, 16)  # three tries: 0.695, four: 0.7085


def test_loops_that_cost_an_averse_agent_too_much() -> None:
    outcome = search(HALF, "averse 0.2")
    assert outcome.status is Status.UNSOLVABLE
    assert outcome.most_success == 1.0
    assert "averse 0.2" in (outcome.reason or "")


def test_a_limit_leaves_bounds() -> None:
    limits = Limits(steps=3)
    outcome = search_policy(grounding(HALF), statehtn.objective("neutral"), limits=limits)
    assert outcome.stopped is Status.TIME_LIMIT
    assert outcome.graph is None
    assert outcome.status is Status.TIME_LIMIT


def test_what_is_refused() -> None:
    with pytest.raises(UnsupportedError, match="no policies"):
        search(HALF, "mean-variance 1")
    with pytest.raises(UsageError, match="infinite for deadlines"):
        search(HALF, "neutral", float("inf"))
    with pytest.raises(UsageError, match="at least 0"):
        search(HALF, "neutral", -1.0)
    with pytest.raises(UsageError, match="no cost"):
        search_policy(grounding(HALF), Success(), failure_cost=1.0)
