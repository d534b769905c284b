"""Policies checked against the lifted problem, by code that shares nothing with the search.

Two things are checked. Of every decision, in every state in which a run may take it: that the action can be executed
there, and that its branches are what may come of it, with their probabilities and costs. And of runs that together take
every branch: that their actions come from a decomposition of the initial network.
"""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Sequence
from dataclasses import dataclass

from statehtn.counted import counted
from statehtn.errors import InternalError
from statehtn.limits import Limits
from statehtn.model.cost.law import CostLaw
from statehtn.model.cost.mixture import mixture_of
from statehtn.model.policy_graph import Branch, Decision, End
from statehtn.model.problem import Fact
from statehtn.policies.policy import Policy
from statehtn.policies.trajectory import Trajectory
from statehtn.semantics.chances import StepOutcome
from statehtn.semantics.outcomes import Transitions
from statehtn.semantics.world import World
from statehtn.validation.validation import validate_trajectory

MOST_STATES = 2_000
"""In which decisions are checked: a second or two."""
MOST_RUNS = 50
"""Whose decompositions are checked."""
MOST_FACTS = 2_000_000
"""Of the states in which decisions are checked together, and of those of the runs: what large states would take."""
TOLERANCE = 1e-9
UNITS = 256  # states between two looks at the limits

State = frozenset[Fact]


@dataclass(frozen=True, slots=True)
class Checked:
    """How far a policy was checked.

    Args:
        states: in which decisions were.
        is_all: whether these are all states in which runs may take them.
        runs: whose decompositions were.
        covers: whether these runs take every branch that may lead to being done.
    """

    states: int
    is_all: bool
    runs: int
    covers: bool

    def __str__(self) -> str:
        states = counted(self.states, "state")
        runs = counted(self.runs, "run")
        every = f"every decision, in {states}" if self.is_all else f"decisions in {states}, not in all of them"
        covering = f"the decompositions of {runs}" + (" that take every branch" if self.covers else "")
        return f"{every}; {covering}"


def check_policy(policy: Policy, seen: State, limits: Limits = Limits()) -> Checked:
    """Check a policy.

    Args:
        policy: what a search has found.
        seen: the facts of the ground problem, by which it tells outcomes apart.
        limits: they hold.

    Raises:
        InternalError: it is wrong.
        LimitReached: a limit was reached before it was checked.
    """
    states, is_all = _check_decisions(policy, seen, limits)
    runs, covers = _check_runs(policy, seen, limits)
    return Checked(states, is_all, runs, covers)


def _check_decisions(policy: Policy, seen: State, limits: Limits) -> tuple[int, bool]:
    """Check decisions in the states in which they may be taken; return in how many, and whether these are all."""
    transitions = Transitions(World(policy.problem, limits), seen)
    start = 0, policy.problem.initial_state
    known, pending, count, looked = {start}, deque([start]), 0, 0
    while pending and count < MOST_STATES and looked < MOST_FACTS:
        if count % UNITS == 0:
            limits.check()
        index, facts = pending.popleft()
        count += 1
        looked += len(facts)
        for follower in _followers(policy, index, facts, transitions, seen):
            if follower not in known:
                known.add(follower)
                pending.append(follower)
    return count, not pending


def _followers(
    policy: Policy, index: int, facts: State, transitions: Transitions, seen: State
) -> list[tuple[int, State]]:
    """Check what a node says in a state, and return the nodes and states that may follow."""
    node = policy.graph.nodes[index]
    decision = node.decision
    if decision is None:
        if node.end is End.DONE and (node.tasks or not transitions.is_goal(facts)):
            raise _wrong("a run counts as done with tasks left, or without the goal")
        return []
    if decision.action is None:
        if len(decision.branches) != 1:
            raise _wrong("a decomposition has several outcomes")
        return [(decision.branches[0].successor, facts)]
    outcomes = transitions.outcomes(decision.action, facts)
    if outcomes is None:
        raise _wrong(f"{decision.action}: {transitions.why_not(decision.action, facts)}")
    followers: list[tuple[int, State]] = []
    for group, branches in _matched(policy, decision, outcomes, facts, seen):
        if not group:
            raise _wrong(f"{decision.action} has an outcome that cannot come")
        weights, laws = [float(outcome.probability) for outcome in group], [outcome.law for outcome in group]
        _check_branches(decision, branches, math.fsum(weights), mixture_of(weights, laws))
        after = [outcome.after(facts) for outcome in group]
        followers += [(branch.successor, state) for branch in branches for state in after]
        if not all(any(_shows(branch, state) for state in after) for branch in branches):
            raise _wrong(f"{decision.action} has an outcome that cannot come")
    return followers


def _matched(
    policy: Policy, decision: Decision, outcomes: Sequence[StepOutcome], facts: State, seen: State
) -> list[tuple[list[StepOutcome], list[Branch]]]:
    """Return which outcomes are which branches: those that agree in all facts that matter after them.

    Outcomes may differ in facts that no longer matter, and be one branch; with an amount spent, one outcome may be
    several branches. Which facts matter may depend on the outcome: of branches whose facts it has, an outcome is the
    one of which the most is known, since fewer facts matter where less is within reach.
    """
    nodes = policy.graph.nodes
    by_facts: dict[tuple[State, State], tuple[list[StepOutcome], list[Branch]]] = {}
    for branch in decision.branches:
        node = nodes[branch.successor]
        known = seen if node.known is None else node.known
        by_facts.setdefault((known, node.facts & known), ([], []))[1].append(branch)
    for outcome in outcomes:
        after = outcome.after(facts)
        fitting = [(len(known), pair) for (known, expected), pair in by_facts.items() if after & known == expected]
        most = max((count for count, _ in fitting), default=0)
        best = [pair for count, pair in fitting if count == most]
        if len(best) != 1:
            raise _wrong(f"{decision.action} has {len(best) or 'no'} branches for one of its outcomes")
        best[0][0].append(outcome)
    return list(by_facts.values())


