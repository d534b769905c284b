"""Cycles in hierarchies and orderings."""

from __future__ import annotations

from collections.abc import Hashable, Mapping, Sequence
from graphlib import CycleError, TopologicalSorter
from typing import TypeVar

T = TypeVar("T", bound=Hashable)


def find_cycle(successors: Mapping[T, Sequence[T]]) -> list[T]:
    """Return nodes that each have the next one as a successor, the last being the first again; [] without a cycle."""
    try:
        TopologicalSorter(successors).prepare()
    except CycleError as error:
        cycle: list[T] = error.args[1]
        return cycle[::-1]  # the sorter takes successors for predecessors
    return []
