"""The task decomposition graphs of a problem (paper Definitions 4.5 and 4.6) and what tasks are worth on them.

Graphs are `networkx.MultiDiGraph`s: a method may contain a task several times. Nodes have the attributes `kind` (see
`Kind`) and `label`; primitive tasks have `law`, the law of their cost (in the lifted graph `cost`, as HDDL), methods
have `ordering`, pairs of positions. Edges from a method to its subtasks have `position`, from 0.

The paper's own values (Algorithms 1 and 2) are in `statehtn.reference`.
"""

import warnings
from importlib import import_module
from typing import Any

from statehtn.decomposition.drawing import to_dot, to_graphml, to_svg
from statehtn.decomposition.graphs import Kind, ground_task_decomposition_graph, task_decomposition_graph
from statehtn.decomposition.values import least_risk_costs, with_values
from statehtn.risk.expected_utility import paper_value

__all__ = [
    "Kind",
    "ground_task_decomposition_graph",
    "least_risk_costs",
    "paper_value",
    "task_decomposition_graph",
    "to_dot",
    "to_graphml",
    "to_svg",
    "with_values",
]


def __getattr__(name: str) -> Any:
    if name == "compute_utilities":
        warnings.warn(
            "statehtn.decomposition.compute_utilities is deprecated: import it from statehtn.reference",
            DeprecationWarning,
            stacklevel=2,
        )
        return import_module("statehtn.reference").compute_utilities
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
