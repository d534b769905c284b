"""Plans that do not say which outcomes they count on: the validator finds the best run, whatever the planner says."""

from __future__ import annotations

import math
import random
from fractions import Fraction

import pytest
from hypothesis import given
from hypothesis import strategies as st

import statehtn
from statehtn.explanation import WhyNot
from statehtn.model import TRUE, Problem, Step
from statehtn.model.status import Status
from statehtn.semantics.world import World
from statehtn.validation.trajectories import Trajectories, likeliest
from tests.brute_force import GaveUp
from tests.naive_outcomes import ways
from tests.naive_semantics import Semantics, State
from tests.random_outcomes import chance_problems, wide_problems

OBJECTIVE = "success-utility alpha=0.3"
MOST_STEPS = 4


@given(st.one_of(chance_problems(), wide_problems()))
def test_a_plan_that_was_written_and_read_is_worth_the_same(problem: Problem) -> None:
    result = statehtn.plan(problem, objective=OBJECTIVE, time_limit=2)
    if result.plan is None or result.status is not Status.OPTIMAL:
        if result.status is Status.UNSOLVABLE:
            return
        raise GaveUp
    assert result.value is not None
    probability = 1.0
    for step in result.steps:
        probability *= step.probability
    given_steps = list(result.plan.steps)
    read = statehtn.read_plan(statehtn.write_plan(result.plan, problem), problem)
    for plan in (result.plan, read, given_steps):
        assert statehtn.validate(problem, plan).valid
        answer = statehtn.why(problem, plan, objective=OBJECTIVE, time_limit=5)
        assert isinstance(answer, WhyNot)
        assert answer.given is not None
        value = answer.given.value
        if is_plain(problem):
            assert value == pytest.approx(result.value, rel=1e-9, abs=1e-9)
        else:  # outcomes under conditions that come to the same in the state count together, which no search knows
            assert value <= result.value + 1e-9
    assert statehtn.validate(problem, result.plan).probability == pytest.approx(probability)


@given(st.one_of(chance_problems(), wide_problems()), st.randoms(use_true_random=False))
def test_runs_come_in_the_order_of_their_prices(problem: Problem, generator: random.Random) -> None:
    semantics = Semantics(problem)
    names = [Step(name) for name, action in problem.domain.actions.items() if not action.parameters]
    steps = [generator.choice(names) for _ in range(generator.randrange(1, MOST_STEPS))] if names else []
    expected = sorted((p for p, _ in runs(semantics, problem.initial_state, steps)), reverse=True)
    found = Trajectories(steps, World(problem), None, likeliest, is_first_alone=False)
    probabilities = [math.prod(outcome.probability for outcome in run) for run in found]
    assert sorted(probabilities, reverse=True) == expected
    assert [float(one) for one in probabilities] == pytest.approx([float(one) for one in expected])
    alone = list(Trajectories(steps, World(problem), None, likeliest, is_first_alone=True))
    assert [math.prod(outcome.probability for outcome in run) for run in alone] == expected[:1]
    assert expected or found.why_not


def is_plain(problem: Problem) -> bool:
    """Tell whether what outcomes change does not depend on the state."""
    blocks = [block for action in problem.domain.actions.values() for block in action.outcomes]
    effects = [effect for block in blocks for outcome in block.outcomes for effect in outcome.effects]
    return all(block.condition == TRUE for block in blocks) and all(effect.condition == TRUE for effect in effects)


def runs(semantics: Semantics, state: State, steps: list[Step]) -> list[tuple[Fraction, State]]:
    """Return the ways in which all steps can be executed and the goal holds in the end.

    Ways are told apart by what a step makes true and false, even if it is so already.
    """
    if not steps:
        return [(Fraction(1), state)] if semantics.holds(semantics.problem.goal, {}, state) else []
    chances: dict[tuple[State, State], Fraction] = {}
    for way in ways(semantics, steps[0].action, steps[0].arguments, state) or ():
        changes = way.added, way.deleted - way.added
        chances[changes] = chances.get(changes, Fraction(0)) + way.probability
    return [
        (chance * more, end)
        for (added, deleted), chance in chances.items()
        for more, end in runs(semantics, state - deleted | added, steps[1:])
    ]
