"""By what plans are told apart: numbers of the actions that the domain knows."""

from __future__ import annotations

from statehtn.core.grounding import Grounding


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
