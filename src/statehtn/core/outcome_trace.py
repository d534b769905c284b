"""The outcomes that a plan of the all-outcomes determinisation counts on."""

from __future__ import annotations

from collections.abc import Iterable

from statehtn.core.grounding import Grounding
from statehtn.model.plan_outcome import PlanOutcome
from statehtn.model.problem import Fact


def outcomes_of(grounding: Grounding, actions: Iterable[int]) -> tuple[PlanOutcome, ...]:
    """Return what comes of actions that are executed one after the other from the initial state.

    Args:
        grounding: the ground problem, in which each outcome of an action is one of its own.
        actions: those that a search has chosen, precondition actions included; these have no outcomes in the result.
    """
    handle = grounding.handle
    schemas, names = handle.action_schema, _names(grounding)
    state = set(handle.initial_state)
    found: list[PlanOutcome] = []
    for action in actions:
        added, deleted = set[int](), set[int]()
        for effect in range(*handle.effects(action)):
            is_due = state.issuperset(handle.effect_conditions(effect))
            if is_due and state.isdisjoint(handle.effect_negative_conditions(effect)):
                added.update(handle.effect_adds(effect))
                deleted.update(handle.effect_deletes(effect))
        state = (state - deleted) | added
        if grounding.encoding.actions[schemas[action]] is not None:
            changes = ({names[fact] for fact in facts} for facts in (added, deleted - added))
            found.append(PlanOutcome(grounding.probabilities[action], *map(frozenset, changes)))
    return tuple(found)


def _names(grounding: Grounding) -> list[Fact]:
    handle = grounding.handle
    return [
        (grounding.encoding.predicates[predicate], *grounding.objects(handle.fact_arguments(fact)))
        for fact, predicate in enumerate(handle.fact_predicate)
    ]
