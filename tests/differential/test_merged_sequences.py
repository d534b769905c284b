"""Walks through a graph by recursion: many sequences of actions for one place, which are merged."""

from __future__ import annotations

import heapq
from dataclasses import dataclass

import pytest
from hypothesis import given
from hypothesis import strategies as st

from statehtn import Status, read_hddl_text, validate
from statehtn.core.grounding import ground
from statehtn.core.search import find_plans
from statehtn.core.switches import SearchSwitches
from statehtn.model import Problem
from statehtn.risk import utility_for
from tests.differential.oracles import ADMISSIBLE, LIMITS, close_to, must_have_ended

PLACES = "abcd"

DOMAIN = """
(define (domain walks)
  (:types place)
  (:predicates (at ?p - place) (road ?p ?q - place) (toll ?p ?q - place) (ticket) (seen ?p - place) (asleep))
  (:functions (total-cost) - number (length ?p ?q - place) - number)
  (:task get-to :parameters (?p - place))
  (:method there :parameters (?p - place) :task (get-to ?p) :precondition (at ?p) :subtasks ())
  (:method on :parameters (?p ?q - place) :task (get-to ?q) :ordered-subtasks (and (get-to ?p) (go ?p ?q)))
  (:method on-toll :parameters (?p ?q - place) :task (get-to ?q) :ordered-subtasks (and (get-to ?p) (pay ?p ?q)))
  (:action go :parameters (?p ?q - place) :precondition (and (at ?p) (road ?p ?q))
    :effect (and (not (at ?p)) (at ?q) (increase (total-cost) (length ?p ?q))))
  (:action pay :parameters (?p ?q - place) :precondition (and (at ?p) (toll ?p ?q) (ticket))
    :effect (and (not (at ?p)) (at ?q) (not (ticket)) (increase (total-cost) (length ?p ?q))))
  (:action look :parameters (?p - place) :precondition (at ?p) :effect (seen ?p))
  (:action rest :parameters () :precondition (not (asleep)) :effect (increase (total-cost) 1))
  (:action buy :parameters () :effect (and (ticket) (increase (total-cost) 2))))
"""
PROBLEM = """
(define (problem p) (:domain walks) (:objects {places} - place)
  (:htn :parameters () :ordered-subtasks (and {tasks}))
  (:init (at a) {init}))
"""


@dataclass(frozen=True)
class Walk:
    """A graph of roads, (from, to, toll?): length; and what to do, in order: a place to get to, or an action."""

    roads: dict[tuple[str, str, bool], int]
    tasks: list[str]

    def problem(self) -> Problem:
        init = [
            f"({'toll' if toll else 'road'} {one} {other}) (= (length {one} {other}) {length})"
            for (one, other, toll), length in self.roads.items()
        ]
        tasks = [f"(get-to {task})" if task in PLACES else f"({task})" for task in self.tasks]
        return read_hddl_text(
            DOMAIN, PROBLEM.format(places=" ".join(PLACES), tasks=" ".join(tasks), init=" ".join(init))
        )

    def optimum(self) -> int | None:
        """By Dijkstra's algorithm over place, ticket and the number of tasks done."""
        queue = [(0, "a", False, 0)]
        done = set()
        while queue:
            cost, place, ticket, index = heapq.heappop(queue)
            if index == len(self.tasks):
                return cost
            if (place, ticket, index) in done:
                continue
            done.add((place, ticket, index))
            task = self.tasks[index]
            if task == "rest":
                heapq.heappush(queue, (cost + 1, place, ticket, index + 1))
            elif task == "buy":
                heapq.heappush(queue, (cost + 2, place, True, index + 1))
            elif task.startswith("look"):
                if task == f"look {place}":
                    heapq.heappush(queue, (cost, place, ticket, index + 1))
            else:
                if task == place:
                    heapq.heappush(queue, (cost, place, ticket, index + 1))
                for (one, other, toll), length in self.roads.items():
                    if one == place and (ticket or not toll):
                        heapq.heappush(queue, (cost + length, other, ticket and not toll, index))
        return None


def walks() -> st.SearchStrategy[Walk]:
    place = st.sampled_from(PLACES)
    pairs = st.tuples(place, place).filter(lambda pair: pair[0] != pair[1])
    # A pair has one length: either a road or a toll road.
    roads = st.dictionaries(pairs, st.tuples(st.booleans(), st.integers(0, 5)), min_size=3, max_size=8)
    tasks = st.lists(
        st.one_of(place, place, st.sampled_from(["rest", "buy"]), place.map("look {}".format)), min_size=1, max_size=5
    )
    return st.builds(
        lambda roads, tasks: Walk({(*pair, toll): length for pair, (toll, length) in roads.items()}, tasks),
        roads,
        tasks,
    )


@pytest.mark.parametrize("heuristic", ["auto", *(name for name in ADMISSIBLE if name != "blind")])
@given(walk=walks())
def test_walks_are_shortest(heuristic: str, walk: Walk) -> None:
    problem = walk.problem()
    utility = utility_for("neutral")
    outcome = find_plans(ground(problem), utility, heuristic=heuristic, limits=LIMITS)
    must_have_ended(outcome.stopped)
    optimum = walk.optimum()
    if optimum is None:
        assert outcome.plan is None
    else:
        assert outcome.status is Status.OPTIMAL
        assert outcome.plan is not None
        assert validate(problem, outcome.plan).risk_cost(utility) == close_to(optimum)
        assert outcome.lower_bound == close_to(optimum)


def test_merging_leaves_one_way_for_each_place() -> None:
    both_ways = {(one, other, False): 1 for one in PLACES for other in PLACES if one != other}
    problem = Walk(both_ways, ["b", "c", "d", "a", "b", "rest", "c", "d", "a"]).problem()
    expanded = [
        find_plans(
            ground(problem),
            utility_for("neutral"),
            heuristic="tdg",
            limits=LIMITS,
            switches=SearchSwitches(merge_sequences=merge),
        ).effort.expanded
        for merge in (True, False)
    ]
    assert 3 * expanded[0] < expanded[1]
