"""The compiled grounder against the naive one, and ground actions against the lifted ones that they come from."""

from __future__ import annotations

import random

from hypothesis import assume, given
from hypothesis import strategies as st

from statehtn.core.grounding import PLAIN, Grounding, GroundingSwitches, ground
from statehtn.model import CostDistribution, Fact, GroundAction, GroundMethod, GroundProblem, Problem
from statehtn.model.cost.sum import total_cost
from tests.naive_grounder import Decompositions, GroundTask, NaiveGrounder, NaiveGrounding
from tests.naive_semantics import Semantics, State
from tests.strategies import grounding_switches, problems


def read(grounding: Grounding) -> NaiveGrounding:
    """What the compiled grounder has left, in the oracle's form: without anything artificial."""
    model, domain = grounding.to_model(), grounding.problem.domain

    def name(task: int) -> GroundTask:
        if model.is_primitive(task):
            return (model.actions[task].name, *model.actions[task].arguments)
        return model.tasks[task - len(model.actions)]

    def subtasks(method: GroundMethod) -> tuple[GroundTask, ...]:
        return tuple(name(task) for task in method.subtasks if name(task)[0] in {*domain.actions, *domain.tasks})

    return NaiveGrounding(
        frozenset((action.name, *action.arguments) for action in model.actions if not action.is_precondition),
        frozenset(task for task in model.tasks if task[0] in domain.tasks),
        frozenset(
            Decompositions(method.name, name(method.task), subtasks(method))
            for method in model.methods
            if method.name in domain.methods
        ),
    )


@given(problems())
def test_same_instances_as_the_naive_grounder(problem: Problem) -> None:
    found = read(ground(problem, switches=PLAIN))
    most = NaiveGrounder(problem, joint=False).run()
    least = NaiveGrounder(problem, joint=True).run()
    assert least.actions <= found.actions <= most.actions
    assert least.tasks <= found.tasks <= most.tasks
    assert least.methods <= found.methods <= most.methods


@given(problems(), grounding_switches())
def test_ground_problem_is_well_formed(problem: Problem, switches: GroundingSwitches) -> None:
    model = ground(problem, switches=switches).to_model()
    read_facts: set[int] = set()
    for action in model.actions:
        assert action.precondition.isdisjoint(action.negative_precondition)
        assert not action.is_precondition or action.precondition or action.negative_precondition
        read_facts |= action.precondition | action.negative_precondition
        for part in action.cost_parts:
            assert part.alternatives
            for true, false in part.alternatives:
                assert true or false
                assert true.isdisjoint(false)
                assert action.precondition.isdisjoint(true | false)
                assert action.negative_precondition.isdisjoint(true | false)
                read_facts |= true | false
        for effect in action.effects:
            assert effect.added.isdisjoint(effect.deleted)
            assert effect.added or effect.deleted
            read_facts |= effect.condition | effect.negative_condition
    assert read_facts == set(range(len(model.facts)))
    assert model.initial_state <= read_facts
    assert len(set(model.facts)) == len(model.facts)
    for method in model.methods:
        pairs = set(method.ordering)
        assert all(first != second for first, second in pairs)
        assert {(a, d) for a, b in pairs for c, d in pairs if b == c} <= pairs
    used = {task for method in model.methods for task in method.subtasks} | {model.initial_task}
    assert not model.methods or used == set(range(len(model.actions) + len(model.tasks)))


@given(problems())
def test_two_runs_give_the_same_numbers(problem: Problem) -> None:
    assert ground(problem).to_model() == ground(problem).to_model()


@given(problems(), st.randoms(use_true_random=False))
def test_cases_mean_what_the_action_says(problem: Problem, generator: random.Random) -> None:
    model = ground(problem, switches=PLAIN).to_model()
    cases: dict[GroundTask, list[GroundAction]] = {}
    for action in model.actions:
        if not action.is_precondition:
            cases.setdefault((action.name, *action.arguments), []).append(action)
    assume(cases)
    semantics = Semantics(problem)
    state: State = problem.initial_state
    for _ in range(8):
        successors = []
        for (name, *arguments), own in cases.items():
            after = semantics.execute(name, tuple(arguments), state)
            before = project(model, state)
            applicable = [case for case in own if case.is_applicable(before)]
            assert bool(applicable) == (after is not None), (name, arguments, state)
            if after is not None:
                successors.append(after)
                law = semantics.law(name, tuple(arguments), state)
                for case in applicable:
                    assert case.apply(before) == project(model, after), (name, arguments, state)
                    assert same(total_cost(case.costs_in(before)), law), (name, arguments, state)
        if not successors:
            break
        state = generator.choice(successors)


def project(model: GroundProblem, state: frozenset[Fact]) -> frozenset[int]:
    return frozenset(number for number, fact in enumerate(model.facts) if fact in state)


def same(left: CostDistribution, right: CostDistribution) -> bool:
    return len(left.outcomes) == len(right.outcomes) and all(
        abs(p - q) < 1e-12 and c == d for (p, c), (q, d) in zip(left.outcomes, right.outcomes, strict=True)
    )