def _shows(branch: Branch, after: State) -> bool:
    """Tell whether the changes that a branch tells of are there in a state."""
    return branch.added <= after and branch.deleted.isdisjoint(after)


def _check_branches(decision: Decision, branches: Sequence[Branch], probability: float, law: CostLaw) -> None:
    """Check the branches of one outcome: there may be one for each cost that it has."""
    found = math.fsum(branch.probability for branch in branches)
    if not math.isclose(found, probability, rel_tol=TOLERANCE, abs_tol=TOLERANCE):
        raise _wrong(f"{decision.action} has an outcome of probability {probability:g}, and of {found:g} in the policy")
    mixture = mixture_of([branch.probability for branch in branches], [branch.law for branch in branches])
    for one, other in ((mixture.mean, law.mean), (mixture.least, law.least), (mixture.most, law.most)):
        if not math.isclose(one, other, rel_tol=TOLERANCE, abs_tol=TOLERANCE):
            raise _wrong(f"{decision.action} costs {law}, which is {mixture} in the policy")


def _check_runs(policy: Policy, seen: State, limits: Limits) -> tuple[int, bool]:
    """Check the decompositions of runs that take every branch that may lead to being done; return how many."""
    flat = policy.graph.flat
    transitions = Transitions(World(policy.problem, limits), seen)
    there, onwards = _ways_there(policy), _ways_on(policy)
    taken = bytearray(len(flat.successors))
    runs = looked = 0
    for node in range(len(flat)):
        for branch in flat.branches(node):
            if taken[branch] or flat.successors[branch] not in onwards:
                continue
            if runs == MOST_RUNS or looked > MOST_FACTS:
                return runs, False
            path = [*_path_to(node, there), branch]
            at = flat.successors[branch]
            while (step := onwards[at]) is not None:
                path.append(step)
                at = flat.successors[step]
            for passed in path:
                taken[passed] = True
            _check_run(policy, path, transitions, seen, limits)
            runs += 1
            looked += len(path) * len(policy.problem.initial_state)
    return runs, True


def _check_run(policy: Policy, path: Sequence[int], transitions: Transitions, seen: State, limits: Limits) -> None:
    """Check the decomposition of a run in which the likeliest outcomes come that these branches stand for."""
    flat = policy.graph.flat
    facts, node, came = policy.problem.initial_state, 0, list[tuple[State, State]]()
    for index in path:
        decision = policy.graph.nodes[node].decision
        assert decision is not None
        branch = decision.branches[index - flat.first[node]]
        if decision.action is not None:
            outcomes = transitions.outcomes(decision.action, facts)
            if outcomes is None:
                raise _wrong(f"{decision.action}: {transitions.why_not(decision.action, facts)}")
            matched = _matched(policy, decision, outcomes, facts, seen)
            fitting = next(group for group, branches in matched if branch in branches)
            outcome = max(fitting, key=lambda one: one.probability)
            came.append((outcome.added, outcome.deleted))
            facts = outcome.after(facts)
        node = branch.successor
    trajectory = Trajectory(policy.graph, tuple(path), tuple(flat.laws[branch].mean for branch in path))
    validation = validate_trajectory(policy.problem, policy.plan(trajectory), came, seen, limits)
    if not validation.valid:
        raise _wrong("; ".join(validation.reasons))


def _ways_there(policy: Policy) -> dict[int, tuple[int, int]]:
    """Return for each node but the first the node and the branch by which a shortest way from the beginning comes."""
    flat, found, queue = policy.graph.flat, dict[int, tuple[int, int]](), deque([0])
    while queue:
        node = queue.popleft()
        for branch in flat.branches(node):
            other = flat.successors[branch]
            if other and other not in found:
                found[other] = node, branch
                queue.append(other)
    return found


def _ways_on(policy: Policy) -> dict[int, int | None]:
    """Return for each node from which a run may be done the branch of a shortest way there; None where it is done."""
    flat = policy.graph.flat
    # Chains of the branches that lead to the same node, since lists of them would take much memory.
    owner = [node for node in range(len(flat)) for _ in flat.branches(node)]
    first, following = [-1] * len(flat), [-1] * len(owner)
    for branch in reversed(range(len(owner))):
        following[branch], first[flat.successors[branch]] = first[flat.successors[branch]], branch
    found: dict[int, int | None] = {node: None for node, end in enumerate(flat.ends) if end is End.DONE}
    queue = deque(found)
    while queue:
        branch = first[queue.popleft()]
        while branch >= 0:
            node = owner[branch]
            if node not in found:
                found[node] = branch
                queue.append(node)
            branch = following[branch]
    return found


def _path_to(node: int, there: dict[int, tuple[int, int]]) -> list[int]:
    path: list[int] = []
    while node:
        node, branch = there[node]
        path.append(branch)
    return path[::-1]


def _wrong(reason: str) -> InternalError:
    return InternalError(f"the search returned a wrong policy: {reason}")
