"""By what plans are told apart: numbers of the actions that the domain knows."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import statehtn._relax as _relax
from statehtn.core.grounding import Grounding

Key = tuple[int, ...]
"""What no two plans have in common: their actions, in the order of their execution or sorted."""


def action_names(grounding: Grounding) -> list[int | None]:
    """Return a number for every ground action, the same for the cases of one action; None for a precondition action."""
    numbers: dict[tuple[int, tuple[int, ...]], int] = {}
    handle = grounding.handle
    return [
        None
        if grounding.encoding.actions[schema] is None
        else numbers.setdefault((schema, tuple(handle.action_arguments(action))), len(numbers))
        for action, schema in enumerate(handle.action_schema)
    ]


def key_of(actions: Iterable[int], names: Sequence[int | None], distinct: _relax.Distinct) -> Key:
    """Return what no two plans have in common, from the actions of one and all names."""
    own = [name for action in actions if (name := names[action]) is not None]
    return tuple(own if distinct == _relax.Distinct.Sequence else sorted(own))
