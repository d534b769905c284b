"""Validation of plans, and of lists of actions, whose decomposition is searched for first."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace
from functools import partial

from statehtn.expected import items
from statehtn.limits import ENDINGS, Limits, status_of, watched
from statehtn.model import And, Atom, Decomposition, Effect, Equals, Method, Plan, Problem, Signature, Step, Subtask
from statehtn.model.expect import expect_plan, expect_problem
from statehtn.model.problem import Action, Fact, TaskNetwork
from statehtn.model.status import Status
from statehtn.risk import SuccessUtility
from statehtn.semantics.chances import StepOutcome
from statehtn.validation import Validation, execute_steps
from statehtn.validation import validate as validate_plan
from statehtn.validation.trajectories import likeliest

TURN, DO = "turn {}", "do {}"
"""What a list of actions adds to a problem: facts that say whose turn it is, and an action for each place in the list.

No name that is read has a space.
"""
NOT_FOUND = "these actions can be executed, but no decomposition of the initial network has them in this order"
UNDECIDED = {
    Status.TIME_LIMIT: "the time limit was reached before a decomposition was found; there may be one",
    Status.MEMORY_LIMIT: "the memory limit was reached before a decomposition was found; there may be one",
    Status.INTERRUPTED: "interrupted before a decomposition was found; there may be one",
}


def validate(
    problem: Problem,
    plan: Plan | Iterable[str | Step],
    limits: Limits = Limits(),
    *,
    time_limit: float | None = None,
    memory_limit: float | None = None,
) -> Validation:
    """Check a plan and its decomposition against the lifted problem, and recompute its costs.

    The plan is valid if
    - every step is an instance of an action and executable in the state that the steps before it lead to, and the goal
      holds at the end;
    - the decomposition derives exactly the plan's steps from the initial network: every compound task by a method for
      it, under bindings of the right types that satisfy the method's constraints (bindings that the plan leaves open
      are solved for);
    - the order of the steps respects the ordering of every network, also across tasks that have no steps;
    - every method precondition holds in some state after everything ordered before the method's task has ended and
      before the method's first subtask starts, a parent's before its children's.

    For a list of actions a decomposition is searched for; where there is one, it is in the result's `plan`, and checked
    as that of any plan.

    Where actions have several outcomes, a plan counts on one of each. One that does not say on which, such as one from
    a file, is valid if all that holds when the right outcomes come; those of the likeliest such run are in `outcomes`,
    and how likely it is in `probability`.

    The time is linear in the length of a plan where all networks are ordered totally.

    Args:
        problem: a problem, such as `read_hddl` returns.
        plan: a plan for it, such as `statehtn.plan(problem).plan`, or `read_plan` returns; or a list of actions, such
            as `["(drive a b)", "(drive b c)"]`.
        limits: a deadline and an amount of memory; those that call this in a longer run have one.
        time_limit: seconds.
        memory_limit: resident memory of the whole process in MB (10^6 bytes).

    Raises:
        UsageError: an argument is out of its range.
        InputError: the cost of a step is not defined (a value is missing in `:init`, say), or an action is none.
        LimitReached: a limit was reached before a plan was checked; while a decomposition is searched for, it is in
            the result's `stopped`.
    """
    if time_limit is not None or memory_limit is not None:
        limits = Limits.starting_now(time_limit, memory_limit)
    return validate_run(problem, plan, limits)


def validate_run(
    problem: Problem,
    plan: Plan | Iterable[str | Step],
    limits: Limits,
    objective: SuccessUtility | None = None,
    seen: frozenset[Fact] | None = None,
) -> Validation:
    """Check a plan as `validate` does; where it does not say which outcomes it counts on, on those of the best run.

    Args:
        problem: as there.
        plan: as there.
        limits: of all that.
        objective: by which a run is the best one; None for the likeliest.
        seen: facts by which outcomes are told apart, such as those of the ground problem; None for all that are read.
    """
    expect_problem(problem)
    price = likeliest if objective is None else partial(_price_of, objective)
    if isinstance(plan, Plan) or not isinstance(plan, list | tuple):
        with watched(limits):
            return validate_plan(problem, expect_plan(plan), limits, price, seen)
    from statehtn.hddl.action_list import actions_of  # lists are rare, and the reader takes a moment to import

    with watched(limits):
        steps = actions_of(items(plan, "the actions"), problem)
        execution = execute_steps(problem, steps, limits)
    if not execution.valid:
        return execution
    try:
        found = _decomposed(problem, steps, limits, objective)
    except ENDINGS as ending:
        found = status_of(ending)
    if isinstance(found, Plan):
        with watched(limits):
            return replace(validate_plan(problem, found, limits, price, seen), plan=found)
    if found in UNDECIDED:
        return replace(execution, reasons=(UNDECIDED[found],), stopped=found)
    return replace(execution, reasons=(NOT_FOUND,))


def _price_of(objective: SuccessUtility, outcome: StepOutcome) -> float:
    return objective.risk_cost(outcome.law) + objective.outcome_price(float(outcome.probability))


def _decomposed(
    problem: Problem, steps: Sequence[Step], limits: Limits, objective: SuccessUtility | None
) -> Plan | Status:
    """Search for a decomposition that has these steps in this order; return it, or how the search ended.

    Where actions have several outcomes, it is one of the best run: what methods ask for may depend on what has come.
    """
    from statehtn.pipeline import any_plan, solve  # lists are rare, and the planner takes a moment to import
    from statehtn.session import Session
    from statehtn.settings import Settings

    following = _following(problem, steps, has_costs=objective is not None)
    if problem.domain.has_outcomes:
        result = solve(Session(following), Settings.of(objective or SuccessUtility(lambda _: 1.0)), limits)
    else:
        result = any_plan(following, limits)
    if result.plan is None:
        return result.status
    return Plan(
        tuple(steps),
        tuple(_without_turns(root) for root in result.plan.roots),
        result.plan.root_bindings,
    )


def _following(problem: Problem, steps: Sequence[Step], has_costs: bool) -> Problem:
    """Return a problem whose plans are those of the problem that consist of these steps, in this order.

    Every action becomes a compound task with a method for each place where it stands in the list; the method binds the
    parameters to the step's objects, and has one subtask, an action that does what the action does when it is its turn,
    and passes the turn on. So the plans of both correspond: the turns leave one order, in which each step occurs once,
    and an action that is not in the list has no method.
    """
    domain = problem.domain
    turns = [Atom(TURN.format(number), ()) for number in range(len(steps) + 1)]
    actions: dict[str, Action] = {}
    methods = dict(domain.methods)
    for number, step in enumerate(steps):
        action = domain.actions[step.action]
        variables = tuple(parameter.name for parameter in action.parameters)
        name = DO.format(number)
        passing = (Effect(turns[number], positive=False), Effect(turns[number + 1]))
        precondition = And((turns[number], action.precondition))
        effects, costs = (*action.effects, *passing), action.costs if has_costs else ()
        actions[name] = replace(action, name=name, precondition=precondition, effects=effects, costs=costs)
        bound = And(tuple(Equals(*pair) for pair in zip(variables, step.arguments, strict=True)))
        network = TaskNetwork((Subtask("it", name, variables),), (), bound)
        methods[name] = Method(name, action.parameters, step.action, variables, network)
    tasks = {**domain.tasks, **{name: Signature(name, action.parameters) for name, action in domain.actions.items()}}
    predicates = {**domain.predicates, **{turn.predicate: Signature(turn.predicate) for turn in turns}}
    return replace(
        problem,
        domain=replace(domain, tasks=tasks, actions=actions, methods=methods, predicates=predicates),
        initial_state=problem.initial_state | {(turns[0].predicate,)},
        goal=And((problem.goal, turns[-1])),
    )


def _without_turns(root: int | Decomposition) -> int | Decomposition:
    """Return a decomposition with the steps themselves in the place of the tasks that stand for them."""
    if isinstance(root, int):
        return root
    built: dict[int, int | Decomposition] = {}
    for node in reversed(list(root.walk())):  # children before parents
        children = tuple(child if isinstance(child, int) else built[id(child)] for child in node.children)
        is_step = node.method.startswith(DO.format(""))
        built[id(node)] = children[0] if is_step else replace(node, children=children)
    return built[id(root)]
