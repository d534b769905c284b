"""Executes a plan step by step on the lifted model."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from statehtn.model.cost_law import action_law, is_unconditional
from statehtn.model.law import CostLaw
from statehtn.model.plan import Plan, Step
from statehtn.model.problem import Action, Fact
from statehtn.model.types import Parameter
from statehtn.validate.formulas import Bindings, holds, solutions, why_false
from statehtn.validate.world import History, State, World, substitute


@dataclass(frozen=True, slots=True)
class Execution:
    """The states of a plan's run, the costs of its steps and what is wrong with it."""

    history: History
    costs: tuple[CostLaw, ...]
    reasons: tuple[str, ...]


def execute(plan: Plan, world: World) -> Execution:
    """Run a plan from the initial state and test the goal at its end.

    A step that cannot be executed is reported, and the run goes on with its effects as if it could (without them where
    it is no action at all), so that later mistakes are found as well.
    """
    problem = world.problem
    history = History(problem.initial_state)
    costs: list[CostLaw] = []
    reasons: list[str] = []
    for step in plan.steps:
        action = problem.domain.actions.get(step.action)
        state = history.at(history.end)
        wrong = _wrong(step, action, state, world)
        if wrong:
            reasons.append(f"step {history.end + 1} {step}: {wrong}")
        elif action is not None and not reasons:
            costs.append(_law(action, step, state, world))
        if action is not None and len(step.arguments) == len(action.parameters):
            effects = list(_effects(action, bindings_of(action, step), state, world))
            history.advance(
                (fact for fact, positive in effects if positive), (fact for fact, positive in effects if not positive)
            )
        else:
            history.advance((), ())
    end = history.at(history.end)
    if not holds(problem.goal, {}, end, world):
        reasons.append(f"the goal does not hold in the end: {why_false(problem.goal, {}, end, world)}")
    return Execution(history, tuple(costs), tuple(reasons))


def wrong_arguments(parameters: tuple[Parameter, ...], arguments: tuple[str, ...], world: World) -> str | None:
    """Say why objects do not fit typed parameters; None if they do."""
    if len(arguments) != len(parameters):
        return f"expected {len(parameters)} arguments, found {len(arguments)}"
    for parameter, name in zip(parameters, arguments, strict=True):
        if name not in world.problem.all_objects:
            return f"there is no object '{name}'"
        if not world.is_of_type(name, parameter.types):
            return f"'{name}' is a {world.problem.all_objects[name]}, expected {parameter}"
    return None


def bindings_of(action: Action, step: Step) -> Bindings:
    """Return the objects of an action's parameters in a step."""
    return {parameter.name: name for parameter, name in zip(action.parameters, step.arguments, strict=True)}


def _wrong(step: Step, action: Action | None, state: State, world: World) -> str | None:
    if action is None:
        return f"there is no action '{step.action}'"
    wrong = wrong_arguments(action.parameters, step.arguments, world)
    if wrong:
        return wrong
    bindings = bindings_of(action, step)
    if not holds(action.precondition, bindings, state, world):
        return f"its precondition does not hold: {why_false(action.precondition, bindings, state, world)}"
    return None


def _effects(action: Action, bindings: Bindings, state: State, world: World) -> Iterator[tuple[Fact, bool]]:
    """Yield the facts that become true (True) and false (False); conditions are those of the state before."""
    for effect in action.effects:
        for extended in solutions(effect.condition, effect.parameters, bindings, state, world):
            yield (effect.atom.predicate, *substitute(effect.atom.arguments, extended)), effect.positive


def _law(action: Action, step: Step, state: State, world: World) -> CostLaw:
    bindings = bindings_of(action, step)
    parts = [
        (index, tuple(extended[parameter.name] for parameter in block.parameters))
        for index, block in enumerate(action.costs)
        if not is_unconditional(block)
        for extended in solutions(block.condition, block.parameters, bindings, state, world)
    ]
    domain = world.problem.domain
    return action_law(action, step.arguments, parts, world.problem.function_values, domain.has_unit_costs)
