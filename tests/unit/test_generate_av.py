"""The vehicle maps: exactly the sizes that the paper prints, planar, and a choice for every attitude."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

import networkx as nx
import pytest

import statehtn
from statehtn.errors import UsageError
from statehtn.experiments.generate.roads import Kind, make_road_map
from statehtn.model import Problem

AV = Path(__file__).parents[2] / "domains" / "av"
# Roads, locations, moving and still incidents, bad roads; P1 to P5 as in the paper's section on its experiments.
SIZES = {
    1: (8, 7, 1, 1, 1),
    2: (16, 13, 2, 1, 2),
    3: (41, 33, 4, 4, 4),
    4: (64, 52, 8, 6, 5),
    5: (76, 63, 8, 8, 8),
    6: (150, 125, 16, 14, 14),
    7: (300, 250, 30, 30, 25),
    8: (600, 500, 60, 60, 50),
    9: (1000, 830, 100, 100, 80),
}
NAMES = ("roads", "locations", "moving", "still", "bad")
AGENTS = [("neutral", None), ("averse", 0.1), ("averse", 0.9), ("seeking", 0.1), ("seeking", 0.9)]


def read(number: int) -> Problem:
    return statehtn.read_hddl(AV / "domain.hddl", AV / f"p{number}.hddl")


def facts(problem: Problem, predicate: str) -> set[frozenset[str]]:
    """The arguments of a predicate's facts as sets: two directions are one road."""
    found = re.findall(rf"\({predicate} ([^()]*)\)", (AV / f"{problem.name}.hddl").read_text(encoding="utf-8"))
    return {frozenset(arguments.split()) for arguments in found}


@pytest.mark.parametrize("number", SIZES)
def test_sizes_are_the_papers(number: int) -> None:
    problem = read(number)
    incidents, moving = facts(problem, "incident"), facts(problem, "moving")
    assert moving <= incidents
    counts = (len(facts(problem, "road")), len(problem.objects), len(moving), len(incidents - moving))
    assert (*counts, len(facts(problem, "slippery"))) == SIZES[number]


@pytest.mark.parametrize("number", SIZES)
def test_maps_are_connected_and_planar(number: int) -> None:
    problem = read(number)
    graph = nx.Graph(tuple(road) for road in facts(problem, "road"))
    assert set(graph) == set(problem.objects)
    assert nx.is_connected(graph)
    assert nx.check_planarity(graph)[0]


@pytest.mark.parametrize("number", list(SIZES)[1:])
def test_files_are_what_the_generator_makes(number: int) -> None:
    options = [f"--{name}={size}" for name, size in zip(NAMES, SIZES[number], strict=True)]
    command = [sys.executable, "-m", "statehtn.experiments.generate", "av", *options, f"--seed={number}"]
    made = subprocess.run([*command, "--name", f"p{number}"], capture_output=True, text=True, check=True).stdout
    assert made == (AV / f"p{number}.hddl").read_text(encoding="utf-8")


@pytest.mark.parametrize("number", SIZES)
def test_attitudes_part(number: int) -> None:
    problem = read(number)
    results = [statehtn.plan(problem, attitude=attitude, alpha=alpha) for attitude, alpha in AGENTS]
    assert all(result.status is statehtn.Status.OPTIMAL for result in results)
    averse, seeking = results[2], results[4]
    assert averse.plan.steps != seeking.plan.steps


@pytest.mark.parametrize("seed", range(20))
def test_every_map_has_a_shortcut_a_highway_and_a_way_round(seed: int) -> None:
    road_map = make_road_map(30, 24, 3, 3, 3, seed)
    assert {Kind.COUNTRY, Kind.SHORTCUT, Kind.HIGHWAY} <= {road.kind for road in road_map.roads}
    assert all(road.minutes > 0 for road in road_map.roads)
    pairs = [frozenset((road.tail, road.head)) for road in road_map.roads]
    assert len(set(pairs)) == len(pairs) == 30
    assert len(road_map.places) == 24
    assert not road_map.moving & road_map.still


@pytest.mark.parametrize(
    "sizes",
    [(8, 8, 0, 0, 0), (20, 11, 0, 0, 0), (16, 13, 6, 0, 0), (16, 13, -1, 0, 0), (16, 13, 0, 0, 5), (3, 2, 0, 0, 0)],
)
def test_sizes_without_a_map(sizes: tuple[int, int, int, int, int]) -> None:
    with pytest.raises(UsageError, match="expected"):
        make_road_map(*sizes, seed=1)


def test_the_picture_is_an_svg_file_and_always_the_same(tmp_path: Path) -> None:
    pytest.importorskip("matplotlib")
    from statehtn.experiments.generate.av import location_names
    from statehtn.experiments.generate.map_picture import draw_map

    road_map = make_road_map(16, 13, 2, 1, 2, 2)
    for name in ("a.svg", "b.svg"):
        draw_map(road_map, location_names(road_map), tmp_path / name)
    assert (tmp_path / "a.svg").read_bytes() == (tmp_path / "b.svg").read_bytes()
    assert b"</svg>" in (tmp_path / "a.svg").read_bytes()
    with pytest.raises(UsageError, match="cannot write"):
        draw_map(road_map, location_names(road_map), tmp_path / "no" / "map.svg")
