"""Executes a plan step by step on the lifted model.

A long plan repeats few ground actions: what does not depend on the state is worked out once for each of them.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction

from statehtn.errors import UnsupportedError
from statehtn.model.cost.law import CostLaw
from statehtn.model.plan import Plan, Step
from statehtn.model.problem import Fact
from statehtn.semantics.actions import GroundAction, LiftedAction, ground_action
from statehtn.semantics.chances import StepOutcome
from statehtn.semantics.condition import Condition
from statehtn.semantics.history import History
from statehtn.semantics.outcomes import Changes, outcome_that_came
from statehtn.semantics.world import World

NO_EFFECTS: tuple[frozenset[Fact], frozenset[Fact]] = (frozenset(), frozenset())
CERTAIN = Fraction(1)


@dataclass(frozen=True, slots=True)
class Execution:
    """The states of a plan's run, the costs of its steps, how likely what came of each was, and what is wrong."""

    history: History
    costs: tuple[CostLaw, ...]
    probabilities: tuple[Fraction, ...]
    reasons: tuple[str, ...]


def execute(
    plan: Plan,
    world: World,
    came: Sequence[Changes] | None = None,
    seen: frozenset[Fact] | None = None,
    as_stated: bool = False,
) -> Execution:
    """Run a plan from the initial state and test the goal at its end.

    A step that cannot be executed is reported, and the run goes on with its effects as if it could (without them where
    it is no action at all), so that later mistakes are found as well.

    Args:
        plan: the plan, or the actions of a run in which chance has chosen.
        world: the problem, and limits.
        came: what came of each step, where some have several outcomes.
        seen: facts by which outcomes are told apart; None for all facts.
        as_stated: `came` is all that outcomes make true and false, even if it is so already.

    Raises:
        UnsupportedError: a step has several outcomes, and what came of it is not given.
    """
    history = History(world.problem.initial_state)
    lifted: dict[str, LiftedAction] = {}
    known: dict[Step, GroundAction | str] = {}
    costs: list[CostLaw] = []
    probabilities: list[Fraction] = []
    reasons: list[str] = []
    for number, step in enumerate(world.limited(plan.steps)):
        action = known.get(step)
        if action is None:
            action = known[step] = ground_action(step, lifted, world)
        wrong = action if isinstance(action, str) else action.wrong(history)
        changes = NO_EFFECTS if isinstance(action, str) else action.effects(history)
        if not wrong and isinstance(action, GroundAction) and action.has_outcomes:
            outcome = _outcome(step, action, history, None if came is None else came[number], seen, as_stated)
            if outcome is None:
                wrong = "what came of it is none of its outcomes"
            else:
                changes = outcome.added, outcome.deleted
                if not reasons:
                    costs.append(outcome.law)
                    probabilities.append(outcome.probability)
        elif not wrong and isinstance(action, GroundAction) and not reasons:
            costs.append(action.cost(history))
            probabilities.append(CERTAIN)
        if wrong:
            reasons.append(f"step {history.end + 1} {step}: {wrong}")
        history.advance(*changes)
    end = history.at(history.end)
    goal = Condition(world.problem.goal, world).ground({})
    if not goal.holds(end):
        reasons.append(f"the goal does not hold in the end: {goal.why_false(end)}")
    return Execution(history, tuple(costs), tuple(probabilities), tuple(reasons))


def _outcome(
    step: Step,
    action: GroundAction,
    history: History,
    came: Changes | None,
    seen: frozenset[Fact] | None,
    as_stated: bool,
) -> StepOutcome | None:
    """Return the outcome of a step that came; None if what came is none of them."""
    outcomes = action.outcomes(history, seen, as_stated)
    if came is not None:
        return outcome_that_came(outcomes, came, None if as_stated else history.now, seen)
    if len(outcomes) > 1:
        raise UnsupportedError(
            f"step {history.end + 1} {step} has {len(outcomes)} outcomes here, and a plan does not say which one came"
        )
    return outcomes[0]
