"""Executes a plan step by step on the lifted model.

A long plan repeats few ground actions: what does not depend on the state is worked out once for each of them.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from statehtn.errors import UnsupportedError
from statehtn.model.cost.ground_cost import action_law, is_unconditional
from statehtn.model.cost.law import CostLaw
from statehtn.model.formula import TRUE, predicates
from statehtn.model.plan import Plan, Step
from statehtn.model.problem import Action, Effect, Fact
from statehtn.model.types import Parameter
from statehtn.semantics.condition import NOWHERE, Condition
from statehtn.semantics.formulas import Bindings
from statehtn.semantics.history import History, State
from statehtn.semantics.world import World, substitute

DueParts = tuple[tuple[int, tuple[str, ...]], ...]
"""The conditional parts of a cost that are due: (index of the block, objects of its variables)."""
NOTHING: frozenset[Fact] = frozenset()
NO_EFFECTS: tuple[frozenset[Fact], frozenset[Fact]] = (frozenset(), frozenset())


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
    lifted: dict[str, _LiftedAction] = {}
    known: dict[Step, _GroundAction | str] = {}
    costs: list[CostLaw] = []
    reasons: list[str] = []
    for step in world.limited(plan.steps):
        action = known.get(step)
        if action is None:
            action = known[step] = _ground(step, lifted, world)
        wrong = action if isinstance(action, str) else action.wrong(history)
        if wrong:
            reasons.append(f"step {history.end + 1} {step}: {wrong}")
        elif isinstance(action, _GroundAction) and not reasons:
            costs.append(action.cost(history))
        history.advance(*(NO_EFFECTS if isinstance(action, str) else action.effects(history)))
    end = history.at(history.end)
    goal = Condition(problem.goal, world).ground({})
    if not goal.holds(end):
        reasons.append(f"the goal does not hold in the end: {goal.why_false(end)}")
    return Execution(history, tuple(costs), tuple(reasons))


def _ground(step: Step, lifted: dict[str, _LiftedAction], world: World) -> _GroundAction | str:
    """Return the action of a step; if there is no such action, say why."""
    if step.action not in lifted:
        action = world.problem.domain.actions.get(step.action)
        if action is None:
            return f"there is no action '{step.action}'"
        lifted[step.action] = _LiftedAction(action, world)
    parameters = lifted[step.action].action.parameters
    if len(step.arguments) != len(parameters):
        return f"expected {len(parameters)} arguments, found {len(step.arguments)}"
    return _GroundAction(lifted[step.action], step)


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


class _LiftedAction:
    """An action with its formulas compiled."""

    def __init__(self, action: Action, world: World) -> None:
        for block in action.outcomes:
            raise UnsupportedError(
                f"action '{action.name}' changes facts by chance, which plans cannot answer", block.place
            )
        self.action = action
        self.world = world
        self.precondition = Condition(action.precondition, world)
        self.effects = [(effect, Condition(effect.condition, world)) for effect in action.effects]
        self.costs = [
            (index, block, Condition(block.condition, world))
            for index, block in enumerate(action.costs)
            if not is_unconditional(block)
        ]
        read = {name for _, block, _ in self.costs for name in predicates(block.condition)}
        self.hidden = [
            frozenset(fact for fact in scenario.facts if fact[0] in read) for scenario in world.problem.scenarios
        ] or [NOTHING]
        """For each scenario what the costs read of it; once nothing where there are none."""


class _GroundAction:
    """An action with objects for its parameters, and what it does in any state."""

    def __init__(self, lifted: _LiftedAction, step: Step) -> None:
        action = lifted.action
        self._lifted = lifted
        self._step = step
        self._bindings = {p.name: name for p, name in zip(action.parameters, step.arguments, strict=True)}
        self.wrong_arguments = wrong_arguments(action.parameters, step.arguments, lifted.world)
        self.precondition = lifted.precondition.ground(self._bindings)
        self._costs: dict[tuple[DueParts, ...], CostLaw] = {}
        certain = [(effect, condition) for effect, condition in lifted.effects if effect.condition == TRUE]
        added, deleted = _changes(certain, self._bindings, NOWHERE)
        self._certain = added, deleted - added
        self._conditional = [pair for pair in lifted.effects if pair not in certain]

    def wrong(self, history: History) -> str | None:
        """Say why the action cannot be executed in the last state; None if it can."""
        if self.wrong_arguments:
            return self.wrong_arguments
        if self.precondition.holds_now(history):
            return None
        return f"its precondition does not hold: {self.precondition.why_false(history.at(history.end))}"

    def effects(self, history: History) -> tuple[frozenset[Fact], frozenset[Fact]]:
        """Return the facts that it makes true in the last state, and those that it makes false."""
        if not self._conditional:
            return self._certain
        added, deleted = _changes(self._conditional, self._bindings, history.at(history.end))
        added |= self._certain[0]
        return added, (deleted | self._certain[1]) - added

    def cost(self, history: History) -> CostLaw:
        """Return the law of its cost in the last state."""
        lifted = self._lifted
        due = self._due_parts(history) if lifted.costs else ((),) * len(lifted.hidden)
        if due not in self._costs:
            self._costs[due] = action_law(lifted.action, self._step.arguments, due, lifted.world.problem)
        return self._costs[due]

    def _due_parts(self, history: History) -> tuple[DueParts, ...]:
        """Return the conditional parts of its cost that are due in the last state, in each scenario."""
        known = {hidden: self._due_in(history.at(history.end, hidden)) for hidden in set(self._lifted.hidden)}
        return tuple(known[hidden] for hidden in self._lifted.hidden)

    def _due_in(self, state: State) -> DueParts:
        return tuple(
            (index, objects)
            for index, block, condition in self._lifted.costs
            for objects in sorted(
                tuple(extended[parameter.name] for parameter in block.parameters)
                for extended in condition.solutions(block.parameters, self._bindings, state)
            )
        )


def _changes(
    effects: Sequence[tuple[Effect, Condition]], bindings: Bindings, state: State
) -> tuple[frozenset[Fact], frozenset[Fact]]:
    """Return the facts that effects make true and false; conditions are those of the state before."""
    added: set[Fact] = set()
    deleted: set[Fact] = set()
    for effect, condition in effects:
        changed = added if effect.positive else deleted
        for extended in condition.solutions(effect.parameters, bindings, state):
            changed.add((effect.atom.predicate, *substitute(effect.atom.arguments, extended)))
    return frozenset(added), frozenset(deleted)
