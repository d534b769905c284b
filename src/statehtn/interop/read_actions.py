"""Actions of unified-planning (UP), and the metric as their costs."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from fractions import Fraction
from typing import Any

from statehtn.errors import UnsupportedError
from statehtn.interop.names import Vocabulary
from statehtn.interop.read_formulas import Scope, conjunction
from statehtn.model import Action, Arithmetic, Atom, CostBlock, Effect, Expression, Formula, FunctionTerm, Not, Number

FREE = (CostBlock(((Number(Fraction(1)), Number(Fraction(0))),)),)


def read_actions(problem: Any, vocabulary: Vocabulary, named: set[str]) -> dict[str, Action]:
    """Return the actions by name.

    Args:
        named: the objects that actions name are added.

    Raises:
        UnsupportedError: an action takes time or changes numbers, or the metric is none of action costs or plan length.
    """
    static = {fluent.name for fluent in problem.get_static_fluents()}
    found = {}
    for action in problem.actions:
        if type(action).__name__ != "InstantaneousAction" or action.simulated_effect is not None:
            raise UnsupportedError(
                f"action '{action.name}' is not an instantaneous action with effects that are written"
            )
        scope = Scope.of(vocabulary, action.parameters, named)
        name = vocabulary.tasks.ours(action.name)
        cost = _cost(action, problem, scope)
        for function in _functions(cost) if cost is not None else ():
            if vocabulary.fluents.theirs(function) not in static:
                raise UnsupportedError(f"the cost of action '{action.name}' reads '{function}', which actions change")
        found[name] = Action(
            name,
            scope.parameters("parameter", action.parameters),
            conjunction(map(scope.formula, action.preconditions)),
            tuple(read for effect in action.effects for read in _effects(effect, scope)),
            () if cost is None else (CostBlock(((Number(Fraction(1)), cost),)),),
        )
    metrics = problem.quality_metrics
    if metrics and metrics[0].is_minimize_action_costs() and not any(action.costs for action in found.values()):
        return {name: replace(action, costs=FREE) for name, action in found.items()}  # without any cost they cost 1
    return found


def _cost(action: Any, problem: Any, scope: Scope) -> Expression | None:
    """Return the action's cost in the metric; None where it has none, or all actions cost 1."""
    metrics = problem.quality_metrics
    if not metrics or (len(metrics) == 1 and metrics[0].is_minimize_sequential_plan_length()):
        return None
    if len(metrics) > 1 or not metrics[0].is_minimize_action_costs():
        shown = ", ".join(type(metric).__name__ for metric in metrics)
        raise UnsupportedError(f"the metric is MinimizeActionCosts or MinimizeSequentialPlanLength, found {shown}")
    cost = metrics[0].costs.get(action)
    default = metrics[0].default
    if cost is None and (default is None or (default.is_int_constant() and default.constant_value() == 0)):
        return None
    return scope.cost(default if cost is None else cost)


def _functions(cost: Expression) -> Iterator[str]:
    """Yield the functions in a cost."""
    match cost:
        case FunctionTerm(function, _):
            yield function
        case Arithmetic(_, operands):
            for operand in operands:
                yield from _functions(operand)


def _effects(effect: Any, scope: Scope) -> Iterator[Effect]:
    """Yield what an effect makes true and false; what is made true wins.

    Raises:
        UnsupportedError: it changes a number.
    """
    fluent, value = effect.fluent, effect.value
    if not effect.is_assignment() or not (fluent.type.is_bool_type() or fluent.type.is_user_type()):
        raise UnsupportedError(f"effects change facts, not numbers, found '{effect}'")
    inner = scope.extended("variable", effect.forall)
    bound = inner.parameters("variable", effect.forall)
    condition = inner.formula(effect.condition)
    predicate = scope.vocabulary.fluents.ours(fluent.fluent().name)
    terms = tuple(map(inner.term, fluent.args))
    if fluent.type.is_bool_type():
        if value.is_bool_constant():
            yield Effect(Atom(predicate, terms), value.is_true(), condition, bound)
            return
        holds: Formula = inner.formula(value)
        yield Effect(Atom(predicate, terms), True, conjunction((condition, holds)), bound)
        yield Effect(Atom(predicate, terms), False, conjunction((condition, Not(holds))), bound)
        return
    old = inner.fresh((), "old", fluent.type)
    yield Effect(Atom(predicate, (*terms, old.name)), False, condition, (*bound, old))
    (new,), values, facts = inner.terms((value,))
    yield Effect(Atom(predicate, (*terms, new)), True, conjunction((condition, *facts)), (*bound, *values))
