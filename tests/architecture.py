"""Draws the rooms of the project and who uses whom, from the real includes and imports.

`python -m tests.architecture` writes docs/images/architecture.svg; it needs Graphviz. `tests/unit/test_architecture.py`
reads the rooms and arrows back from the picture and fails where they are no longer those of the code.

A room is a folder of relax/, or a package or module of src/statehtn/. An arrow means "uses"; arrows that follow from
others are left out.
"""

from __future__ import annotations

import ast
import html
import re
from collections.abc import Iterator

import networkx as nx

from tests.pages import ROOT

PICTURE = ROOT / "docs" / "images" / "architecture.svg"
PYTHON, CORE = ROOT / "src" / "statehtn", ROOT / "relax"
DISPLAY = "statehtn/display"
COMPILED = "_relax"  # the module that relax/bindings/ makes
_INCLUDE = re.compile(r'^#include "relax/(\w+)/', re.MULTILINE)

STYLE = """<style>
svg { background: #ffffff; }
text { fill: #1f2328; font-family: system-ui, "Segoe UI", Helvetica, Arial, sans-serif; }
.python path, .python polygon { fill: #dceafb; stroke: #4a7ebb; }
.core path, .core polygon { fill: #e3f1dc; stroke: #5d9140; }
.cluster path, .cluster polygon { fill: none; stroke: #8c959f; }
.edge path { stroke: #57606a; }
.edge polygon { fill: #57606a; stroke: #57606a; }
@media (prefers-color-scheme: dark) {
  svg { background: #161b22; }
  text { fill: #e6edf3; }
  .python path, .python polygon { fill: #1c3350; stroke: #6f9fd8; }
  .core path, .core polygon { fill: #24401a; stroke: #86b86a; }
  .edge path { stroke: #9aa4af; }
  .edge polygon { fill: #9aa4af; stroke: #9aa4af; }
}
</style>
"""


def uses() -> nx.DiGraph:
    """Return the graph of rooms, by their paths: who uses whom. Of a room's own parts nothing is said."""
    graph = nx.DiGraph([*_includes(), *_imports()])
    graph.remove_edges_from([(room, room) for room in graph])
    # What is shown imports what shows it when it is asked to show itself; it is the display that knows both.
    graph.remove_edges_from([(room, DISPLAY) for room in list(graph.successors(DISPLAY))])
    return graph


def arrows(graph: nx.DiGraph) -> nx.DiGraph:
    """Return the graph without the arrows that follow from others.

    Raises:
        networkx.NetworkXError: rooms use each other in a circle.
    """
    return nx.transitive_reduction(graph)


def _includes() -> Iterator[tuple[str, str]]:
    for path in (*CORE.rglob("*.hpp"), *CORE.rglob("*.cpp")):
        room = path.relative_to(CORE).parts[0]
        if room != "tests":
            for used in _INCLUDE.findall(path.read_text(encoding="utf-8")):
                yield f"relax/{room}", f"relax/{used}"


def _imports() -> Iterator[tuple[str, str]]:
    for path in PYTHON.rglob("*.py"):
        room = path.relative_to(PYTHON).parts[0].removesuffix(".py")
        if room != "__init__":
            for name in _imported(ast.parse(path.read_text(encoding="utf-8"))):
                used = "relax/bindings" if name == COMPILED else f"statehtn/{name}"
                yield f"statehtn/{room}", used


def _imported(tree: ast.Module) -> Iterator[str]:
    """Yield the rooms that a module of statehtn imports, inside functions, too."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            names = [alias.name for alias in node.names]
        elif isinstance(node, ast.ImportFrom) and node.module == "statehtn":
            names = [f"statehtn.{alias.name}" for alias in node.names]
        elif isinstance(node, ast.ImportFrom):
            names = [node.module or ""]
        else:
            continue
        for name in names:
            package, _, rest = name.partition(".")
            if package == "statehtn" and rest:
                yield rest.split(".")[0]


def drawn(picture: str) -> nx.DiGraph:
    """Return the rooms and arrows that a picture shows."""
    graph = nx.DiGraph()
    for kind, title in re.findall(r'<g id="[^"]*" class="(node|edge)[^"]*">\s*<title>(.*?)</title>', picture):
        names = html.unescape(title).split("->")
        graph.add_edge(*names) if kind == "edge" else graph.add_node(*names)
    return graph


def draw(graph: nx.DiGraph) -> str:
    """Return the picture as SVG, laid out by Graphviz."""
    import pydot

    dot = pydot.Dot("architecture", graph_type="digraph", rankdir="TB", nodesep="0.18", ranksep="0.42")
    dot.set_node_defaults(shape="box", style="rounded,filled", fontname="Helvetica", fontsize="13", height="0.35")
    dot.set_edge_defaults(arrowsize="0.6")
    for part, title in (("statehtn", "src/statehtn: Python"), ("relax", "relax: the compiled core, C++")):
        cluster = pydot.Cluster(part, label=title, fontname="Helvetica", fontsize="14", style="rounded", margin="14")
        style = {"class": "core" if part == "relax" else "python"}
        for room in sorted(graph):
            if room.startswith(f"{part}/"):
                cluster.add_node(pydot.Node(f'"{room}"', label=f'"{room.partition("/")[2]}"', **style))
        dot.add_subgraph(cluster)
    for edge in sorted(graph.edges):
        dot.add_edge(pydot.Edge(*(f'"{room}"' for room in edge)))
    picture = str(dot.create(format="svg"), "utf-8")
    picture = re.sub(r"<!--.*?-->\n?", "", picture, flags=re.DOTALL)
    picture = re.sub(r'<polygon fill="white" stroke="transparent"[^>]*/>\n', "", picture)
    return re.sub(r"(<svg[^>]*>\n)", lambda opening: opening[1] + STYLE, picture, count=1, flags=re.DOTALL)


if __name__ == "__main__":
    PICTURE.write_text(draw(arrows(uses())), encoding="utf-8")
