"""What is worked out once for each law, where few laws are those of many."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import TypeVar

from statehtn.model.cost.law import CostLaw

Value = TypeVar("Value")


def by_law(laws: Iterable[CostLaw], value_of: Callable[[CostLaw], Value]) -> list[Value]:
    """Return what `value_of` says of each law; it is asked once for each object."""
    known: dict[int, Value] = {}
    found: list[Value] = []
    for law in laws:
        if id(law) not in known:
            known[id(law)] = value_of(law)
        found.append(known[id(law)])
    return found
