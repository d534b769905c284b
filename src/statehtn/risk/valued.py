"""The value of a total cost; where it has none, which of the costs that add up to it is to blame."""

from __future__ import annotations

from collections.abc import Callable, Iterable

from statehtn.errors import InputError
from statehtn.model.cost.law import CostLaw
from statehtn.risk.objective import Objective


def value_of_total(objective: Objective, total: CostLaw, parts: Iterable[tuple[CostLaw, Callable[[], str]]]) -> float:
    """Return what a total cost is worth by an objective.

    Args:
        objective: the objective.
        total: the law of the sum.
        parts: the laws of what adds up to it, and what each is the cost of.

    Raises:
        InputError: it is worth nothing finite, or that cannot be computed; the message names the first part that is
            worth nothing finite by itself.
    """
    try:
        return objective.value(total)
    except InputError:
        for law, name in parts:
            if (reason := _reason(objective, law)) is not None:
                raise InputError(f"the cost of {name()}: {reason}") from None
        raise


def _reason(objective: Objective, law: CostLaw) -> str | None:
    """Return why a cost is worth nothing finite; None if it is."""
    try:
        objective.value(law)
    except InputError as error:
        return error.message
    return None
