"""Post correspondences: two sequences of the same tiles that must spell the same word, read backward from the end.

The search puts both sequences together before it executes a letter, so only how networks end tells early that they
do not match.
"""

from __future__ import annotations

import heapq
from collections.abc import Sequence

from hypothesis import given
from hypothesis import strategies as st

from statehtn import Status, read_hddl_text, validate
from statehtn.core.grounding import ground
from statehtn.core.search import find_plans
from statehtn.core.switches import SearchSwitches
from statehtn.limits import Limits
from statehtn.model import Problem
from statehtn.risk import utility_for
from tests.differential.oracles import LIMITS, close_to, must_have_ended
from tests.shares import share_of_examples

Tiles = Sequence[tuple[str, str]]

MOST_COST = 60  # of a correspondence that the oracle looks for


def post(tiles: Tiles) -> Problem:
    """Two threads, by turns: each names its tiles, then spells their words, the latest first."""
    tokens = [f"t{index}" for index in range(len(tiles))] + ["a", "b"]
    actions = []
    for token in tokens:
        actions.append(
            f"(:action give-{token} :parameters () :precondition (first) :effect "
            f"(and (not (first)) (second) (told {token}) (increase (total-cost) 1)))"
        )
        actions.append(
            f"(:action take-{token} :parameters () :precondition (and (second) (told {token})) :effect "
            f"(and (first) (not (second)) (not (told {token})) (increase (total-cost) 1)))"
        )
    methods = []
    for side, act in enumerate(("give", "take")):
        for index, tile in enumerate(tiles):
            spelled = " ".join(f"({act}-{letter})" for letter in tile[side])
            for name, more in (("more", f"(words-{act})"), ("last", "")):
                methods.append(
                    f"(:method {name}-{act}-{index} :parameters () :task (words-{act}) "
                    f":ordered-subtasks (and ({act}-t{index}) {more} {spelled}))"
                )
    domain = f"""(define (domain post) (:types token) (:constants {" ".join(tokens)} - token)
        (:predicates (first) (second) (told ?t - token)) (:functions (total-cost) - number)
        (:task words-give :parameters ()) (:task words-take :parameters ())
        {" ".join(methods)} {" ".join(actions)})"""
    problem = """(define (problem p) (:domain post)
        (:htn :parameters () :subtasks (and (one (words-give)) (two (words-take))))
        (:init (first)) (:goal (first)))"""
    return read_hddl_text(domain, problem)


def correspondence(tiles: Tiles) -> int | None:
    """The least cost of a correspondence, up to MOST_COST: the latest tile comes first in the word."""
    queue = [(0, "", "")]  # what either side has spelled beyond the other
    done = set()
    while queue:
        cost, one, other = heapq.heappop(queue)
        if cost > 0 and one == other:
            return cost
        if (one, other) in done:
            continue
        done.add((one, other))
        for left, right in tiles:
            spelled, matched = one + left, other + right
            length = min(len(spelled), len(matched))
            more = cost + 2 + len(left) + len(right)
            if spelled[:length] == matched[:length] and more <= MOST_COST:
                heapq.heappush(queue, (more, spelled[length:], matched[length:]))
    return None


words = st.text("ab", min_size=1, max_size=3)


@share_of_examples(2)
@given(tiles=st.lists(st.tuples(words, words), min_size=1, max_size=3))
def test_correspondences(tiles: Tiles) -> None:
    problem = post(tiles)
    utility = utility_for("neutral")
    optimum = correspondence(tiles)
    for heuristic in ("auto", "tdg"):
        outcome = find_plans(ground(problem), utility, heuristic=heuristic, limits=LIMITS)
        if outcome.status is Status.UNSOLVABLE:
            assert optimum is None
        if outcome.status is Status.OPTIMAL:
            assert outcome.plan is not None
            cost = validate(problem, outcome.plan).risk_cost(utility)
            assert cost == close_to(optimum if optimum is not None else cost)
            assert optimum is not None or cost > MOST_COST
        if optimum is not None:
            assert outcome.lower_bound is not None
            assert outcome.lower_bound <= optimum + 1e-9
        must_have_ended(outcome.stopped)


def test_no_tile_begins_alike() -> None:
    """Nothing but the ends tells that there is no correspondence: the tasks recurse for ever."""
    problem = post([("aa", "b"), ("abb", "bbab"), ("ba", "aa")])
    limits = Limits.starting_now(20)
    outcome = find_plans(ground(problem), utility_for("neutral"), limits=limits)
    assert outcome.status is Status.UNSOLVABLE
    blind_to_it = find_plans(
        ground(problem), utility_for("neutral"), limits=Limits.starting_now(1), switches=SearchSwitches(endings=False)
    )
    assert blind_to_it.status is Status.TIME_LIMIT
