"""The picture of the architecture shows the rooms and arrows of the code, and none of them points upward."""

from __future__ import annotations

import re
import shutil

import networkx as nx
import pytest

from tests.architecture import PICTURE, arrows, draw, drawn, uses


def test_the_picture_is_that_of_the_code() -> None:
    now, then = arrows(uses()), drawn(PICTURE.read_text(encoding="utf-8"))
    told = "out of date: draw it anew by `python -m tests.architecture`"
    assert sorted(then.nodes) == sorted(now.nodes), told
    assert sorted(then.edges) == sorted(now.edges), told


def test_rooms_use_each_other_one_way() -> None:
    rooms = uses()
    assert nx.is_directed_acyclic_graph(rooms)
    assert [user for user, used in rooms.edges if used == "relax/bindings"] == ["statehtn/core"]


@pytest.mark.skipif(shutil.which("dot") is None, reason="pictures are laid out by Graphviz")
def test_what_is_drawn_is_read_back() -> None:
    pytest.importorskip("pydot", reason="pictures are laid out by pydot")
    graph = nx.DiGraph([("statehtn/cli", "statehtn/__main__"), ("statehtn/cli", "relax/base")])
    picture = draw(graph)
    assert nx.utils.graphs_equal(drawn(picture), graph)
    assert picture.count("prefers-color-scheme") == 1


def test_the_page_says_what_each_room_is() -> None:
    page = (PICTURE.parents[1] / "architecture.md").read_text(encoding="utf-8")
    rows = [line.split("|")[1] for line in page.splitlines() if line.startswith("| `")]
    told = {f"`{room.partition('/')[2]}`" for room in uses()}
    assert {room for row in rows for room in re.findall("`[^`]*`", row)} == told
