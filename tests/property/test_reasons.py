"""Why there is no plan: what is said never to happen does not, and additions do what they promise."""

from __future__ import annotations

from itertools import islice
from pathlib import Path
from tempfile import TemporaryDirectory

from hypothesis import given
from hypothesis import strategies as st

from statehtn.explanation.additions import smallest_additions, with_additions
from statehtn.explanation.explanation import why_no_plan
from statehtn.explanation.reason import SEEN
from statehtn.explanation.reason_words import NO_REASON
from statehtn.explanation.reasons import Reasoner
from statehtn.explanation.relaxation import Relaxation, relaxations
from statehtn.hddl import write_hddl
from statehtn.inspection import check
from statehtn.limits import Limits
from statehtn.model import Problem
from statehtn.model.status import Status
from statehtn.risk import utility_for
from tests.brute_force import Canonical, Condition, GaveUp, Node, Space, optimal_risk_cost
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


@given(problems())
def test_what_check_says_of_a_problem_is_true(problem: Problem) -> None:
    """What can never be executed or used is not in any reachable node, and what is in no plan is not in one."""
    domain_text, problem_text = write_hddl(problem)
    with TemporaryDirectory() as folder:
        files = Path(folder) / "domain.hddl", Path(folder) / "problem.hddl"
        for file, text in zip(files, (domain_text, problem_text), strict=True):
            file.write_text(text, encoding="utf-8")
        findings = check(*files)
    never = {finding.about for finding in findings if finding.code in ("never-applies", "contradiction", "no-object")}
    unplanned = never | {finding.about for finding in findings if finding.code in ("in-no-plan", "unused-task")}
    for node in reachable(problem):
        if node.last.step is not None:
            assert ("action", node.last.step.action) not in never
        for condition in node.network:  # of a method, which can be used where it holds
            if isinstance(condition, Condition) and not condition.before:
                holds = Space(problem).semantics.holds(condition.formula, dict(condition.bindings), node.state)
                owners = {
                    name for name, method in problem.domain.methods.items() if method.precondition == condition.formula
                }
                assert not holds or len(owners) != 1 or ("method", owners.pop()) not in never
    plan = why_no_plan(problem, Limits(steps=3000)).plan
    if plan is not None:
        assert all(finding.code != "no-plan" for finding in findings)
        assert all(("action", step.action) not in unplanned for step in plan.steps)
        used = {("method", node.method) for root in plan.roots if not isinstance(root, int) for node in root.walk()}
        assert used.isdisjoint(unplanned)


@given(problems())
def test_where_nothing_goes_on(problem: Problem) -> None:
    """The steps to a deadlock can be executed, and what it lacks is so, and was changed by the step that is named."""
    exploration = why_no_plan(problem, Limits(steps=3000)).exploration
    for deadlock in exploration.deadlocks if exploration is not None else ():
        states = [problem.initial_state]
        for step in deadlock.steps:
            state = Space(problem).semantics.execute(step.action, step.arguments, states[-1])
            assert state is not None
            states.append(state)
        assert deadlock.lacks
        for lack in deadlock.lacks:
            assert (lack.fact in states[-1]) != lack.wanted
            if lack.changed_by is not None:
                assert (lack.fact in states[lack.changed_by]) != lack.wanted
                assert (lack.fact in states[lack.changed_by - 1]) == lack.wanted
