"""The task decomposition graphs of a problem (paper Definitions 4.5 and 4.6) and the values on them (Algorithms 1, 2).

Graphs are `networkx.MultiDiGraph`s: a method may contain a task several times. Nodes have the attributes `kind` (see
`Kind`) and `label`; primitive tasks have `law`, the law of their cost (in the lifted graph `cost`, as HDDL), methods
have `ordering`, pairs of positions. Edges from a method to its subtasks have `position`, from 0.
"""

from statehtn.decomposition.compute_task_eu import compute_utilities
from statehtn.decomposition.drawing import to_dot, to_graphml, to_svg
from statehtn.decomposition.graphs import Kind, ground_task_decomposition_graph, task_decomposition_graph
from statehtn.decomposition.values import least_risk_costs, paper_value, with_values

__all__ = [
    "Kind",
    "compute_utilities",
    "ground_task_decomposition_graph",
    "least_risk_costs",
    "paper_value",
    "task_decomposition_graph",
    "to_dot",
    "to_graphml",
    "to_svg",
    "with_values",
]
