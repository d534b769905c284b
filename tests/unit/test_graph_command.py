"""`statehtn graph`: files of every kind and format, and what is said when something is wrong."""

from __future__ import annotations

import shutil
import sys
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import networkx as nx
import pytest

from statehtn.cli import main
from statehtn.decomposition import drawing

AV = Path(__file__).parents[2] / "domains" / "av"
INPUTS = [str(AV / "domain.hddl"), str(AV / "p1.hddl")]
KINDS = ("cv-tdg", "gcv-tdg", "relaxed-model")


def write(output: Path, *options: str) -> int:
    return main(["graph", *INPUTS, *options, "--output", str(output)])


@pytest.mark.parametrize("kind", KINDS)
def test_graphml_can_be_read_back(kind: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "graph.graphml"
    assert write(file, "--kind", kind) == 0
    graph = nx.read_graphml(file, force_multigraph=True)
    assert f"{len(graph)} nodes, {graph.number_of_edges()} edges" in capsys.readouterr().out
    assert all(data["label"] for _, data in graph.nodes(data=True))


@pytest.mark.parametrize("kind", KINDS)
def test_dot_and_svg(kind: str, tmp_path: Path) -> None:
    pytest.importorskip("pydot")
    assert write(tmp_path / "graph.dot", "--kind", kind) == 0
    assert (tmp_path / "graph.dot").read_text().startswith("digraph")
    if shutil.which("dot") is None:
        pytest.skip("Graphviz is not here")
    assert write(tmp_path / "graph.svg", "--kind", kind) == 0
    ElementTree.parse(tmp_path / "graph.svg")


def test_values_for_an_agent(tmp_path: Path) -> None:
    file = tmp_path / "graph.graphml"
    assert write(file, "--attitude", "averse", "--alpha", "0.9") == 0
    graph = nx.read_graphml(file, force_multigraph=True)
    root = next(data for _, data in graph.nodes(data=True) if data["label"] == "(initial network)")
    assert 0 < root["risk_cost"] <= 19.4


@pytest.mark.parametrize(
    ("options", "output", "words"),
    [
        ([], "graph.pdf", "expected a name that ends in .svg"),
        ([], "graph", "expected a name"),
        (["--kind", "cv-tdg", "--attitude", "averse", "--alpha", "1"], "g.dot", "shown on the gcv-tdg"),
        (["--attitude", "averse"], "g.dot", "alpha"),
        ([], "no/such/folder/g.dot", "no directory"),
    ],
)
def test_usage(options: list[str], output: str, words: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert write(tmp_path / output, *options) == 2
    assert words in capsys.readouterr().err


def test_what_is_missing_is_named(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    pytest.importorskip("pydot")
    monkeypatch.setenv("PATH", str(tmp_path))
    assert write(tmp_path / "graph.svg") == 2
    assert "needs Graphviz" in capsys.readouterr().err
    monkeypatch.setitem(sys.modules, "pydot", None)
    assert write(tmp_path / "graph.dot") == 2
    assert "pip install 'statehtn[graph]'" in capsys.readouterr().err
    assert not list(tmp_path.iterdir())


def test_pictures_that_nobody_can_look_at(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(drawing, "MOST_NODES", 10)
    assert write(tmp_path / "graph.svg") == 2
    assert "91 nodes" in capsys.readouterr().err
