"""What is said of the nodes of a policy: the tasks that remain, and which method was chosen."""

from __future__ import annotations

import pytest

import statehtn
from statehtn.core.switches import PolicySwitches
from statehtn.limits import Limits
from statehtn.policies.run import find_policy
from statehtn.policies.settings import PolicySettings
from statehtn.risk import Neutral
from statehtn.session import Session
from tests.benchmarks.policy_cases import consensus

DOMAIN = """(define (domain d)
  (:predicates (open) (dark) (wet) (torn))
  (:task get-in :parameters ())
  (:task light-up :parameters ())
  (:method again :parameters () :task (get-in) :precondition (and (not (open)) (not (torn)))
    :ordered-subtasks (and (push) (get-in)))
  (:method slow :parameters () :task (get-in) :precondition (and (not (open)) (not (torn)))
    :ordered-subtasks (and (pick) (get-in)))
  (:method is-in :parameters () :task (get-in) :precondition (open) :ordered-subtasks ())
  (:method with-care :parameters () :task (light-up) :precondition (or (wet) (and (dark) (not (torn))))
    :ordered-subtasks (and (light)))
  (:action push :parameters () :precondition () :effect (and (increase (total-cost) 9)
    (probabilistic 0.1 (open) 0.9 (and (wet) (torn)))))
  (:action pick :parameters () :precondition () :effect (and (increase (total-cost) 3)
    (probabilistic 0.9 (open) 0.1 ())))
  (:action light :parameters () :precondition () :effect (and (increase (total-cost) 1) (not (dark)))))"""
PROBLEM = """(define (problem p) (:domain d) (:htn :ordered-subtasks (and (get-in) (light-up)))
  (:init (dark)) (:goal (open)))"""


def test_conditions_are_named_by_what_they_ask_for() -> None:
    """Equal preconditions are one action of the ground problem, which is no reason to name it by another method."""
    policy = statehtn.policy(statehtn.read_hddl_text(DOMAIN, PROBLEM)).policy
    assert policy is not None
    assert {node.decision.method for node in policy.graph.nodes if node.decision} >= {"slow", "is-in"}
    nodes = policy.to_dict()["nodes"]
    assert {task for node in nodes for task in node["tasks"]} == {
        "(initial network)",
        "(get-in)",
        "(pick)",
        "(light)",
        "(condition (not (open)) (not (torn)))",
        "(condition (open))",  # of a method, and the goal
        "(condition (or (wet) (and (dark) (not (torn)))))",
        "(condition (dark) (not (torn)))",
    }
    chosen = next(node for node in nodes if node["decision"]["method"] == "slow")
    following = nodes[chosen["decision"]["branches"][0]["successor"]]
    assert following["tasks"][:2] == ["(condition (not (open)) (not (torn)))", "(pick)"]


def test_a_goal_of_several_cases_is_named_by_what_it_asks_for() -> None:
    problem = statehtn.read_hddl_text(DOMAIN, PROBLEM.replace("(:goal (open))", "(:goal (or (open) (not (dark))))"))
    policy = statehtn.policy(problem).policy
    assert policy is not None
    named = {task for node in policy.to_dict()["nodes"] for task in node["tasks"]}
    assert "(condition (or (open) (not (dark))))" in named


def test_a_node_is_found_by_its_network() -> None:
    policy = statehtn.policy(statehtn.read_hddl_text(DOMAIN, PROBLEM)).policy
    assert policy is not None
    for node in policy.graph.nodes:
        assert policy.decide(node.facts, policy.network_of(node)) == (node.decision or node.end)


