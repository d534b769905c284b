"""What an action costs at least, whatever the state is: costs that are shifted from its parts to itself.

Source: Schiex, "Arc consistency for soft constraints" (CP 2000), for weighted constraint satisfaction in general.
"""

from __future__ import annotations

from collections.abc import Sequence

from statehtn.model.cost.law import CostLaw
from statehtn.model.ground import GroundCostPart
from statehtn.risk.utility import Utility

Literals = tuple[tuple[int, bool], ...]
MOST_ALTERNATIVES = 200  # of all conditions of an action; with more of them nothing is shifted


def shifted_prices(law: CostLaw, parts: Sequence[GroundCostPart], utility: Utility) -> tuple[float, list[float]]:
    """Return a price for an action and one for each of its cost parts, by which it costs no more in any state.

    Where one of several parts is due in every state, as with a condition and its negation, the least of their prices is
    taken off all of them and added to the action's own. That is therefore a lower bound of its risk cost. If exactly
    one of them is always due, nothing is lost.

    Args:
        law: of what is due in every state.
        parts: of the action's cost.
        utility: the agent's.
    """
    own = utility.risk_cost(law)
    prices = [utility.risk_cost(part.cost) for part in parts]
    for group in _unrelated_groups(parts):
        while cover := _cover([number for number in group if prices[number] > 0], parts):
            least = min(prices[number] for number in cover)
            own += least
            for number in cover:
                prices[number] -= least
    return own, prices


def _unrelated_groups(parts: Sequence[GroundCostPart]) -> list[list[int]]:
    """Return the parts in groups that have no fact in common, each in order."""
    groups: dict[int, tuple[list[int], set[int]]] = {}  # by the number of the latest part: parts, and their facts
    group_of: dict[int, int] = {}  # by fact
    for number, part in enumerate(parts):
        members, facts = [number], {fact for true, false in part.alternatives for fact in true | false}
        for known in {group_of[fact] for fact in facts if fact in group_of}:
            more_members, more_facts = groups.pop(known)
            members += more_members
            facts |= more_facts
        groups[number] = (sorted(members), facts)
        group_of.update(dict.fromkeys(facts, number))
    return [members for members, _ in groups.values()]


def _cover(priced: list[int], parts: Sequence[GroundCostPart]) -> list[int]:
    """Return a minimal choice of the priced parts of which one is due in every state; empty if there is none."""

    def are_avoidable(chosen: Sequence[int]) -> bool:
        alternatives = [
            (*((fact, True) for fact in true), *((fact, False) for fact in false))
            for number in chosen
            for true, false in parts[number].alternatives
        ]
        return _can_avoid(alternatives, {})

    if are_avoidable(priced):
        return []
    cover = priced[: next(count for count in range(1, len(priced) + 1) if not are_avoidable(priced[:count]))]
    for number in reversed(cover):
        if not are_avoidable(fewer := [other for other in cover if other != number]):
            cover = fewer
    return cover


def _can_avoid(alternatives: Sequence[Literals], values: dict[int, bool]) -> bool:
    """Tell whether facts can have values such that every alternative has a wrong literal, beside those they have."""
    if not alternatives or len(alternatives) > MOST_ALTERNATIVES:
        return True
    first, *rest = alternatives
    return any(
        values.get(fact, not value) != value and _can_avoid(rest, {**values, fact: not value}) for fact, value in first
    )
