"""The relaxed model as a graph, for looking at."""

from __future__ import annotations

from typing import TYPE_CHECKING

from statehtn.model import CostLaw
from statehtn.model.ground import GroundAction, GroundProblem
from statehtn.reference.relaxed_model import RelaxedFact, RelaxedOperator, RelaxedTask

if TYPE_CHECKING:
    import networkx as nx


def relaxed_model_graph(task: RelaxedTask, problem: GroundProblem) -> nx.MultiDiGraph[str]:
    """Return the graph of a relaxed model: facts point to the operators that need them, operators to what they add.

    What is true at the start is left out.
    Nodes have the attributes `kind` (fact, goal, action or method), `label`, and `law` where they may cost something.

    Args:
        task: as `build_rc_model` returns it.
        problem: the ground problem that it is made from.
    """
    import networkx as nx

    graph: nx.MultiDiGraph[str] = nx.MultiDiGraph()
    for fact in sorted(task.facts):
        if fact not in task.initial_state or fact in task.goals:
            graph.add_node(_name(fact), kind="goal" if fact in task.goals else "fact", label=_label(fact, problem))
    for number, operator in enumerate(task.operators):
        node, label = f"o{number}", operator.name.rpartition(" #")[0].strip("() ") or "network"
        if operator.action is None:
            graph.add_node(node, kind="method", label=label)
        else:
            law = _law(operator, problem.actions[operator.action])
            graph.add_node(node, kind="action", label=label, **({} if law is None else {"law": law}))
        graph.add_edges_from((_name(fact), node) for fact in sorted(operator.preconditions) if _name(fact) in graph)
        graph.add_edges_from((node, _name(fact)) for fact in sorted(operator.add_effects) if _name(fact) in graph)
    return graph


def _name(fact: RelaxedFact) -> str:
    return " ".join(map(str, fact))


def _law(operator: RelaxedOperator, action: GroundAction) -> CostLaw | None:
    """Return what an operator of an action costs; None where it is free."""
    if operator.part is None:
        return action.cost
    return action.cost_parts[operator.part].cost if operator.is_due else None


def _label(fact: RelaxedFact, problem: GroundProblem) -> str:
    kind, number = fact[0], fact[1]
    if kind in ("settled", "fails"):
        action = problem.actions[number]
        return f"{'cost' if kind == 'settled' else 'condition'} {kind}: {' '.join((action.name, *action.arguments))}"
    if kind == "reached":
        first_compound = len(problem.actions)
        if number < first_compound:
            action = problem.actions[number]
            return f"done: {' '.join((action.name, *action.arguments))}"
        return f"done: {' '.join(problem.tasks[number - first_compound]) or 'the network'}"
    return f"{'' if kind == 'holds' else 'not '}{' '.join(problem.facts[number])}"
