"""What is said of the nodes of a policy: the tasks that remain, and which method was chosen."""

from __future__ import annotations

import statehtn

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


def test_a_node_is_found_by_its_network() -> None:
    policy = statehtn.policy(statehtn.read_hddl_text(DOMAIN, PROBLEM)).policy
    assert policy is not None
    for node in policy.graph.nodes:
        assert policy.decide(node.facts, policy.network_of(node)) == (node.decision or node.end)
