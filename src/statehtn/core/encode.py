"""From names to numbers: the lifted problem as the compiled grounder takes it.

Three things become tasks here. The initial network is a method of an artificial initial task; a method's precondition
is an action without effects before all its subtasks; the goal is such an action after all tasks of the initial network.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field

import statehtn._relax as _relax
from statehtn.model import (
    TRUE,
    Action,
    And,
    Atom,
    Equals,
    Exists,
    Forall,
    Formula,
    Method,
    Not,
    OfType,
    Or,
    Parameter,
    Problem,
    TaskNetwork,
)
from statehtn.model.cost_law import is_unconditional
from statehtn.model.formula import free_variables

Kind = _relax.FormulaKind


@dataclass
class Encoding:
    """A lifted problem in numbers, and what the numbers mean.

    `actions` and `methods` are by schema number: None for artificial actions, and for the method that stands for the
    initial network.
    """

    problem: Problem
    handle: _relax.LiftedProblem = field(default_factory=_relax.LiftedProblem)
    objects: list[str] = field(default_factory=list)
    predicates: list[str] = field(default_factory=list)
    actions: list[Action | None] = field(default_factory=list)
    action_names: list[str] = field(default_factory=list)
    tasks: list[str] = field(default_factory=list)
    methods: list[Method | None] = field(default_factory=list)


def encode(problem: Problem) -> Encoding:
    """Return the problem as the compiled grounder takes it."""
    return _Encoder(problem).run()


class _Scope:
    """The variable slots of one schema; every quantifier gets slots of its own."""

    def __init__(self, parameters: Sequence[Parameter]) -> None:
        self.slots = {parameter.name: slot for slot, parameter in enumerate(parameters)}
        self.count = len(parameters)

    def bind(self, parameters: Iterable[Parameter]) -> dict[str, int]:
        """Give new slots to quantified variables; returns the slots of the names that they hide."""
        names = [parameter.name for parameter in parameters]
        hidden = {name: self.slots[name] for name in names if name in self.slots}
        for name in names:
            self.slots[name] = self.count
            self.count += 1
        return hidden


class _Encoder:
    def __init__(self, problem: Problem) -> None:
        self.result = Encoding(problem)
        self.problem = problem
        self.handle = self.result.handle
        self.result.objects = list(problem.all_objects)
        self.object_numbers = {name: number for number, name in enumerate(self.result.objects)}
        self.result.predicates = list(problem.domain.predicates)
        self.predicate_numbers = {name: number for number, name in enumerate(self.result.predicates)}
        self.domain_numbers: dict[tuple[str, ...], int] = {}
        self.domains: list[list[int]] = []

    def run(self) -> Encoding:
        problem, domain, result = self.problem, self.problem.domain, self.result
        methods = list(domain.methods.values())
        guards = {method.name: _needed(method.parameters, method.precondition) for method in methods}
        result.actions = list(domain.actions.values())
        result.action_names = list(domain.actions)
        for method in methods:
            if method.precondition != TRUE:
                result.actions.append(None)
                result.action_names.append(f"precondition of {method.name}")
        if problem.goal != TRUE:
            result.actions.append(None)
            result.action_names.append("goal")
        result.tasks = [*domain.tasks, "initial network"]
        numbers = {name: number for number, name in enumerate([*domain.actions])}
        numbers.update((name, len(result.actions) + number) for number, name in enumerate(domain.tasks))

        for action in domain.actions.values():
            self.add_action(action)
        for method in methods:
            if method.precondition != TRUE:
                self.add_guard(guards[method.name], method.precondition)
        if problem.goal != TRUE:
            self.add_guard((), problem.goal)
        for signature in domain.tasks.values():
            self.handle.add_task(self.domains_of(signature.parameters))
        self.handle.add_task([])

        guard = len(domain.actions)
        for method in methods:
            before: list[tuple[int, tuple[str, ...]]] = []
            if method.precondition != TRUE:
                before.append((guard, tuple(parameter.name for parameter in guards[method.name])))
                guard += 1
            task = numbers[method.task]
            self.add_method(method, method.parameters, task, method.arguments, method.network, numbers, before)
        after = [(guard, ())] if problem.goal != TRUE else []
        initial_task = len(result.actions) + len(domain.tasks)
        self.add_method(None, problem.parameters, initial_task, (), problem.network, numbers, [], after)

        self.handle.object_count = len(result.objects)
        self.handle.predicate_count = len(result.predicates)
        self.handle.domains = self.domains
        self.handle.initial_task = initial_task
        objects = self.object_numbers
        self.handle.initial_state = sorted(
            [self.predicate_numbers[name], *(objects[argument] for argument in arguments)]
            for name, *arguments in problem.initial_state
        )
        return result

    def add_action(self, action: Action) -> None:
        scope = _Scope(action.parameters)
        precondition = self.formula(action.precondition, scope)
        effects = []
        for effect in action.effects:
            variables, condition, terms = self.quantified(
                effect.parameters, effect.condition, effect.atom.arguments, scope
            )
            effects.append(
                _relax.LiftedEffect(
                    variables, condition, self.predicate_numbers[effect.atom.predicate], terms, effect.positive
                )
            )
        costs = []
        for index, block in enumerate(action.costs):
            if not is_unconditional(block):
                variables, condition, _ = self.quantified(block.parameters, block.condition, (), scope)
                costs.append(_relax.LiftedCostCondition(index, variables, condition))
        self.handle.add_action(self.domains_of(action.parameters), scope.count, precondition, effects, costs, False)

    def add_guard(self, parameters: Sequence[Parameter], condition: Formula) -> None:
        """Add an artificial action that only tests a condition."""
        scope = _Scope(parameters)
        precondition = self.formula(condition, scope)
        self.handle.add_action(self.domains_of(parameters), scope.count, precondition, [], [], True)

    def add_method(
        self,
        method: Method | None,
        parameters: Sequence[Parameter],
        task: int,
        arguments: Sequence[str],
        network: TaskNetwork,
        numbers: Mapping[str, int],
        before: Sequence[tuple[int, tuple[str, ...]]],
        after: Sequence[tuple[int, tuple[str, ...]]] = (),
    ) -> None:
        """Add a method whose network is preceded by the tasks `before` and followed by the tasks `after`."""
        scope = _Scope(parameters)
        constraints = self.formula(network.constraints, scope)
        own = [(numbers[subtask.task], subtask.arguments) for subtask in network.subtasks]
        subtasks = [(number, self.terms(names, scope)) for number, names in (*before, *own, *after)]
        offset = len(before)
        middle = range(offset, offset + len(own))
        ordering = [(offset + first, offset + second) for first, second in network.ordering]
        ordering += [(guard, other) for guard in range(offset) for other in middle]
        ordering += [(other, guard) for guard in range(offset + len(own), len(subtasks)) for other in middle]
        self.handle.add_method(
            self.domains_of(parameters),
            scope.count,
            task,
            self.terms(arguments, scope),
            constraints,
            subtasks,
            ordering,
        )
        self.result.methods.append(method)

    def quantified(
        self, parameters: Sequence[Parameter], condition: Formula, names: Sequence[str], scope: _Scope
    ) -> tuple[list[tuple[int, int]], _relax.Formula, list[int]]:
        """Encode a condition and terms under quantified variables, which come first, as (slot, domain)."""
        hidden = scope.bind(parameters)
        variables = [(scope.slots[parameter.name], self.domain_of(parameter)) for parameter in parameters]
        encoded = self.formula(condition, scope)
        terms = self.terms(names, scope)
        for parameter in parameters:
            del scope.slots[parameter.name]
        scope.slots.update(hidden)
        return variables, encoded, terms

    def formula(self, formula: Formula, scope: _Scope) -> _relax.Formula:
        match formula:
            case Atom(predicate, arguments):
                return _relax.Formula(
                    Kind.Atom, symbol=self.predicate_numbers[predicate], terms=self.terms(arguments, scope)
                )
            case Equals(left, right):
                return _relax.Formula(Kind.Equals, terms=self.terms((left, right), scope))
            case OfType(term, types):
                return _relax.Formula(Kind.InDomain, symbol=self.domain(types), terms=self.terms((term,), scope))
            case Not(operand):
                return _relax.Formula(Kind.Not, [self.formula(operand, scope)])
            case And(operands) | Or(operands):
                kind = Kind.And if isinstance(formula, And) else Kind.Or
                return _relax.Formula(kind, [self.formula(operand, scope) for operand in operands])
            case Exists(parameters, body) | Forall(parameters, body):
                kind = Kind.Exists if isinstance(formula, Exists) else Kind.Forall
                variables, encoded, _ = self.quantified(parameters, body, (), scope)
                return _relax.Formula(kind, [encoded], variables=variables)

    def terms(self, names: Iterable[str], scope: _Scope) -> list[int]:
        """Encode terms: the slot of a variable, the bitwise complement of an object's number."""
        return [scope.slots[name] if name.startswith("?") else ~self.object_numbers[name] for name in names]

    def domains_of(self, parameters: Iterable[Parameter]) -> list[int]:
        return [self.domain_of(parameter) for parameter in parameters]

    def domain_of(self, parameter: Parameter) -> int:
        return self.domain(parameter.types)

    def domain(self, types: tuple[str, ...]) -> int:
        number = self.domain_numbers.get(types)
        if number is None:
            number = self.domain_numbers[types] = len(self.domains)
            self.domains.append([self.object_numbers[name] for name in self.problem.objects_of(types)])
        return number


def _needed(parameters: Sequence[Parameter], condition: Formula) -> tuple[Parameter, ...]:
    """Return the parameters that a condition mentions."""
    names = set(free_variables(condition))
    return tuple(parameter for parameter in parameters if parameter.name in names)
