"""How results and decompositions look: text, HTML, pictures."""

from __future__ import annotations

import builtins
import sys
from collections.abc import Iterator, Mapping, Sequence
from html.parser import HTMLParser
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

import statehtn
from statehtn import Decomposition, Plan, Result, Step, UsageError
from statehtn.display.table import Column, Table
from statehtn.display.tree import tree_text
from statehtn.model.decomposition_tree import TreeRow

DOMAINS = Path(__file__).parents[2] / "domains"


@pytest.fixture(scope="module")
def result() -> Result:
    problem = statehtn.read_hddl(DOMAINS / "av" / "domain.hddl", DOMAINS / "av" / "p1.hddl")
    return statehtn.plan(problem, attitude="seeking", alpha=0.9)


def test_a_result_prints_as_a_table(result: Result) -> None:
    lines = str(result).splitlines()
    assert lines[0] == "status: optimal (risk-seeking, alpha 0.9)"
    assert lines[1].split() == ["action", "cost", "expected", "certainty", "equivalent"]
    assert lines[5] == "3  (accelerate s l3)   2 w.p. 0.8, 6 w.p. 0.2           2.8           2.240373162"
    assert lines[-2].split() == ["in", "all", "22.8", "10.16777339"]
    assert lines[-1] == "expected utility 0.0001179045054"
    assert len({len(line) for line in lines[1:-1]}) == 1  # all numbers end at the same column


def test_results_without_a_plan_print(result: Result) -> None:
    from dataclasses import replace

    stopped = replace(result, found=None, status=statehtn.Status.TIME_LIMIT, bound=7.5)
    assert str(stopped).splitlines() == [
        "status: time-limit (risk-seeking, alpha 0.9)",
        "every plan has a certainty equivalent of at least 7.5",
    ]
    assert "<table" not in stopped._repr_html_()
    solved = replace(result, status=statehtn.Status.SOLVED, bound=9.0)
    assert "no plan has a certainty equivalent below 9" in str(solved)


class Balanced(HTMLParser):
    """Reads HTML whose elements must all be closed, in order."""

    def __init__(self, html: str) -> None:
        super().__init__()
        self.open: list[str] = []
        self.seen: list[str] = []
        self.text = ""
        self.feed(html)
        self.close()
        assert self.open == []

    def handle_starttag(self, tag: str, attrs: Sequence[tuple[str, str | None]]) -> None:
        self.open.append(tag)
        self.seen.append(tag)
        assert all(name == "style" for name, _ in attrs)

    def handle_endtag(self, tag: str) -> None:
        assert self.open.pop() == tag

    def handle_data(self, data: str) -> None:
        self.text += data


def test_a_result_shows_itself_in_notebooks(result: Result) -> None:
    html = Balanced(result._repr_html_())
    assert html.seen.count("tr") == 1 + len(result.steps) + 1
    assert "(accelerate s l3)" in html.text
    assert str(result.plan.decomposition) in html.text


@given(st.lists(st.text(max_size=5), min_size=2, max_size=2))
def test_html_is_escaped(cells: list[str]) -> None:
    names = [cell.replace("\r", "").replace("\x00", "") for cell in cells]
    table = Table((Column("<a>"), Column("b", is_number=True)), [names, ["<script>", "&amp;"]])
    html = Balanced(table.to_html())
    assert "script" not in html.seen
    assert html.text == f"<a>b{''.join(names)}<script>&amp;"


def test_a_decomposition_prints_as_a_tree() -> None:
    ends = Decomposition("rest", (), "done")
    plan = Plan(
        (Step("go", ("a", "b")), Step("look")),
        (Decomposition("trip", ("b",), "by-foot", (0, ends)), 1, Decomposition("trip", ("b",), "stay")),
    )
    assert str(plan.decomposition).splitlines() == [
        "initial network",
        "├── (trip b)  by by-foot",
        "│   ├── 1. (go a b)",
        "│   └── (rest)  by done",
        "├── 2. (look)",
        "└── (trip b)  by stay",
    ]
    assert Balanced(plan.decomposition._repr_html_()).text == str(plan.decomposition)
    assert str(Plan().decomposition) == "initial network"


def test_deep_decompositions_print() -> None:
    node: Decomposition | int = 0
    for depth in range(3000):
        node = Decomposition("t", (str(depth),), "m", (node,))
    lines = str(Plan((Step("end"),), (node,)).decomposition).splitlines()
    assert (len(lines), lines[-1].strip()) == (3002, "└── 1. (end)")


@st.composite
def trees(draw: st.DrawFn) -> list[TreeRow]:
    depths = [0]
    for _ in range(draw(st.integers(0, 12))):
        depths.append(draw(st.integers(1, depths[-1] + 1)))
    return [TreeRow(depth, f"n{index}") for index, depth in enumerate(depths)]


@given(trees())
def test_trees_can_be_read_back_from_their_text(rows: list[TreeRow]) -> None:
    lines = tree_text(rows).splitlines()
    assert [line.index("n") // 4 for line in lines] == [row.depth for row in rows]
    for index, line in enumerate(lines[1:], 1):
        siblings = [other.depth for other in rows[index + 1 :]]
        until_parent = siblings[: next((i for i, depth in enumerate(siblings) if depth < rows[index].depth), None)]
        assert ("├── " in line) == (rows[index].depth in until_parent)
        # A bar goes on below exactly where the line above has one, or a branch that goes on.
        for place, character in enumerate(line):
            if character in "│├└":
                assert place // 4 == 0 or lines[index - 1][place] in "│├" or lines[index - 1].index("n") == place
            elif character == " " and place % 4 == 0 and place < line.index("n"):
                assert lines[index - 1][place] not in "│├"


def test_a_decomposition_can_be_drawn(result: Result, tmp_path: Path) -> None:
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("Agg")
    from matplotlib import pyplot

    assert result.plan is not None
    tree = result.plan.decomposition
    ax = tree.plot()
    texts = [text.get_text() for text in ax.texts]
    assert len(texts) == len(tree.rows)
    assert "(travel s e)\nby travel" in texts
    assert "8. (stop)" in texts
    assert len(ax.lines) == len(tree.rows) - 1
    ax.figure.savefig(tmp_path / "tree.png")
    boxes = [text.get_window_extent() for text in ax.texts]
    for i, box in enumerate(boxes):
        assert ax.figure.bbox.contains(*box.min)
        assert ax.figure.bbox.contains(*box.max)
        assert not any(box.overlaps(other) for other in boxes[:i])
    assert tree.plot(ax) is ax
    pyplot.close(ax.figure)
    large = Plan(tuple(Step("a") for _ in range(500)), tuple(range(500)))
    with pytest.raises(UsageError, match="a picture of 501 nodes cannot be read"):
        large.decomposition.plot()


@pytest.fixture
def _without_matplotlib(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    original = builtins.__import__

    def refuse(name: str, globals: Mapping[str, Any] | None = None, *rest: Any) -> Any:  # noqa: A002
        if name.startswith("matplotlib"):
            raise ImportError(name)
        return original(name, globals, *rest)

    for name in [name for name in sys.modules if name.startswith("matplotlib")]:
        monkeypatch.delitem(sys.modules, name)
    monkeypatch.setattr(builtins, "__import__", refuse)
    yield
    monkeypatch.undo()


@pytest.mark.usefixtures("_without_matplotlib")
def test_a_missing_package_is_named(result: Result) -> None:
    assert result.plan is not None
    with pytest.raises(UsageError, match=r"needs the package 'matplotlib': pip install 'statehtn\[plots\]'"):
        result.plan.decomposition.plot()
