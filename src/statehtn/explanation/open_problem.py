"""A problem that asks for everything: what the grounder leaves of it can be done if nothing is ever deleted.

The grounder keeps what relaxed reachability reaches and the initial network leads to. Here the initial network leads to
every action and every task, any number of times, so that what is left is what is reachable at all. Observers, actions
with one fact as their precondition, tell which facts can become true, and which facts of the initial state can become
false. Of several outcomes of an action any may come.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from statehtn.model import TRUE, Action, And, Atom, Method, Not, Parameter, Problem, Signature, Subtask, TaskNetwork
from statehtn.model.formula import Formula

ANYTHING, NETWORK, GOAL = "any task", "the initial network", "the goal"
SEE, MISS, INITIALLY, UNDO = "see ", "miss ", "initially ", "undo "
"""Prefixes of names; no name that is read has a space."""


def open_problem(problem: Problem) -> Problem:
    """Return the problem that asks for everything, without costs; its own network is the task `NETWORK`."""
    domain = problem.domain
    changing = {effect.atom.predicate for action in domain.actions.values() for effect in action.all_effects}
    initially = {name: replace(domain.predicates[name], name=INITIALLY + name) for name in domain.predicates}
    observers = [action for name in changing for action in _observers(domain.predicates[name])]
    goal = Action(GOAL, (), problem.goal)
    own_actions = (part for action in domain.actions.values() for part in _without_chance(action))
    actions = {action.name: action for action in (*own_actions, *observers, goal)}
    tasks = {**domain.tasks, ANYTHING: Signature(ANYTHING), NETWORK: Signature(NETWORK)}
    own = _with_goal(problem)
    methods = {**domain.methods, NETWORK: Method(NETWORK, problem.parameters, NETWORK, (), own)}
    wanted: list[Action | Signature] = [*actions.values(), *(tasks[name] for name in (*domain.tasks, NETWORK))]
    methods.update((method.name, method) for method in _anything(wanted))
    return replace(
        problem,
        domain=replace(
            domain,
            predicates={**domain.predicates, **{sign.name: sign for sign in initially.values()}},
            actions=actions,
            tasks=tasks,
            methods=methods,
        ),
        initial_state=problem.initial_state
        | {(INITIALLY + name, *objects) for name, *objects in problem.initial_state if name in changing},
        parameters=(),
        network=TaskNetwork((Subtask("all", ANYTHING),)),
        goal=TRUE,
        chances=(),
    )


def _with_goal(problem: Problem) -> TaskNetwork:
    """Return the initial network with the goal as a last task."""
    network = problem.network
    last = len(network.subtasks)
    return replace(
        network,
        subtasks=(*network.subtasks, Subtask(GOAL, GOAL)),
        ordering=(*network.ordering, *((index, last) for index in range(last))),
    )


def _without_chance(action: Action) -> Iterator[Action]:
    """Yield an action without costs; where it has several outcomes, it adds whatever one of them adds.

    What the outcomes delete another action deletes: in one action what another outcome adds would win over it.
    """
    if not action.outcomes:
        yield replace(action, costs=())
        return
    adds = tuple(effect for effect in action.all_effects if effect.positive)
    deletes = tuple(effect for effect in action.all_effects if not effect.positive)
    yield Action(action.name, action.parameters, action.precondition, adds)
    if deletes:
        yield Action(UNDO + action.name, action.parameters, action.precondition, deletes)


def _observers(signature: Signature) -> Iterator[Action]:
    parameters = tuple(Parameter(f"?{index}") for index in range(len(signature.parameters)))
    terms = tuple(parameter.name for parameter in parameters)
    fact = Atom(signature.name, terms)
    yield Action(SEE + signature.name, parameters, fact)
    stated: Formula = And((Atom(INITIALLY + signature.name, terms), Not(fact)))
    yield Action(MISS + signature.name, parameters, stated)


def _anything(wanted: list[Action | Signature]) -> Iterator[Method]:
    """Yield the methods of the task that stands for any tasks: nothing, or one task and any tasks."""
    yield Method(f"{ANYTHING} ends", (), ANYTHING, ())
    for task in wanted:
        terms = tuple(parameter.name for parameter in task.parameters)
        network = TaskNetwork((Subtask("one", task.name, terms), Subtask("others", ANYTHING)), ((0, 1),))
        yield Method(f"any {task.name}", task.parameters, ANYTHING, (), network)
