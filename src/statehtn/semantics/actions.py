"""What a ground action does in a state: whether it can be executed, its effects, its outcomes, and what it costs.

What does not depend on the state is worked out once.
"""

from __future__ import annotations

from fractions import Fraction

from statehtn.counted import with_article
from statehtn.model.cost.ground_cost import action_law, is_unconditional
from statehtn.model.cost.law import CostLaw
from statehtn.model.formula import TRUE, predicates
from statehtn.model.plan import Step
from statehtn.model.problem import Action, Fact
from statehtn.model.types import Parameter
from statehtn.semantics.chances import Chosen, LiftedBlock, StepOutcome, combined, merged
from statehtn.semantics.condition import NOWHERE, Condition
from statehtn.semantics.due import DueParts, changes_of, due_parts
from statehtn.semantics.history import History, State
from statehtn.semantics.world import World

NOTHING: frozenset[Fact] = frozenset()


def ground_action(step: Step, lifted: dict[str, LiftedAction], world: World) -> GroundAction | str:
    """Return the action of a step; if there is no such action, say why.

    Args:
        lifted: actions whose formulas are compiled; those that are not yet are added.
    """
    if step.action not in lifted:
        action = world.problem.domain.actions.get(step.action)
        if action is None:
            return f"there is no action '{step.action}'"
        lifted[step.action] = LiftedAction(action, world)
    parameters = lifted[step.action].action.parameters
    if len(step.arguments) != len(parameters):
        return f"expected {len(parameters)} arguments, found {len(step.arguments)}"
    return GroundAction(lifted[step.action], step)


def wrong_arguments(parameters: tuple[Parameter, ...], arguments: tuple[str, ...], world: World) -> str | None:
    """Say why objects do not fit typed parameters; None if they do."""
    if len(arguments) != len(parameters):
        return f"expected {len(parameters)} arguments, found {len(arguments)}"
    for parameter, name in zip(parameters, arguments, strict=True):
        if name not in world.problem.all_objects:
            return f"there is no object '{name}'"
        if not world.is_of_type(name, parameter.types):
            return f"'{name}' is {with_article(world.problem.all_objects[name])}, expected {parameter}"
    return None


class LiftedAction:
    """An action with its formulas compiled."""

    def __init__(self, action: Action, world: World) -> None:
        self.action = action
        self.world = world
        self.precondition = Condition(action.precondition, world)
        self.effects = [(effect, Condition(effect.condition, world)) for effect in action.effects]
        self.costs = [
            (index, block, Condition(block.condition, world))
            for index, block in enumerate(action.costs)
            if not is_unconditional(block)
        ]
        self.blocks = tuple(LiftedBlock.all(action, world))
        read = {name for block in action.all_costs for name in predicates(block.condition)}
        self.hidden = [
            frozenset(fact for fact in scenario.facts if fact[0] in read) for scenario in world.problem.scenarios
        ] or [NOTHING]
        """For each scenario what the costs read of it; once nothing where there are none."""


class GroundAction:
    """An action with objects for its parameters, and what it does in any state."""

    def __init__(self, lifted: LiftedAction, step: Step) -> None:
        action = lifted.action
        self._lifted = lifted
        self._step = step
        self._bindings = {p.name: name for p, name in zip(action.parameters, step.arguments, strict=True)}
        self.has_outcomes = bool(action.outcomes)
        self.wrong_arguments = wrong_arguments(action.parameters, step.arguments, lifted.world)
        self.precondition = lifted.precondition.ground(self._bindings)
        self._costs: dict[tuple[DueParts, ...], CostLaw] = {}
        certain = [(effect, condition) for effect, condition in lifted.effects if effect.condition == TRUE]
        added, deleted = changes_of(certain, self._bindings, NOWHERE)
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
        added, deleted = changes_of(self._conditional, self._bindings, history.at(history.end))
        added |= self._certain[0]
        return added, (deleted | self._certain[1]) - added

    def cost(self, history: History) -> CostLaw:
        """Return the law of its cost in the last state; of an action without outcomes."""
        return self._law(self._due_parts(history))

    def outcomes(
        self, history: History, seen: frozenset[Fact] | None = None, as_stated: bool = False
    ) -> tuple[StepOutcome, ...]:
        """Return what may come of it in the last state: outcomes of which each leads to another state, with their laws.

        Args:
            history: the states so far.
            seen: facts by which states are told apart; chance changes no others. None for all facts.
            as_stated: tell outcomes apart by what they make true and false, even if it is so already.
        """
        added, deleted = self.effects(history)
        due = self._due_parts(history)
        if not self.has_outcomes:
            changes = (added, deleted) if as_stated else (added - history.now, deleted & history.now)
            return (StepOutcome(Fraction(1), *changes, self._law(due)),)
        state = history.at(history.end)
        hidden = [history.at(history.end, facts) for facts in self._lifted.hidden]
        certain = Chosen(added, deleted, due)
        instances = (
            block.branches(self._step.arguments, bindings, state, hidden, seen)
            for block in self._lifted.blocks
            for bindings in block.bindings(self._bindings, state)
        )
        before = None if as_stated else history.now
        return merged(combined(certain, instances, self._lifted.world), before, self._law)

    def _law(self, due: tuple[DueParts, ...]) -> CostLaw:
        if due not in self._costs:
            lifted = self._lifted
            self._costs[due] = action_law(lifted.action, self._step.arguments, due, lifted.world.problem)
        return self._costs[due]

    def _due_parts(self, history: History) -> tuple[DueParts, ...]:
        """Return the conditional parts of its cost that are due in the last state, in each scenario."""
        if not self._lifted.costs:
            return ((),) * len(self._lifted.hidden)
        known = {hidden: self._due_in(history.at(history.end, hidden)) for hidden in set(self._lifted.hidden)}
        return tuple(known[hidden] for hidden in self._lifted.hidden)

    def _due_in(self, state: State) -> DueParts:
        return due_parts(self._lifted.costs, self._bindings, state)
