"""The cost-variable task decomposition graphs, lifted (CV-TDG, Definition 4.5) and ground (GCV-TDG, Definition 4.6)."""

from __future__ import annotations

from collections.abc import Iterator
from enum import StrEnum
from typing import TYPE_CHECKING

from statehtn.counted import likely
from statehtn.errors import UsageError
from statehtn.hddl.writer import expression_text, formula_text
from statehtn.model.cost.blocks import CostBlock
from statehtn.model.formula import TRUE
from statehtn.model.ground import GroundCostPart, GroundMethod, GroundProblem
from statehtn.model.problem import Action, Problem, TaskNetwork

if TYPE_CHECKING:
    import networkx as nx

INITIAL = "(initial network)"


class Kind(StrEnum):
    """Kinds of nodes."""

    COMPOUND = "compound task"
    PRIMITIVE = "primitive task"
    METHOD = "method"


def task_decomposition_graph(problem: Problem) -> nx.MultiDiGraph[str]:
    """Return the graph of the domain's tasks and methods, and of the problem's initial network (Definition 4.5).

    Nodes are named `task NAME` and `method NAME`.
    """
    graph = _empty()
    domain = problem.domain
    for task in domain.tasks.values():
        variables = " ".join(parameter.name for parameter in task.parameters)
        graph.add_node(f"task {task.name}", kind=Kind.COMPOUND, label=f"{task.name} {variables}".strip())
    for action in domain.actions.values():
        variables = " ".join(parameter.name for parameter in action.parameters)
        parts = [*map(_cost_text, action.costs), *_outcome_costs(action)]
        cost = "; ".join(parts) or ("1" if domain.has_unit_costs else "0")
        label = f"{action.name} {variables}".strip()
        graph.add_node(f"task {action.name}", kind=Kind.PRIMITIVE, label=label, cost=cost)
    for method in domain.methods.values():
        _add_lifted_method(graph, method.name, method.task, method.network)
    graph.add_node("task", kind=Kind.COMPOUND, label=INITIAL)
    _add_lifted_method(graph, "", "", problem.network)
    return graph


def _cost_text(block: CostBlock) -> str:
    """Return a part of an action's cost in few words."""
    if block.external is not None:
        return "external"
    if block.law is not None:
        return str(block.law)
    outcomes = [(expression_text(probability), expression_text(cost)) for probability, cost in block.branches]
    text = ", ".join(cost if probability == "1" else f"{cost} w.p. {probability}" for probability, cost in outcomes)
    return text if block.condition == TRUE else f"{text} when {formula_text(block.condition)}"


def _outcome_costs(action: Action) -> Iterator[str]:
    """Yield what the outcomes of an action cost, in few words."""
    for block in action.outcomes:
        for outcome in block.outcomes:
            if outcome.costs:
                cost = " + ".join(map(_cost_text, block.costs_of(outcome)))
                yield f"{cost} in an outcome w.p. {expression_text(outcome.probability)}"


def _add_lifted_method(graph: nx.MultiDiGraph[str], name: str, task: str, network: TaskNetwork) -> None:
    node = f"method {name}".strip()
    graph.add_node(node, kind=Kind.METHOD, label=name or "network", ordering=network.ordering)
    graph.add_edge(f"task {task}".strip(), node)
    for position, subtask in enumerate(network.subtasks):
        graph.add_edge(node, f"task {subtask.task}", position=position)


def ground_task_decomposition_graph(problem: GroundProblem) -> nx.MultiDiGraph[str]:
    """Return the graph of the ground tasks and methods (Definition 4.6).

    An action whose precondition is a disjunction is a compound task with a method for each case, and one with several
    outcomes a compound task with a method for each of them: the graph is that of the all-outcomes determinisation.
    Method preconditions, which the ground problem has as actions without cost, are left out.

    Args:
        problem: a plain grounding, whose methods are the domain's own.

    Raises:
        UsageError: the grounding is not plain.
    """
    if not problem.is_plain:
        raise UsageError("expected a plain grounding, whose methods are the domain's: ground(problem, switches=PLAIN)")
    graph = _empty()
    for number, action in enumerate(problem.actions):
        if not action.is_precondition:
            label = " ".join((action.name, *action.arguments))
            graph.add_node(f"t{number}", kind=Kind.PRIMITIVE, label=label, law=action.cost)
            if action.cost_parts:
                cost = "; ".join((str(action.cost), *(_part_text(part, problem) for part in action.cost_parts)))
                graph.add_node(f"t{number}", cost=cost, cost_parts=action.cost_parts)
    for number, task in enumerate(problem.tasks, len(problem.actions)):
        label = INITIAL if number == problem.initial_task else " ".join(task)
        graph.add_node(f"t{number}", kind=Kind.COMPOUND, label=label)
    for number, method in enumerate(problem.methods):
        _add_ground_method(graph, problem, number, method)
    return graph


def _part_text(part: GroundCostPart, problem: GroundProblem) -> str:
    """Return a part of a ground action's cost in few words."""

    def shown(fact: int) -> str:
        return f"({' '.join(problem.facts[fact])})"

    alternatives = (
        " and ".join([*map(shown, sorted(true)), *(f"not {shown(fact)}" for fact in sorted(false))])
        for true, false in part.alternatives
    )
    return f"{part.cost} when {' or '.join(alternatives)}"


def _add_ground_method(graph: nx.MultiDiGraph[str], problem: GroundProblem, number: int, method: GroundMethod) -> None:
    real = [
        position
        for position, task in enumerate(method.subtasks)
        if not (problem.is_primitive(task) and problem.actions[task].is_precondition)
    ]
    place = {position: index for index, position in enumerate(real)}
    ordering = tuple((place[i], place[j]) for i, j in method.ordering if i in place and j in place)
    label = " ".join((method.name, *method.arguments))
    if method.task == problem.initial_task:
        label = "network"
    elif method.task in problem.chance_tasks:
        (outcome,) = method.subtasks
        label = f"outcome w.p. {likely(problem.actions[outcome].probability, digits=6)}"
    graph.add_node(f"m{number}", kind=Kind.METHOD, label=label, ordering=ordering)
    graph.add_edge(f"t{method.task}", f"m{number}")
    for position, index in place.items():
        graph.add_edge(f"m{number}", f"t{method.subtasks[position]}", position=index)


def _empty() -> nx.MultiDiGraph[str]:
    import networkx as nx

    return nx.MultiDiGraph()
