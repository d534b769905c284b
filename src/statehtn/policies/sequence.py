"""A fixed sequence of actions with several outcomes: how likely it is to be done, and what it costs."""

from __future__ import annotations

from collections.abc import Iterable

from statehtn.errors import UsageError
from statehtn.expected import items, number
from statehtn.limits import Limits
from statehtn.model.expect import expect_problem
from statehtn.model.plan import Plan, Step
from statehtn.model.policy_graph import Branch, Decision, End, PolicyGraph, PolicyNode
from statehtn.model.problem import Fact, Problem
from statehtn.policies.chain import Chain
from statehtn.policies.total_cost import PolicyCost
from statehtn.semantics.actions import wrong_arguments
from statehtn.semantics.outcomes import Transitions
from statehtn.semantics.world import World

State = frozenset[Fact]


def sequence_cost(
    problem: Problem, steps: Plan | Iterable[Step | str], failure_cost: float = 0.0, time_limit: float | None = None
) -> PolicyCost:
    """Return the law of what a fixed sequence of actions costs, whatever their outcomes are.

    A step that cannot be executed in the state that has come is a failure, and so is an end in which the goal does not
    hold; whether the steps come from the initial network is not asked. Source: equation 4 of the paper, the sum over
    all trajectories. `objective.value` of it is what the sequence is worth. The best sequence is not searched for: that
    is conformant planning, which is undecidable for HTN problems in general; policies look at what comes.

    Args:
        problem: the problem, in which actions may have several outcomes.
        steps: the actions, such as `["(suck ball)", "(place ball)"]` or `Step("suck", ("ball",))`; or a plan.
        failure_cost: what failing costs on top of what was spent, at least 0; may be infinite.
        time_limit: seconds.

    Raises:
        UsageError: these are no steps of the problem, or the failure cost is negative.
        InputError: a text is no action; a cost or a probability is not defined.
        LimitReached: the time is over.
    """
    from statehtn.hddl.action_list import actions_of  # the reader takes a moment to import

    expect_problem(problem)
    wanted = actions_of(steps.steps if isinstance(steps, Plan) else items(steps, "the steps"), problem)
    price = number(failure_cost, "the failure cost")
    if not price >= 0:
        raise UsageError(f"the failure cost must be at least 0, found {price:g}")
    limits = Limits.starting_now(time_limit)
    world = World(problem, limits)
    for step in wanted:
        action = problem.domain.actions.get(step.action)
        wrong = wrong_arguments(action.parameters, step.arguments, world) if action is not None else "no such action"
        if wrong is not None:
            raise UsageError(f"step {step}: {wrong}")
    return PolicyCost(Chain(_graph(problem, list(wanted), Transitions(world), limits).flat), price)


def _graph(problem: Problem, steps: list[Step], transitions: Transitions, limits: Limits) -> PolicyGraph:
    """Return the states that may come, step by step, as a policy that looks at nothing."""
    keys: dict[tuple[int, State], int] = {(0, problem.initial_state): 0}
    order = [(0, problem.initial_state)]
    nodes: list[PolicyNode] = []
    for place, facts in order:
        limits.check()
        if place == len(steps):
            end = End.DONE if transitions.is_goal(facts) else End.FAILED
            nodes.append(PolicyNode(facts, (), (), None, end))
            continue
        outcomes = transitions.outcomes(steps[place], facts)
        if outcomes is None:
            nodes.append(PolicyNode(facts, (steps[place],), (), None, End.FAILED))
            continue
        branches: list[Branch] = []
        for outcome in outcomes:
            key = place + 1, outcome.after(facts)
            if key not in keys:
                keys[key] = len(order)
                order.append(key)
            branches.append(Branch(float(outcome.probability), outcome.law, keys[key], outcome.added, outcome.deleted))
        nodes.append(PolicyNode(facts, (steps[place],), (), Decision(0, steps[place], tuple(branches))))
    return PolicyGraph.of(nodes)
