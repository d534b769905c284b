"""The relaxed composition model of a search node: a classical problem without deletes (`buildRCModel` of Algorithm 5).

It has two kinds of operators. Those that come from actions change the state and note that their task has been reached.
Those that come from methods turn decomposition upside down: they are applicable once the method's subtasks have been
reached, and then note that the task above has been. A node's goal is that all tasks of its network have been reached.

Sources: the paper's section on state-based solving; Höller et al., "A generic method to guide HTN progression search
with classical heuristics" (ICAPS 2018).
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from statehtn.model.ground import GroundAction, GroundProblem

RelaxedFact = tuple[str, int, *tuple[int, ...]]
"""What may become true: `("holds", f)` and `("lacks", f)` for a fact f of the state, `("reached", t)` for a task t,
`("settled", a, p)` for part p of the cost of action a, and `("fails", a, p, i)` for an alternative of its condition."""


@dataclass(slots=True)
class RelaxedOperator:
    """An operator of the relaxed model.

    Args:
        name: tells it from all others.
        preconditions: what must be true.
        add_effects: what becomes true.
        action: the ground action it comes from, None for a method. A conditional effect is an operator of its own
            beside its action's, so that several operators may have the same action.
        part: the part of the action's cost that the operator settles, None where it does what the action does.
        is_due: whether it settles the part by paying for it.
        cost: positive or 0, in the domain's unit; `compute_rc_ad_heur` sets it.
    """

    name: str
    preconditions: frozenset[RelaxedFact]
    add_effects: frozenset[RelaxedFact]
    action: int | None
    part: int | None = None
    is_due: bool = False
    cost: float = 0.0


@dataclass(frozen=True, slots=True)
class RelaxedTask:
    """A classical planning task without deletes.

    Args:
        facts: everything that may be true.
        initial_state: what is true now.
        goals: what has to become true.
        operators: everything that can be done.
    """

    facts: frozenset[RelaxedFact]
    initial_state: frozenset[RelaxedFact]
    goals: frozenset[RelaxedFact]
    operators: tuple[RelaxedOperator, ...]


def build_rc_model(state: frozenset[int], network_tasks: Iterable[int], problem: GroundProblem) -> RelaxedTask:
    """Build the relaxed model of a search node; all costs are 0.

    Only what the node's network can still lead to takes part: an action that no decomposition contains cannot help.

    Args:
        state: the facts that hold.
        network_tasks: the tasks of the network; repetitions do not matter.
        problem: the ground problem.
    """
    network_tasks = frozenset(network_tasks)
    operators: list[RelaxedOperator] = []
    for task in sorted(_reachable_tasks(network_tasks, problem)):
        if problem.is_primitive(task):
            operators += _operators_of_action(task, problem.actions[task])
        else:
            operators += (_operator_of_method(method, problem) for method in problem.methods_of.get(task, ()))
    initial_state = frozenset(_holds(state)) | frozenset(_lacks(set(range(len(problem.facts))) - state))
    goals = frozenset(("reached", task) for task in network_tasks)
    facts = initial_state.union(goals, *(operator.preconditions | operator.add_effects for operator in operators))
    return RelaxedTask(facts, initial_state, goals, tuple(operators))


def _reachable_tasks(tasks: frozenset[int], problem: GroundProblem) -> set[int]:
    """Return the tasks and everything that they can be decomposed into."""
    found = set(tasks)
    pending = list(tasks)
    while pending:
        for method in problem.methods_of.get(pending.pop(), ()):
            for subtask in problem.methods[method].subtasks:
                if subtask not in found:
                    found.add(subtask)
                    pending.append(subtask)
    return found


def _operators_of_action(task: int, action: GroundAction) -> list[RelaxedOperator]:
    """Return an operator for the action with its unconditional effects, and one for each of its conditional ones.

    What the action does needs all parts of its cost settled, one after the other: each because its condition holds, at
    its price, or for free because the condition does not hold.
    """
    name = f"({' '.join((action.name, *action.arguments))}) #{task}"
    preconditions = _literals(action.precondition, action.negative_precondition)
    operators: list[RelaxedOperator] = []
    for number in range(len(action.cost_parts)):
        operators += _operators_of_part(name, preconditions, task, action, number)
        preconditions = frozenset([("settled", task, number)])
    made = [
        (
            preconditions | _literals(effect.condition, effect.negative_condition),
            frozenset((*_holds(effect.added), *_lacks(effect.deleted))),
        )
        for effect in action.effects
    ]
    always = frozenset([("reached", task)]).union(*(added for needed, added in made if needed == preconditions))
    operators.append(RelaxedOperator(name, preconditions, always, task))
    for number, (needed, added) in enumerate(made):
        if needed != preconditions:
            operators.append(RelaxedOperator(f"{name} effect {number}", needed, added, task))
    return operators


def _operators_of_part(
    name: str, preconditions: frozenset[RelaxedFact], task: int, action: GroundAction, part: int
) -> Iterator[RelaxedOperator]:
    """Yield the operators that settle a part of an action's cost."""
    settled = frozenset([("settled", task, part)])
    fails: set[RelaxedFact] = set()
    for number, (true, false) in enumerate(action.cost_parts[part].alternatives):
        due = preconditions | _literals(true, false)
        yield RelaxedOperator(f"{name} cost {part} due by {number}", due, settled, task, part, is_due=True)
        failure: RelaxedFact = ("fails", task, part, number)
        fails.add(failure)
        for literal in sorted(_literals(false, true)):
            why = f"{name} cost {part} not due by {number}: {literal}"
            yield RelaxedOperator(why, frozenset([literal]), frozenset([failure]), task, part)
    yield RelaxedOperator(f"{name} cost {part} not due", preconditions | fails, settled, task, part)


def _operator_of_method(method: int, problem: GroundProblem) -> RelaxedOperator:
    ground = problem.methods[method]
    subtasks = frozenset(("reached", subtask) for subtask in ground.subtasks)
    return RelaxedOperator(f"{ground.name} #{method}", subtasks, frozenset([("reached", ground.task)]), None)


def _literals(true: Iterable[int], false: Iterable[int]) -> frozenset[RelaxedFact]:
    return frozenset((*_holds(true), *_lacks(false)))


def _holds(facts: Iterable[int]) -> Iterable[RelaxedFact]:
    return (("holds", fact) for fact in facts)


def _lacks(facts: Iterable[int]) -> Iterable[RelaxedFact]:
    return (("lacks", fact) for fact in facts)