TIRES = """(define (domain tires) (:requirements :typing :probabilistic-effects)
  (:types place) (:predicates (at ?p - place) (spare ?p - place) (road ?p ?q - place) (flat))
  (:task go :parameters (?goal - place))
  (:method arrived :parameters (?goal - place) :task (go ?goal) :precondition (at ?goal) :subtasks ())
  (:method drive :parameters (?goal ?p ?q - place) :task (go ?goal) :precondition (and (at ?p) (not (at ?goal)))
    :ordered-subtasks (and (move ?p ?q) (go ?goal)))
  (:method repair :parameters (?goal ?p - place) :task (go ?goal) :precondition (and (at ?p) (flat))
    :ordered-subtasks (and (change ?p) (go ?goal)))
  (:action move :parameters (?p ?q - place) :precondition (and (at ?p) (road ?p ?q) (not (flat)))
    :effect (and (at ?q) (not (at ?p)) (increase (total-cost) 1) (probabilistic 0.5 (flat) 0.5 ())))
  (:action change :parameters (?p - place) :precondition (and (at ?p) (spare ?p) (flat))
    :effect (and (not (spare ?p)) (not (flat)) (increase (total-cost) 1))))"""


def tires(rows: int) -> str:
    """Return a triangle of places, roads that lead on alone, and spares at its sides and inside.

    (Little and Thiebaux, Probabilistic planning vs replanning, 2007: the short way, along the bottom, has no spares.)
    """
    size = 2 * rows + 1
    places = {(row, column) for row in range(1, size + 1) for column in range(1, size + 2 - row)}
    roads = [(p, (p[0], p[1] + 1)) for p in places if p[0] % 2] + [(p, (p[0] + 1, p[1])) for p in places]
    roads += [(p, (p[0] - 1, p[1] + 1)) for p in places]
    spares = [p for p in places if p[0] % 2 == 0 or (p[0] > 1 and p[1] in {1, size + 1 - p[0]})]
    name = "l{0[0]}-{0[1]}".format
    facts = [f"(road {name(p)} {name(q)})" for p, q in sorted(roads) if q in places]
    facts += [f"(spare {name(p)})" for p in sorted(spares)]
    return f"""(define (problem p) (:domain tires) (:objects {" ".join(map(name, sorted(places)))} - place)
      (:htn :ordered-subtasks (and (go {name((1, size))}))) (:init (at l1-1) {" ".join(facts)}))"""


def test_what_is_out_of_reach_is_forgotten() -> None:
    """Spares of places that lie behind do not tell states apart: else there were 2 to the power of their number."""
    found = statehtn.policy(statehtn.read_hddl_text(TIRES, tires(5)))
    assert found.status is statehtn.Status.OPTIMAL
    assert found.value == pytest.approx(29.5)
    assert 0 < (found.statistics.expanded or 0) < 5_000
    assert found.policy is not None
    for node in found.policy.graph.nodes:
        assert found.policy.decide(node.facts, found.policy.network_of(node)) == (node.decision or node.end)


def test_where_nothing_is_forgotten_there_are_more_states() -> None:
    model = statehtn.read_hddl_text(TIRES, tires(2))
    plain = find_policy(
        Session(model), PolicySettings(Neutral(), switches=PolicySwitches(forget_unreachable=False)), Limits()
    )
    found = statehtn.policy(model)
    assert plain.value == pytest.approx(found.value)
    assert (plain.statistics.expanded or 0) > 5 * (found.statistics.expanded or 0)


def test_decisions_are_right_in_states_with_facts_that_are_forgotten() -> None:
    found = statehtn.policy(statehtn.read_hddl_text(TIRES, tires(2)))
    assert found.value == pytest.approx(11.5)
    assert str(found.validated).startswith("every decision, in")


@pytest.mark.parametrize("bound", [8, 20])
def test_decisions_are_right_where_only_some_states_were_looked_at(bound: int) -> None:
    """What was forgotten on the way to a state does not matter to it, whether it was looked at itself or not."""
    case = consensus(2, bound)
    found = statehtn.policy(statehtn.read_hddl_text(case.domain, case.problem))
    assert found.status is statehtn.Status.OPTIMAL
    assert found.value == pytest.approx(12 * bound**2)
    assert found.validated is not None
