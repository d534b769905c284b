"""What may come of a step in any state: the transitions of the lifted problem, and runs in which chance has chosen."""

from __future__ import annotations

from collections.abc import Sequence

from statehtn.model.cost.scenario_cost import mixed
from statehtn.model.plan import Step
from statehtn.model.problem import Fact
from statehtn.semantics.actions import GroundAction, LiftedAction, ground_action
from statehtn.semantics.chances import StepOutcome
from statehtn.semantics.condition import Condition
from statehtn.semantics.history import History
from statehtn.semantics.world import World

Changes = tuple[frozenset[Fact], frozenset[Fact]]
"""What came of a step: facts that are true after it, and facts that are false; facts in neither are as before."""


class Transitions:
    """The lifted problem as a process: which steps can be executed in a state, and what may come of them.

    Args:
        world: the problem, and limits.
        seen: facts by which states are told apart; chance changes no others. None for all facts.
    """

    def __init__(self, world: World, seen: frozenset[Fact] | None = None) -> None:
        self._world = world
        self._seen = seen
        self._lifted: dict[str, LiftedAction] = {}
        self._known: dict[Step, GroundAction | str] = {}
        self._goal = Condition(world.problem.goal, world).ground({})

    def why_not(self, step: Step, facts: frozenset[Fact]) -> str | None:
        """Say why a step cannot be executed in a state; None if it can."""
        action = self._action(step)
        return action if isinstance(action, str) else action.wrong(History(facts))

    def outcomes(self, step: Step, facts: frozenset[Fact], as_stated: bool = False) -> tuple[StepOutcome, ...] | None:
        """Return what may come of a step in a state, each leading to another state; None where it cannot be executed.

        Args:
            step: the step.
            facts: the state.
            as_stated: tell outcomes apart by what they make true and false, even if it is so already: as plans do that
                count on outcomes, since the probabilities of these do not depend on what is true.

        Raises:
            InputError: a cost or a probability is none.
        """
        action, history = self._action(step), History(facts)
        if isinstance(action, str) or action.wrong(history):
            return None
        return action.outcomes(history, self._seen, as_stated)

    def is_goal(self, facts: frozenset[Fact]) -> bool:
        """Tell whether the goal formula holds in a state."""
        return self._goal.holds(History(facts).at(0))

    def why_no_goal(self, facts: frozenset[Fact]) -> str | None:
        """Say why the goal formula does not hold in a state; None if it does."""
        return None if self.is_goal(facts) else self._goal.why_false(History(facts).at(0))

    def _action(self, step: Step) -> GroundAction | str:
        if step not in self._known:
            self._known[step] = ground_action(step, self._lifted, self._world)
        return self._known[step]


def outcome_that_came(
    outcomes: Sequence[StepOutcome], came: Changes, before: set[Fact] | None, seen: frozenset[Fact] | None
) -> StepOutcome | None:
    """Return the outcome of a step that shows these changes; None if there is none.

    Several that differ in facts that are not seen become one: the state of the likeliest, and the mixture of their
    laws. Without the facts `before` the step, the changes are all that the outcome makes true and false.
    """
    added, deleted = came if before is None else (came[0] - before, came[1] & before)
    fitting = [
        outcome for outcome in outcomes if _same(outcome.added, added, seen) and _same(outcome.deleted, deleted, seen)
    ]
    if not fitting:
        return None
    likeliest = max(fitting, key=lambda outcome: outcome.probability)
    weights = [float(outcome.probability) for outcome in fitting]
    return StepOutcome(
        sum(outcome.probability for outcome in fitting),  # type: ignore[arg-type]
        likeliest.added,
        likeliest.deleted,
        mixed(weights, [outcome.law for outcome in fitting]),
    )


def _same(one: frozenset[Fact], other: frozenset[Fact], seen: frozenset[Fact] | None) -> bool:
    return one == other if seen is None else one & seen == other & seen
