"""Building a problem call by call gives the problem itself, and what is written of it is read as equal."""

from __future__ import annotations

from dataclasses import replace
from functools import reduce
from operator import or_

import pytest
from hypothesis import HealthCheck, given, settings

from statehtn.build import (
    CostPart,
    EffectPart,
    Occurrence,
    Outcome,
    OutcomePart,
    ProblemBuilder,
    Quantified,
    Type,
    chance,
    forall,
    when,
)
from statehtn.hddl import read_hddl_text, write_hddl
from statehtn.model import TRUE, CostBlock, Effect, Method, OutcomeBlock, Parameter, Problem, TaskNetwork, TypeHierarchy
from tests.property.test_hddl_roundtrip import problem_is_complete, problems


class Rebuilder:
    """Calls a builder for everything in a problem."""

    def __init__(self, problem: Problem) -> None:
        self.problem = problem
        self.build = ProblemBuilder(problem.name, problem.domain.name)

    def rebuilt(self) -> Problem:
        build, problem, domain = self.build, self.problem, self.problem.domain
        for name, parents in domain.types.parents.items():
            build.type(name, self.union(parents) if parents else None)
        for name, kind in domain.constants.items():
            self.union((kind,)).constants(name)
        for name, kind in problem.objects.items():
            self.union((kind,)).objects(name)
        for signature in domain.predicates.values():
            build.predicate(signature.name, *self.variables(signature.parameters))
        for signature in domain.functions.values():
            build.function(signature.name, *self.variables(signature.parameters))
        for signature in domain.tasks.values():
            build.task(signature.name, *self.variables(signature.parameters))
        for action in domain.actions.values():
            build.action(
                action.name,
                self.variables(action.parameters),
                precondition=action.precondition,
                effects=[self.effect(effect) for effect in action.effects],
                cost=[self.cost(block) for block in action.costs],
                outcomes=[self.outcomes(block) for block in action.outcomes],
            )
        for method in domain.methods.values():
            self.method(method)
        for predicate, *arguments in problem.initial_state:
            build.initially(build.predicates[predicate](*arguments))
        for (function, *arguments), value in problem.function_values.items():
            build.set_values({build.functions[function](*arguments): value})
        variables = self.variables(problem.parameters)
        subtasks, pairs = self.network(problem.network, variables)
        build.set_network(subtasks, parameters=variables, ordering=pairs, constraints=problem.network.constraints)
        build.set_goal(problem.goal)
        return build.build()

    def union(self, names: tuple[str, ...]) -> Type:
        known = {**self.build.types, "object": self.build.any_object}
        return reduce(or_, (known[name] for name in names))

    def variables(self, parameters: tuple[Parameter, ...]) -> tuple[Parameter, ...]:
        return tuple(self.union(parameter.types).variable(parameter.name) for parameter in parameters)

    def effect(self, effect: Effect) -> EffectPart:
        literal: EffectPart = effect.atom if effect.positive else ~effect.atom
        part = literal if effect.condition == TRUE else when(effect.condition, literal)
        return Quantified(effect.parameters, (part,)) if effect.parameters else part

    def cost(self, block: CostBlock) -> CostPart:
        part: CostPart = chance(*block.branches)
        if block.condition != TRUE:
            part = when(block.condition, part)
        return forall(self.variables(block.parameters), part) if block.parameters else part

    def outcomes(self, block: OutcomeBlock) -> OutcomePart:
        parts = [
            Outcome(one.probability, [self.effect(effect) for effect in one.effects], [self.cost(c) for c in one.costs])
            for one in block.outcomes
        ]
        part: OutcomePart = parts if block.condition == TRUE else when(block.condition, *parts)
        return Quantified(block.parameters, (part,)) if block.parameters else part

    def method(self, method: Method) -> None:
        variables = self.variables(method.parameters)
        terms = {variable.name: variable for variable in variables}
        task = self.build.tasks[method.task](*(terms.get(name, name) for name in method.arguments))
        subtasks, pairs = self.network(method.network, variables)
        self.build.method(
            method.name,
            task,
            subtasks,
            parameters=variables,
            ordering=pairs,
            precondition=method.precondition,
            constraints=method.network.constraints,
        )

    def network(
        self, network: TaskNetwork, variables: tuple[Parameter, ...]
    ) -> tuple[list[Occurrence], list[tuple[Occurrence | str, Occurrence | str]]]:
        terms = {variable.name: variable for variable in variables}
        found = [
            self.build.tasks[subtask.task](*(terms.get(name, name) for name in subtask.arguments), label=subtask.label)
            for subtask in network.subtasks
        ]
        # By label and by the object itself, in turn.
        pairs: list[tuple[Occurrence | str, Occurrence | str]] = [
            (found[i], network.subtasks[j].label) if i % 2 else (network.subtasks[i].label, found[j])
            for i, j in network.ordering
        ]
        return found, pairs


def with_root_types(problem: Problem) -> Problem:
    """A type without a supertype is below `object`; the builder says so."""
    parents = {name: above or ("object",) for name, above in problem.domain.types.parents.items()}
    return replace(problem, domain=replace(problem.domain, types=TypeHierarchy(parents)))


@pytest.mark.filterwarnings("ignore:.*no plan")
@settings(deadline=None, suppress_health_check=[HealthCheck.too_slow, HealthCheck.data_too_large])
@given(problems().filter(problem_is_complete))
def test_building_everything_again_gives_the_same_problem(problem: Problem) -> None:
    built = Rebuilder(problem).rebuilt()
    assert built == with_root_types(problem)
    assert read_hddl_text(*write_hddl(built)) == built
    assert ProblemBuilder.of(problem).build() == problem
