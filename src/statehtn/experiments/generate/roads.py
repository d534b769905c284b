"""Make road maps: planar, connected, and with a choice between routes that are safe, short or fast."""

from __future__ import annotations

import math
import random
from dataclasses import dataclass, field
from enum import Enum

from statehtn.errors import UsageError

START, END = 0, 1
"""The locations where a journey begins and ends."""


class Kind(Enum):
    """Kinds of roads; `domains/av/README.md` says what each costs."""

    COUNTRY = "country road"
    SHORTCUT = "shortcut"
    HIGHWAY = "highway"
    SIDE = "side street"


@dataclass
class Road:
    """A road, driven from `tail` to `head` only; highways and side streets both ways.

    Args:
        minutes: what it takes as a country road.
        side: of which side the next way round it is to be drawn, 1 or -1.
    """

    tail: int
    head: int
    minutes: int
    kind: Kind = Kind.COUNTRY
    side: int = 1
    is_slippery: bool = False

    @property
    def is_two_way(self) -> bool:
        """Whether it may be driven from its head to its tail, too."""
        return self.kind in (Kind.HIGHWAY, Kind.SIDE)


@dataclass
class RoadMap:
    """Locations by their places in the plane, roads, and the locations where something is in the way."""

    places: list[tuple[float, float]]
    roads: list[Road]
    moving: set[int] = field(default_factory=set)
    still: set[int] = field(default_factory=set)


def make_road_map(roads: int, locations: int, moving: int, still: int, bad: int, seed: int) -> RoadMap:
    """Return a random map of exactly these sizes.

    It grows from one road between start and end by steps that keep it planar: a road gets a location on its way; a
    detour round it, and is a shortcut from then on; a highway from there to its detour; or a side street. Longer roads
    are the likelier to be chosen.

    Args:
        roads: how many there are, the two directions of a road counted once.
        locations: how many there are, start and end among them.
        moving: at how many locations something that moves is in the way.
        still: at how many locations something that stands is in the way.
        bad: how many roads are slippery.
        seed: another one makes another map.

    Raises:
        UsageError: there is no such map.
    """
    cycles = roads - locations + 1
    if not 2 <= cycles <= locations - 2:
        raise UsageError(
            "expected more roads than locations (for a choice of routes) and at most twice as many less 3; "
            f"found {roads} roads and {locations} locations"
        )
    if min(moving, still, bad) < 0 or moving + still > (locations - 2) // 2 or bad > roads // 4:
        raise UsageError(
            f"expected at most {(locations - 2) // 2} locations with something in the way and at most {roads // 4} bad "
            f"roads; found {moving} moving and {still} still and {bad} bad roads"
        )
    growing = _GrowingMap(roads, random.Random(seed))
    growing.grow(locations, cycles)
    growing.put_obstacles(moving, still, bad)
    return growing.map


class _GrowingMap:
    """A map while it is made. Only `random()` yields the same numbers in every version of Python."""

    def __init__(self, roads: int, draw: random.Random) -> None:
        self.draw = draw
        hours = 6 + 2.5 * math.sqrt(roads)
        self.map = RoadMap([(0.0, 0.0), (hours, 0.0)], [Road(START, END, round(60 * hours))])
        self.detours: list[tuple[Road, int]] = []  # shortcuts without a highway, each with a location of its detour

    def grow(self, locations: int, cycles: int) -> None:
        """Take steps until there are so many locations and independent cycles; each of them takes one location."""
        highways = max(1, cycles // 3)
        others = locations - 2 - cycles
        sides = others // 6
        self.split(self.map.roads[0])
        self.detour(self.some_road(Kind.COUNTRY))
        self.highway()
        steps = ["detour"] * (cycles - highways - 1) + ["highway"] * (highways - 1)
        steps += ["side"] * sides + ["split"] * (others - sides - 1)
        while steps:
            step = steps.pop(self.below(len(steps)))
            if step == "highway" and not self.detours:
                steps.append(step)
            elif step == "detour":
                self.detour(self.some_road(Kind.COUNTRY))
            elif step == "highway":
                self.highway()
            elif step == "side":
                self.side_street()
            else:
                self.split(self.some_road(Kind.COUNTRY, Kind.SHORTCUT))

    def put_obstacles(self, moving: int, still: int, bad: int) -> None:
        """Put things in the way, and ice on the last road and some others."""
        inner = [road.head for road in self.map.roads if road.kind is not Kind.SIDE and road.head != END]
        inner = sorted(set(inner))
        for places, count in ((self.map.moving, moving), (self.map.still, still)):
            for _ in range(count):
                places.add(inner.pop(self.below(len(inner))))
        last = next(road for road in self.map.roads if road.head == END)
        others = [road for road in self.map.roads if road.kind is Kind.COUNTRY and road is not last]
        for number in range(bad):
            road = last if number == 0 else others.pop(self.below(len(others)))
            road.is_slippery = True

    def split(self, road: Road) -> int:
        """Put a location on a road; the road itself ends there."""
        share = 0.4 + 0.2 * self.draw.random()
        here = self.add_place(road, share, 0.3 * (self.draw.random() - 0.5))
        minutes = round(road.minutes * share)
        self.map.roads.append(Road(here, road.head, road.minutes - minutes, road.kind, self.some_side()))
        road.head, road.minutes = here, minutes
        return here

    def detour(self, road: Road) -> None:
        """Build a way round a road, by a location of its own."""
        there = self.add_place(road, 0.4 + 0.2 * self.draw.random(), 0.55 * road.side)
        minutes = round(road.minutes * (0.85 + 0.3 * self.draw.random()))
        half = round(minutes * (0.4 + 0.2 * self.draw.random()))
        self.map.roads.append(Road(road.tail, there, half, side=self.some_side()))
        self.map.roads.append(Road(there, road.head, minutes - half, side=self.some_side()))
        road.kind, road.side = Kind.SHORTCUT, -road.side
        self.detours.append((road, there))

    def highway(self) -> None:
        """Build a highway between a shortcut and its detour."""
        shortcut, there = self.detours.pop(self.below(len(self.detours)))
        minutes = round(0.4 * shortcut.minutes)
        self.map.roads.append(Road(there, self.split(shortcut), minutes, Kind.HIGHWAY))

    def side_street(self) -> None:
        """Build a road that leads nowhere else."""
        road = self.some_road(Kind.COUNTRY)
        there = self.add_place(road, 0.2, 0.2 * road.side)
        self.map.roads.append(Road(road.tail, there, round(0.3 * road.minutes), Kind.SIDE))

    def add_place(self, road: Road, along: float, aside: float) -> int:
        """Add a location beside a road: shares of its length, along it and to its left."""
        (x, y), (to_x, to_y) = self.map.places[road.tail], self.map.places[road.head]
        dx, dy = to_x - x, to_y - y
        self.map.places.append((x + along * dx - aside * dy, y + along * dy + aside * dx))
        return len(self.map.places) - 1

    def some_road(self, *kinds: Kind) -> Road:
        """Choose a road of one of the kinds, in proportion to its length."""
        roads = [road for road in self.map.roads if road.kind in kinds]
        at = self.below(sum(road.minutes for road in roads))
        for road in roads:
            at -= road.minutes
            if at < 0:
                return road
        raise AssertionError("the lengths add up to more than was drawn")

    def some_side(self) -> int:
        """Choose the left or the right."""
        return 1 - 2 * self.below(2)

    def below(self, number: int) -> int:
        """Choose a whole number from 0 up to this one."""
        return int(self.draw.random() * number)
