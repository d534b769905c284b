"""Why there is no plan: what is said never to happen does not, and additions do what they promise."""

from __future__ import annotations

from itertools import islice

from hypothesis import given
from hypothesis import strategies as st

from statehtn.explanation.additions import smallest_additions, with_additions
from statehtn.explanation.explanation import why_no_plan
from statehtn.explanation.reason import SEEN
from statehtn.explanation.reasons import NO_REASON, Reasoner
from statehtn.explanation.relaxation import Relaxation, relaxations
from statehtn.limits import Limits
from statehtn.model import Problem
from statehtn.model.status import Status
from statehtn.risk import utility_for
from tests.brute_force import Canonical, GaveUp, Node, Space, optimal_risk_cost
from tests.strategies import problems

NEUTRAL = utility_for("neutral", None)
MOST_NODES = 300


def reachable(problem: Problem) -> list[Node]:
    """The first nodes of the search space, breadth first."""
    space, canonical = Space(problem), Canonical()
    queue = list(islice(space.roots(), 50))
    known = {(node.state, canonical(node.network)) for node in queue}
    for node in queue:
        if len(queue) > MOST_NODES:
            break
        for _, successor in space.successors(node, None):
            key = successor.state, canonical(successor.network)
            if key not in known and len(successor.network) <= 10:
                known.add(key)
                queue.append(successor)
    return queue


def allows(level: Relaxation, node: Node) -> bool:
    """Whether the facts that hold at a node, and the step that led there, are possible on a level."""
    step = node.last.step
    return all(fact[1:] in level.true[fact[0]] for fact in node.state) and (
        step is None or step.arguments in level.able[step.action]
    )


@given(problems())
def test_what_is_never_true_or_executed_is_not(problem: Problem) -> None:
    level = relaxations(problem)[0]
    for node in reachable(problem):
        assert allows(level, node), node
        gone = problem.initial_state - node.state
        assert all(level.can_be_false(fact) for fact in gone)


def has_plan(problem: Problem) -> bool | None:
    try:
        return optimal_risk_cost(problem, NEUTRAL) is not None
    except GaveUp:
        return None


@given(problems())
def test_a_plan_is_possible_on_every_level(problem: Problem) -> None:
    levels = relaxations(problem)
    result = why_no_plan(problem, Limits(steps=3000))
    if result.plan is not None:
        assert result.status is Status.SOLVED or result.status is Status.OPTIMAL
        for level in levels:
            assert level.is_solvable
            assert all(step.arguments in level.able[step.action] for step in result.plan.steps)
    if not levels[-1].is_solvable:
        assert result.status is Status.UNSOLVABLE
        assert result.reason is not None
        assert not has_plan(problem)


@given(problems(), st.data())
def test_reasons_have_roots_and_additions_help(problem: Problem, data: st.DataObject) -> None:
    levels = relaxations(problem)
    if levels[-1].is_solvable:
        return
    root = Reasoner(levels).root()
    roots = list(root.roots())
    assert roots
    assert all(reason.why != NO_REASON for reason in root.walk())
    if len(levels) == 1:
        never = {
            addition.fact
            for reason in root.walk()
            if reason.kind == "fact" and reason.why != SEEN
            for addition in reason.additions
        }
        for node in reachable(problem):
            assert never.isdisjoint(node.state)
    for additions in smallest_additions(problem, root):
        assert relaxations(with_additions(problem, frozenset(additions)))[-1].is_solvable
        if len(additions) > 1:
            fewer = frozenset(additions) - {data.draw(st.sampled_from(additions))}
            assert not relaxations(with_additions(problem, fewer))[-1].is_solvable
