"""Make problems of the autonomous-vehicle domain (`domains/av`) of any size."""

from __future__ import annotations

import argparse
from pathlib import Path

from statehtn.experiments.generate.roads import Kind, Road, RoadMap, make_road_map

SHORTCUT = ("0.4", "2.6", "0.25")
"""A shortcut: its hours in free traffic and in a jam as shares of a country road's, and how likely the jam is."""
HIGHWAY = ("0.5", "2", "0.1")
DODGE_HOURS = (5, 15)
"""Least and most, in tenths."""


def vehicle_problem(name: str, road_map: RoadMap, note: str = "") -> str:
    """Return the HDDL text of a journey from start to end of a map, at night.

    Args:
        name: of the problem.
        road_map: where the vehicle drives.
        note: a comment for the first lines.
    """
    names = location_names(road_map)
    lines = [f"; {line}" for line in note.splitlines()]
    lines += [f"(define (problem {name})", "  (:domain autonomous-vehicle)", ""]
    lines += ["  (:objects", *_wrapped(names), "      - location)", ""]
    lines += ["  (:htn", "    :parameters ()", "    :ordered-subtasks (and (travel s e)))", ""]
    lines += ["  (:init", "    (at s)", "    (visited s)", "    (destination e)", "    (night)"]
    for road in sorted(road_map.roads, key=lambda road: (road.tail, road.head)):
        lines += _road(road, names)
    for place in sorted(road_map.still):
        tenths = DODGE_HOURS[0] + place % (DODGE_HOURS[1] - DODGE_HOURS[0] + 1)
        lines.append(f"    (incident {names[place]}) (= (dodge-time {names[place]}) {tenths / 10:g})")
    for place in sorted(road_map.moving):
        here = names[place]
        waits = f"(= (short-wait {here}) 0.5) (= (long-wait {here}) 2.5) (= (p-long-wait {here}) 0.9)"
        lines.append(f"    (incident {here}) (moving {here}) {waits}")
    lines[-1] += ")"
    return "\n".join([*lines, "", "  (:metric minimize (total-cost)))", ""])


def location_names(road_map: RoadMap) -> list[str]:
    """Return the locations' names: `s`, `e`, and `l1`, `l2`, ... in between."""
    return ["s", "e", *(f"l{number}" for number in range(1, len(road_map.places) - 1))]


def _road(road: Road, names: list[str]) -> list[str]:
    """Return the facts and costs of a road, for each direction in which it may be driven."""
    hours = max(1, round(road.minutes / 6)) / 10
    free, jam, likely = {Kind.SHORTCUT: SHORTCUT, Kind.HIGHWAY: HIGHWAY}.get(road.kind, ("1", "1", "0"))
    lines = [f"    ; {road.kind.value}"]
    for tail, head in [(road.tail, road.head), (road.head, road.tail)][: 1 + road.is_two_way]:
        way = f"{names[tail]} {names[head]}"
        if road.is_slippery:
            lines[0] = f"    ; {road.kind.value}, icy"
            lines.append(
                f"    (road {way}) (slippery {way}) (= (ice-length {way}) {max(1, round(hours * 2.5)) / 10:g})"
            )
            continue
        times = (float(free) * hours, float(jam) * hours)
        lines.append(
            f"    (road {way}) (= (free-time {way}) {times[0]:.4g}) (= (jam-time {way}) {times[1]:.4g}) "
            f"(= (p-jam {way}) {likely})"
        )
    return lines


def _wrapped(names: list[str]) -> list[str]:
    """Return the names in lines of twenty."""
    return ["    " + " ".join(names[at : at + 20]) for at in range(0, len(names), 20)]


def add_options(parser: argparse.ArgumentParser) -> None:
    """Add the options of this generator to a parser."""
    texts = {
        "roads": "roads, both directions counted once",
        "locations": "locations, start and end among them",
        "moving": "locations where something that moves is in the way",
        "still": "locations where something that stands is in the way",
        "bad": "roads in bad condition",
    }
    for option, text in texts.items():
        parser.add_argument(f"--{option}", type=int, required=True, metavar="N", help=f"how many {text}")
    parser.add_argument("--seed", type=int, default=1, metavar="N", help="another one makes another map; default: 1")
    parser.add_argument("--name", metavar="NAME", help="of the problem; default: one that says its sizes")
    parser.add_argument("--map", metavar="FILE.svg", help="draw the map, too (needs the extra 'plots')")


def generate(options: argparse.Namespace) -> str:
    """Return the problem that the options ask for, and draw its map where they say so.

    Raises:
        UsageError: there is no map of these sizes, or matplotlib is missing, or the file cannot be written.
    """
    road_map = make_road_map(options.roads, options.locations, options.moving, options.still, options.bad, options.seed)
    if options.map:
        from statehtn.experiments.generate.map_picture import draw_map

        draw_map(road_map, location_names(road_map), Path(options.map))
    sizes = " ".join(
        f"--{name} {getattr(options, name)}" for name in ("roads", "locations", "moving", "still", "bad", "seed")
    )
    name = options.name or f"av-{options.roads}roads-{options.locations}locations-{options.seed}"
    naming = f" --name {options.name}" if options.name else ""
    note = f"Made by: python -m statehtn.experiments.generate av {sizes}{naming}"
    return vehicle_problem(name, road_map, note)
