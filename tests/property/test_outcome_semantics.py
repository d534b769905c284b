"""What may come of steps, as the validator sees it, against the plainest reading of the same actions."""

from __future__ import annotations

import random
from fractions import Fraction
from itertools import product

import pytest
from hypothesis import given
from hypothesis import strategies as st

from statehtn.model import Action, CostDistribution, CostLaw, Decomposition, Plan, Problem, Step
from statehtn.model.cost.sum import total_cost
from statehtn.semantics.execution import execute
from statehtn.semantics.outcomes import Changes, Transitions
from statehtn.semantics.world import World
from tests.naive_outcomes import Way, ways
from tests.naive_semantics import Semantics, State
from tests.random_outcomes import wide_problems

MOST_STEPS = 6


@given(wide_problems(), st.randoms(use_true_random=False))
def test_outcomes_are_those_of_the_plainest_reading(problem: Problem, generator: random.Random) -> None:
    transitions, semantics = Transitions(World(problem)), Semantics(problem)
    state: State = problem.initial_state
    steps: list[Step] = []
    came: list[Changes] = []
    for _ in range(MOST_STEPS):
        successors = []
        for step in steps_of(problem):
            expected = ways(semantics, step.action, step.arguments, state)
            found = transitions.outcomes(step, state)
            assert (found is None) == (expected is None) == (transitions.why_not(step, state) is not None)
            if found is None or expected is None:
                continue
            assert sum(outcome.probability for outcome in found) == 1
            by_state = {outcome.after(state): (outcome.probability, costs(outcome.law)) for outcome in found}
            assert len(by_state) == len(found)
            wanted = joined(expected, state)
            assert {after: probability for after, (probability, _) in by_state.items()} == {
                after: probability for after, (probability, _) in wanted.items()
            }
            for after, (_, law) in by_state.items():
                assert law == pytest.approx(wanted[after][1])
            successors += [(step, outcome) for outcome in found]
        if not successors:
            break
        step, outcome = generator.choice(successors)
        steps.append(step)
        came.append((outcome.added, outcome.deleted))
        state = outcome.after(state)
    execution = execute(Plan(tuple(steps), (Decomposition("t", (), "m"),)), World(problem), came)
    assert execution.history.now == state
    assert not [reason for reason in execution.reasons if reason.startswith("step")]
    assert len(execution.costs) == len(steps)


def steps_of(problem: Problem) -> list[Step]:
    """Return the ground actions of a problem, executable or not."""
    return [step for action in problem.domain.actions.values() for step in instances(action, problem)]


def instances(action: Action, problem: Problem) -> list[Step]:
    """Return the instances of an action with objects of the right types."""
    choices = [problem.objects_of(parameter.types) for parameter in action.parameters]
    return [Step(action.name, arguments) for arguments in product(*choices)]


def costs(law: CostLaw) -> dict[float, float]:
    """Return the outcomes of a law by what they cost."""
    total = law if isinstance(law, CostDistribution) else total_cost((law,))
    assert isinstance(total, CostDistribution)
    return {cost: probability for probability, cost in total.outcomes}


def joined(expected: list[Way], state: State) -> dict[State, tuple[Fraction, dict[float, float]]]:
    """Return by the state after it how likely it is, and the probabilities of costs given that it comes."""
    found: dict[State, dict[Fraction, Fraction]] = {}
    for way in expected:
        laws = found.setdefault(way.state(state), {})
        for cost, probability in way.law.items():
            laws[cost] = laws.get(cost, Fraction(0)) + way.probability * probability
    return {
        after: (total, {float(cost): float(weight / total) for cost, weight in laws.items() if weight})
        for after, laws in found.items()
        if (total := sum(laws.values(), Fraction(0)))
    }
