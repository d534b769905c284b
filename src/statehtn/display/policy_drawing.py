"""A policy as a graph to draw: its actions, what may come of them, and how runs end."""

from __future__ import annotations

from typing import TYPE_CHECKING

from statehtn.counted import likely
from statehtn.display.policy_outline import MOST_NODES, outline
from statehtn.display.policy_tree import ENDS
from statehtn.errors import UsageError
from statehtn.model.policy_graph import End, PolicyGraph

if TYPE_CHECKING:
    import networkx as nx


def drawn_policy(graph: PolicyGraph) -> nx.MultiDiGraph[str]:
    """Return a graph that `to_dot`, `to_svg` and `to_graphml` write: a node for each action or end, equal ways as one.

    Raises:
        UsageError: the policy is too large to be looked at.
    """
    import networkx as nx

    if len(graph) > MOST_NODES:
        raise UsageError(f"a picture of {len(graph)} nodes would show nothing (at most {MOST_NODES}); --json writes it")
    found: nx.MultiDiGraph[str] = nx.MultiDiGraph()
    places = outline(graph).places
    for index, place in enumerate(places):
        if place.end is not None:
            found.add_node(str(index), kind="done" if place.end is End.DONE else "failed", label=ENDS[place.end])
        else:
            cost = f"cost {place.cost}" if place.cost != "0" else ""
            found.add_node(str(index), kind="action", label=str(place.step), cost=cost)
    for index, place in enumerate(places):
        for choice in place.choices:
            parts = [choice.condition]
            if choice.probability is not None and len(place.choices) > 1:
                parts.append(likely(choice.probability, choice.rest, digits=6))
            found.add_edge(str(index), str(choice.place), condition="\n".join(part for part in parts if part))
    return found
