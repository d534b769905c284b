"""From the steps of the reference search to a plan of the lifted problem with its decomposition."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from statehtn.model.ground import GroundProblem
from statehtn.model.plan import Decomposition, Plan, Step


@dataclass(frozen=True, slots=True)
class Execution:
    """The task of this identifier was executed as an action."""

    identifier: int
    action: int


@dataclass(frozen=True, slots=True)
class Choice:
    """The task of this identifier was decomposed by a method, whose subtasks have the identifiers from `first`."""

    identifier: int
    method: int
    first: int


def read_plan(problem: GroundProblem, executions: Sequence[Execution], choices: Sequence[Choice]) -> Plan:
    """Return the plan; what grounding has put in is left out.

    Precondition actions (of methods, and the goal) vanish. A compound task with the name of an action stands for
    the cases of that action: the case that was chosen takes its place.

    Args:
        problem: the ground problem.
        executions: all actions in the order of their execution.
        choices: all decompositions; the initial task has the identifier 0.
    """
    own = [execution for execution in executions if not problem.actions[execution.action].is_precondition]
    step_of = {execution.identifier: index for index, execution in enumerate(own)}
    choice_of = {choice.identifier: choice for choice in choices}
    action_names = {(action.name, *action.arguments) for action in problem.actions}

    def children(choice: Choice) -> tuple[int | Decomposition, ...]:
        count = len(problem.methods[choice.method].subtasks)
        read_all = (read(choice.first + index) for index in range(count))
        return tuple(child for child in read_all if child is not None)

    def read(identifier: int) -> int | Decomposition | None:
        if identifier not in choice_of:
            return step_of.get(identifier)
        choice = choice_of[identifier]
        method = problem.methods[choice.method]
        name, *arguments = problem.tasks[method.task - len(problem.actions)]
        if (name, *arguments) in action_names:
            return read(choice.first)
        return Decomposition(name, tuple(arguments), method.name, children(choice), method.arguments)

    steps = tuple(
        Step(problem.actions[execution.action].name, problem.actions[execution.action].arguments) for execution in own
    )
    root = choice_of[0]
    return Plan(steps, children(root), problem.methods[root.method].arguments)
