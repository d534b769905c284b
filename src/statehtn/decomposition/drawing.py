"""Graphs as files: GraphML for other programs, DOT and SVG for the eye."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

from statehtn.errors import UsageError

if TYPE_CHECKING:
    import networkx as nx

STYLES: dict[str, dict[str, Any]] = {
    "compound task": {"shape": "box", "style": "filled,rounded", "fillcolor": "#cfe2f3"},
    "primitive task": {"shape": "box", "style": "filled", "fillcolor": "#fce5cd"},
    "method": {"shape": "ellipse", "style": "filled", "fillcolor": "#eeeeee"},
    "fact": {"shape": "ellipse", "style": "filled", "fillcolor": "#d9ead3"},
    "goal": {"shape": "ellipse", "style": "filled", "fillcolor": "#ffd966"},
    "action": {"shape": "box", "style": "filled", "fillcolor": "#fce5cd"},
    "done": {"shape": "ellipse", "style": "filled", "fillcolor": "#d9ead3"},
    "failed": {"shape": "ellipse", "style": "filled", "fillcolor": "#f4cccc"},
}
"""How the nodes of each kind are drawn."""
LINE = 28  # characters of a label before it is broken
MOST_NODES = 2000  # Graphviz takes minutes for more


def to_graphml(graph: nx.MultiDiGraph[str]) -> str:
    """Return the graph as GraphML; attributes that it does not know become text."""
    import networkx as nx

    plain: Any = graph.__class__()
    for node, attributes in graph.nodes(data=True):
        shown = {name: _plain(value) for name, value in attributes.items() if name != "cost_parts"}  # `cost` says it
        plain.add_node(node, **shown)
    for tail, head, attributes in graph.edges(data=True):
        plain.add_edge(tail, head, **{name: _plain(value) for name, value in attributes.items()})
    return "\n".join(nx.generate_graphml(plain)) + "\n"


def to_dot(graph: nx.MultiDiGraph[str]) -> str:
    """Return the graph in Graphviz's language.

    Raises:
        UsageError: pydot is missing.
    """
    return str(_dot(graph).to_string())


def to_svg(graph: nx.MultiDiGraph[str]) -> str:
    """Return the graph as a picture, laid out by Graphviz.

    Raises:
        UsageError: pydot or Graphviz is missing, or the graph is too large to be looked at.
    """
    if len(graph) > MOST_NODES:
        raise UsageError(
            f"a picture of {len(graph)} nodes would take minutes and show nothing (at most {MOST_NODES}); "
            "write a .dot or a .graphml file"
        )
    try:
        return str(_dot(graph).create(format="svg").decode("utf-8"))
    except FileNotFoundError:
        raise UsageError(
            "an .svg file needs Graphviz (Debian/Ubuntu: apt install graphviz; macOS: brew install graphviz); "
            "or write a .dot or a .graphml file"
        ) from None


def _dot(graph: nx.MultiDiGraph[str]) -> Any:
    try:
        import pydot
    except ImportError:
        raise UsageError("DOT and SVG need pydot: pip install 'statehtn[graph]'; or write a .graphml file") from None

    dot: Any = pydot.Dot(
        "statehtn", graph_type="digraph", rankdir="TB", nodesep="0.15", ranksep="0.35", bgcolor="white"
    )
    dot.set_node_defaults(fontname="Helvetica", fontsize="10", margin="0.08,0.04", height="0.25", color="#666666")
    dot.set_edge_defaults(color="#666666", arrowsize="0.6", fontname="Helvetica", fontsize="9")
    kinds = []
    for node, attributes in graph.nodes(data=True):
        kind = str(attributes["kind"])
        kinds.append(kind)
        dot.add_node(pydot.Node(_quoted(node), label=_quoted(_label(attributes)), **STYLES[kind]))
    for tail, head, condition in graph.edges(data="condition"):
        label: dict[str, Any] = {} if not condition else {"label": _quoted(_lines(str(condition)))}
        dot.add_edge(pydot.Edge(_quoted(tail), _quoted(head), **label))
    legend = pydot.Cluster(
        "legend", label=_quoted("kinds of nodes"), fontname="Helvetica", fontsize="9", color="#bbbbbb"
    )
    for kind in dict.fromkeys(kinds):
        legend.add_node(pydot.Node(_quoted(f"legend {kind}"), label=_quoted(kind), **STYLES[kind]))
    dot.add_subgraph(legend)
    return dot


def _label(attributes: dict[str, Any]) -> str:
    """Return what a node says: its name, its cost, and what it is worth to the agent."""
    lines = [str(attributes["label"])]
    law, value = attributes.get("law"), attributes.get("risk_cost")
    lines += str(attributes.get("cost") or law or "").split("; ")
    if law is not None and value is not None:
        lines += [f"worth {value:.4g}"] if law.least < law.most else []
    elif value is not None:
        lines.append(f"at least {value:.4g}" if math.isfinite(value) else "impossible")
    return _lines("\n".join(lines))


def _lines(text: str) -> str:
    """Return a text with long lines broken, and without empty ones."""
    return "\n".join(part for line in text.split("\n") for part in _broken(line) if part)


def _broken(line: str) -> list[str]:
    """Break a line between words."""
    lines = [""]
    for word in line.split():
        if lines[-1] and len(lines[-1]) + len(word) >= LINE:
            lines.append("")
        lines[-1] = f"{lines[-1]} {word}".strip()
    return lines


def _quoted(text: str) -> str:
    escaped = text.replace("\\", "\\\\").replace('"', '\\"').replace("\n", "\\n")
    return f'"{escaped}"'


def _plain(value: object) -> str | int | float:
    """Return a value as GraphML knows it."""
    if isinstance(value, int | float):
        return value
    if isinstance(value, tuple):
        return " ".join(f"{i}<{j}" for i, j in value)
    return str(value)
