"""Orderings that say nothing: they follow from others of the same network."""

from __future__ import annotations

from collections.abc import Iterator

from statehtn.inspection.finding import Finding, Level
from statehtn.inspection.subject import Subject, networks
from statehtn.model import TaskNetwork


def check_orderings(subject: Subject) -> Iterator[Finding]:
    """Yield a note for every network with orderings that follow from others."""
    for method, network in networks(subject):
        redundant = redundant_orderings(network)
        if not redundant:
            continue
        before, after = (network.subtasks[index].label for index in redundant[0])
        others = f", and {len(redundant) - 1} more of them" if len(redundant) > 1 else ""
        message = f"the ordering (< {before} {after}) follows from the others{others}"
        pattern = ((":ordering",), ("<", before, after))
        if method is None:
            place = subject.places.in_section(":htn", *pattern)
            about = None
        else:
            place = subject.places.inside("method", method.name, *pattern)
            about = ("method", method.name)
        yield Finding(Level.NOTE, place, message, "it may be left out", "redundant-ordering", about)


def redundant_orderings(network: TaskNetwork) -> list[tuple[int, int]]:
    """Return the pairs of a network's ordering that are a path of other pairs, too."""
    after: dict[int, set[int]] = {index: set() for index in range(len(network.subtasks))}
    for first, second in network.ordering:
        after[first].add(second)
    beyond: dict[int, set[int]] = {}
    for index in reversed(network.topological_order()):
        beyond[index] = after[index].union(*(beyond[following] for following in after[index]))
    return [
        (first, second)
        for first, second in network.ordering
        if any(second in beyond[middle] for middle in after[first] if middle != second)
    ]
