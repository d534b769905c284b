"""Policies made by hand, and random ones, for tests of what is done with them."""

from __future__ import annotations

from collections.abc import Sequence

from hypothesis import strategies as st

from statehtn.model import CostDistribution, Step
from statehtn.model.policy_graph import Branch, Decision, End, PolicyGraph, PolicyNode
from tests.strategies import between, pick

CARRY, GIVE = Step("carry", ("cup",)), Step("give", ("cup",))
TRY = Step("try", ("cup",))
HELD = ("held", "cup")


def certain(cost: float) -> CostDistribution:
    return CostDistribution.certain(cost)


def retry(probability: float = 0.5, cost: float = 1, last: float = 3) -> PolicyGraph:
    """Try to grasp a cup until it is held, then carry it."""
    again = Branch(1 - probability, certain(cost), 0)
    held = Branch(probability, certain(cost), 1, frozenset({HELD}))
    return PolicyGraph.of(
        [
            PolicyNode(
                frozenset(), (TRY, CARRY), ((0, 1),), Decision(0, TRY, (held, again) if probability else (again,))
            ),
            PolicyNode(frozenset({HELD}), (CARRY,), (), Decision(0, CARRY, (Branch(1.0, certain(last), 2),))),
            PolicyNode(frozenset({HELD}), (), (), None, End.DONE),
        ]
    )


def tries(count: int, probability: float = 0.5, cost: float = 1) -> PolicyGraph:
    """Try to grasp a cup so many times, and fail if it is not held then."""
    nodes = []
    for index in range(count):
        held = Branch(probability, certain(cost), count + 1, frozenset({HELD}))
        nodes.append(
            PolicyNode(
                frozenset(),
                (TRY,) * (count - index),
                (),
                Decision(0, TRY, (held, Branch(1 - probability, certain(cost), index + 1))),
            )
        )
    nodes.append(PolicyNode(frozenset(), (TRY,), (), None, End.FAILED))
    nodes.append(PolicyNode(frozenset({HELD}), (), (), None, End.DONE))
    return PolicyGraph.of(nodes)


def ferry_or_bridge() -> PolicyGraph:
    """Drive for 4 or 10 hours; the ferry costs 5 for certain, the bridge 2 or 9: which one depends on what is left."""
    drive, ferry, bridge = Step("drive"), Step("ferry"), Step("bridge")
    return PolicyGraph.of(
        [
            PolicyNode(
                frozenset(),
                (drive,),
                (),
                Decision(0, drive, (Branch(0.75, certain(4), 1), Branch(0.25, certain(10), 2))),
                left=15.0,
            ),
            PolicyNode(
                frozenset(),
                (bridge,),
                (),
                Decision(0, bridge, (Branch(1.0, CostDistribution.of([(0.5, 2), (0.5, 9)]), 3),)),
                left=11.0,
            ),
            PolicyNode(frozenset(), (bridge,), (), Decision(0, ferry, (Branch(1.0, certain(5), 3),)), left=5.0),
            PolicyNode(frozenset(), (), (), None, End.DONE),
        ]
    )


@st.composite
def graphs(draw: st.DrawFn, most_nodes: int = 6) -> PolicyGraph:
    """Random policies with loops, loops that cost nothing, failing, and runs without an end."""
    count = between(draw, 1, most_nodes)
    nodes: list[PolicyNode] = []
    for index in range(count):
        end = pick(draw, [None, None, End.DONE, End.FAILED, End.GIVEN_UP])
        if index == count - 1 and end is None:
            end = End.DONE
        decision = None
        if end is None:
            weights = draw(st.lists(st.integers(1, 3), min_size=1, max_size=3))
            branches = [_branch(draw, weight / sum(weights), count, place) for place, weight in enumerate(weights)]
            decision = Decision(0, Step(f"a{index}"), tuple(branches))
        nodes.append(PolicyNode(frozenset(), (), (), decision, end))
    return PolicyGraph.of(_reachable(nodes))


def _branch(draw: st.DrawFn, probability: float, count: int, place: int) -> Branch:
    costs = draw(st.lists(st.sampled_from([0, 0, 1, 2]), min_size=1, max_size=2, unique=True))
    law = CostDistribution.of([(1 / len(costs), cost) for cost in costs])
    return Branch(probability, law, between(draw, 0, count - 1), frozenset({("came", str(place))}))


def _reachable(nodes: Sequence[PolicyNode]) -> list[PolicyNode]:
    order = [0]
    for index in order:
        decision = nodes[index].decision
        order += dict.fromkeys(b.successor for b in decision.branches if b.successor not in order) if decision else ()
    new = {old: place for place, old in enumerate(order)}

    def moved(node: PolicyNode) -> PolicyNode:
        if node.decision is None:
            return node
        branches = tuple(Branch(b.probability, b.law, new[b.successor], b.added) for b in node.decision.branches)
        return PolicyNode(node.facts, node.tasks, node.order, Decision(0, node.decision.task, branches), node.end)

    return [moved(nodes[old]) for old in order]
