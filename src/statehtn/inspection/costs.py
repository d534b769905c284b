"""Costs that are missing, of an action among actions with costs; values of functions that are missing, or none."""

from __future__ import annotations

from collections.abc import Iterator

from statehtn.expected import shown_number
from statehtn.inspection.finding import Finding, Level
from statehtn.inspection.names import functions_in
from statehtn.inspection.subject import Subject
from statehtn.model.cost.blocks import FunctionTerm


def check_costs(subject: Subject) -> Iterator[Finding]:
    """Yield the actions without a cost where others have one, and the functions whose values in a problem are none."""
    actions = subject.domain.actions.values()
    priced = [action for action in actions if action.all_costs]
    for action in actions if priced else ():
        if not action.all_costs:
            message = f"action '{action.name}' has no cost, and others do ('{priced[0].name}', say): it costs 0"
            advice = "add (increase (total-cost) ...) to its effect; (increase (total-cost) 0) if it costs nothing"
            place = subject.places.declared("task", action.name)
            yield Finding(Level.WARNING, place, message, advice, "no-cost", ("action", action.name))
    if subject.problem is not None:
        yield from _without_values(subject)
        yield from _no_probabilities(subject)


def _without_values(subject: Subject) -> Iterator[Finding]:
    """Yield the functions without any value that a cost or a probability needs; of others grounding tells."""
    assert subject.problem is not None
    given = {key[0] for key in subject.problem.function_values}
    users = {
        name: action.name
        for action in subject.domain.actions.values()
        for expression in action.expressions
        for name in functions_in(expression)
    }
    for name, user in users.items():
        if name not in given:
            message = f"':init' gives no value of function '{name}', which action '{user}' needs"
            place = subject.places.declared("function", name)
            advice = f"write (= ({name} ...) <number>) in ':init' for the objects that need it"
            yield Finding(Level.NOTE, place, message, advice, "no-value", ("function", name))


def _no_probabilities(subject: Subject) -> Iterator[Finding]:
    """Yield the values of functions that actions take for probabilities and that are none."""
    assert subject.problem is not None
    users = {
        expression.function: action.name
        for action in subject.domain.actions.values()
        for expression in action.probabilities
        if isinstance(expression, FunctionTerm)
    }
    for (name, *arguments), value in subject.problem.function_values.items():
        if name in users and not 0 <= value <= 1:
            term = " ".join((name, *arguments))
            message = f"':init' gives ({term}) the value {shown_number(value)}, a probability in action '{users[name]}'"
            place = subject.places.declared("function", name)
            advice = "probabilities are numbers from 0 to 1"
            yield Finding(Level.WARNING, place, message, advice, "probabilities", ("function", name))
