"""Ground actions with several outcomes against the lifted ones that they come from."""

from __future__ import annotations

import random
from fractions import Fraction

from hypothesis import assume, given
from hypothesis import strategies as st

from statehtn.core.grounding import PLAIN, Grounding, GroundingSwitches, ground
from statehtn.model import Fact, GroundProblem, Problem
from tests.grounded_graph import exact, total_of
from tests.naive_outcomes import ways
from tests.naive_semantics import Semantics, State
from tests.random_outcomes import wide_problems
from tests.strategies import grounding_switches

Outcomes = dict[tuple[frozenset[int], Fraction], Fraction]
"""Probabilities of pairs of the facts that hold afterwards and the cost."""


@given(wide_problems(), st.randoms(use_true_random=False))
def test_outcomes_mean_what_the_action_says(problem: Problem, generator: random.Random) -> None:
    grounding = ground(problem, switches=PLAIN)
    model = grounding.to_model()
    chances = list(map(exact, grounding.probabilities))
    semantics = Semantics(problem)
    tasks = executable_tasks(grounding)
    assume(tasks)
    state: State = problem.initial_state
    for _ in range(6):
        successors = []
        for (name, *arguments), choices in tasks.items():
            expected = ways(semantics, name, tuple(arguments), state)
            before = project(model, state)
            applicable = [actions for actions in choices if model.actions[actions[0]].is_applicable(before)]
            assert bool(applicable) == (expected is not None), (name, arguments, state)
            if expected is None:
                continue
            wanted: Outcomes = {}
            for way in expected:
                after = way.state(state)
                successors.append(after)
                for cost, probability in way.law.items():
                    key = (project(model, after), cost)
                    wanted[key] = wanted.get(key, Fraction(0)) + way.probability * probability
            for actions in applicable:
                assert found_outcomes(grounding, actions, before, chances) == without_zero(wanted)
        if not successors:
            break
        state = generator.choice(successors)


def executable_tasks(grounding: Grounding) -> dict[tuple[str, ...], list[list[int]]]:
    """By ground action of the domain: for each case of its precondition, its outcome actions."""
    model, handle = grounding.to_model(), grounding.handle
    of_chance = {
        task: [model.methods[method].subtasks[0] for method in methods]
        for task, methods in model.methods_of.items()
        if handle.is_chance(task)
    }
    alone = set(range(len(model.actions))).difference(*of_chance.values())
    tasks: dict[tuple[str, ...], list[list[int]]] = {}
    for actions in [*of_chance.values(), *([action] for action in sorted(alone))]:
        first = model.actions[actions[0]]
        if not first.is_precondition:
            tasks.setdefault((first.name, *first.arguments), []).append(actions)
    return tasks


def found_outcomes(
    grounding: Grounding, actions: list[int], before: frozenset[int], chances: list[Fraction]
) -> Outcomes:
    model = grounding.to_model()
    assert sum(chances[action] for action in actions) == 1
    outcomes: Outcomes = {}
    for number in actions:
        action = model.actions[number]
        parts = range(*grounding.handle.cost_parts(number))
        due = [part for part, own in zip(parts, action.cost_parts, strict=True) if own.is_due(before)]
        for probability, cost in total_of(grounding, number, due).outcomes:
            key = (action.apply(before), exact(cost))
            outcomes[key] = outcomes.get(key, Fraction(0)) + chances[number] * exact(probability)
    return without_zero(outcomes)


def without_zero(outcomes: Outcomes) -> Outcomes:
    return {key: exact(probability) for key, probability in outcomes.items() if probability}


def project(model: GroundProblem, state: frozenset[Fact]) -> frozenset[int]:
    return frozenset(number for number, fact in enumerate(model.facts) if fact in state)


@given(wide_problems(), grounding_switches())
def test_chance_tasks_are_well_formed(problem: Problem, switches: GroundingSwitches) -> None:
    grounding = ground(problem, switches=switches)
    model, handle = grounding.to_model(), grounding.handle
    chances = [task for task in model.methods_of if handle.is_chance(task)]
    assert bool(chances) == handle.has_outcomes
    for task in chances:
        methods = [model.methods[method] for method in model.methods_of[task]]
        assert len(methods) > 1
        actions = [model.actions[subtask] for method in methods for subtask in method.subtasks]
        assert len(actions) == len(methods)
        assert {(action.name, *action.arguments) for action in actions} == {model.tasks[task - len(model.actions)]}
        assert len({(action.precondition, action.negative_precondition) for action in actions}) == 1
        rows = [handle.action_branches(subtask) for method in methods for subtask in method.subtasks]
        assert all(rows)


@given(wide_problems())
def test_two_runs_give_the_same_numbers(problem: Problem) -> None:
    assert ground(problem).to_model() == ground(problem).to_model()
