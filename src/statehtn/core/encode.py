"""From names to numbers: the lifted problem as the compiled grounder takes it.

What the grounder has no words for has become tasks and methods before (`schemes`).
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field

import statehtn._relax as _relax
from statehtn.core.schemes import INITIAL_TASK, PreconditionAction, Scheme, method_schemes
from statehtn.model import (
    Action,
    And,
    Atom,
    CostBlock,
    Effect,
    Equals,
    Exists,
    Forall,
    Formula,
    Not,
    OfType,
    Or,
    Parameter,
    Problem,
)
from statehtn.model.cost.ground_cost import is_unconditional
from statehtn.model.formula import Fact, predicates
from statehtn.model.hidden import check_that_costs_alone_read, hidden_predicates

Kind = _relax.FormulaKind
Branch = tuple[int, int] | None
"""The block of outcomes and the branch in it to which something belongs; None for what is certain."""


@dataclass(frozen=True, slots=True)
class CostPart:
    """A conditional cost block as the core takes it: in some of the scenarios, where there are any.

    What is hidden never changes, so that a condition that reads hidden facts is one on other facts in each scenario. It
    is encoded once for all scenarios in which it reads the same, with predicates that are static.
    """

    block: int  # in `Action.all_costs`
    scenarios: frozenset[int] | None  # None: in all of them
    branch: Branch = None


@dataclass
class Encoding:
    """A lifted problem in numbers, and what the numbers mean.

    `actions`, `cost_parts` and `schemes` are by the core's schema numbers; precondition actions are None. Parts of a
    cost have their index in a row of `cost_parts` as the core's number.
    """

    problem: Problem
    handle: _relax.LiftedProblem = field(default_factory=_relax.LiftedProblem)
    objects: list[str] = field(default_factory=list)
    predicates: list[str] = field(default_factory=list)
    actions: list[Action | None] = field(default_factory=list)
    cost_parts: list[list[CostPart]] = field(default_factory=list)
    action_names: list[str] = field(default_factory=list)
    tasks: list[str] = field(default_factory=list)
    schemes: list[Scheme] = field(default_factory=list)


def encode(problem: Problem, split: bool = True) -> Encoding:
    """Return the problem as the compiled grounder takes it; `split` parts unrelated choices of methods."""
    return _Encoder(problem).run(split)


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
        self.own_numbers = {name: number for number, name in enumerate(self.result.predicates)}
        self.predicate_numbers = self.own_numbers  # of the formula that is being encoded
        self.domain_numbers: dict[tuple[str, ...], int] = {}
        self.domains: list[list[int]] = []
        self.numbers: dict[str, int] = {}  # of tasks
        self.hidden = hidden_predicates(problem.chances)
        self.static_numbers: dict[tuple[str, frozenset[Fact]], int] = {}  # of hidden predicates with these facts

    def run(self, split: bool) -> Encoding:
        problem, domain, result = self.problem, self.problem.domain, self.result
        check_that_costs_alone_read(problem)
        precondition_actions, result.schemes = method_schemes(problem, split)
        result.actions = [*domain.actions.values(), *(None for _ in precondition_actions)]
        result.action_names = [*domain.actions, *(action.name for action in precondition_actions)]
        tasks = {name: signature.parameters for name, signature in domain.tasks.items()}
        for scheme in result.schemes:
            if scheme.is_part:
                given = {parameter.name: parameter for parameter in scheme.parameters}
                tasks[scheme.task] = tuple(given[name] for name in scheme.arguments)
        tasks[INITIAL_TASK] = ()
        result.tasks = list(tasks)
        self.numbers = {name: number for number, name in enumerate([*result.action_names, *tasks])}

        for action in domain.actions.values():
            self.add_action(action)
        for precondition_action in precondition_actions:
            self.add_precondition_action(precondition_action)
        for parameters in tasks.values():
            self.handle.add_task(self.domains_of(parameters))
        for scheme in result.schemes:
            self.add_method(scheme)

        self.handle.object_count = len(result.objects)
        self.handle.predicate_count = len(result.predicates)
        self.handle.domains = self.domains
        self.handle.initial_task = self.numbers[INITIAL_TASK]
        objects = self.object_numbers
        self.handle.initial_state = sorted(
            [self.predicate_numbers[name], *(objects[argument] for argument in arguments)]
            for name, *arguments in problem.initial_state
        ) + [
            [number, *(objects[argument] for argument in arguments)]
            for (_, facts), number in self.static_numbers.items()
            for _, *arguments in sorted(facts)
        ]
        return result

    def add_action(self, action: Action) -> None:
        scope = _Scope(action.parameters)
        precondition = self.formula(action.precondition, scope)
        effects = [self.effect(effect, scope) for effect in action.effects]
        costs: list[_relax.LiftedCostCondition] = []
        parts: list[CostPart] = []
        for index, cost in enumerate(action.costs):
            if not is_unconditional(cost):
                self.add_cost(cost, index, None, scope, costs, parts)
        index = len(action.costs)
        blocks = []
        for number, block in enumerate(action.outcomes):
            branches = block.branches
            blocks.append((len(block.parameters), len(branches)))
            for branch, outcome in enumerate(branches):
                effects += [self.effect(effect, scope, (number, branch)) for effect in block.effects_of(outcome)]
                for cost in block.costs_of(outcome):
                    self.add_cost(cost, index, (number, branch), scope, costs, parts)
                    index += 1
        self.result.cost_parts.append(parts)
        domains = self.domains_of(action.parameters)
        self.handle.add_action(domains, scope.count, precondition, effects, costs, False, blocks)

    def effect(self, effect: Effect, scope: _Scope, branch: Branch = None) -> _relax.LiftedEffect:
        """Encode an effect."""
        variables, condition, terms = self.quantified(effect.parameters, effect.condition, effect.atom.arguments, scope)
        predicate = self.predicate_numbers[effect.atom.predicate]
        return _relax.LiftedEffect(variables, condition, predicate, terms, effect.positive, branch)

    def add_cost(
        self,
        cost: CostBlock,
        index: int,
        branch: Branch,
        scope: _Scope,
        costs: list[_relax.LiftedCostCondition],
        parts: list[CostPart],
    ) -> None:
        """Add a part of a cost, once for all scenarios between which its condition does not distinguish."""
        for scenarios in self.told_apart(cost.condition):
            variables, condition, _ = self.quantified(cost.parameters, cost.condition, (), scope)
            costs.append(_relax.LiftedCostCondition(len(parts), variables, condition, branch))
            parts.append(CostPart(index, scenarios, branch))
        self.predicate_numbers = self.own_numbers

    def told_apart(self, condition: Formula) -> Iterator[frozenset[int] | None]:
        """Yield the scenarios between which a condition does not distinguish; meanwhile it reads those facts."""
        read = self.hidden.intersection(predicates(condition))
        if not read:
            self.predicate_numbers = self.own_numbers
            yield None
            return
        classes: dict[frozenset[Fact], set[int]] = {}
        for number, scenario in enumerate(self.problem.scenarios):
            classes.setdefault(frozenset(fact for fact in scenario.facts if fact[0] in read), set()).add(number)
        for facts, members in classes.items():
            self.predicate_numbers = self.own_numbers | {name: self.static(name, facts) for name in read}
            yield frozenset(members)

    def static(self, predicate: str, hidden: frozenset[Fact]) -> int:
        """Return the number of a predicate whose facts never change: those that hold where these hidden ones do."""
        facts = {fact for fact in (*self.problem.initial_state, *hidden) if fact[0] == predicate}
        key = predicate, frozenset(facts)
        if key not in self.static_numbers:
            self.static_numbers[key] = len(self.result.predicates)
            self.result.predicates.append(predicate)
        return self.static_numbers[key]

    def add_precondition_action(self, action: PreconditionAction) -> None:
        """Add an action that only tests a condition."""
        self.result.cost_parts.append([])
        scope = _Scope(action.parameters)
        precondition = self.formula(action.condition, scope)
        self.handle.add_action(self.domains_of(action.parameters), scope.count, precondition, [], [], True)

    def add_method(self, scheme: Scheme) -> None:
        scope = _Scope(scheme.parameters)
        constraints = self.formula(scheme.constraints, scope)
        self.handle.add_method(
            self.domains_of(scheme.parameters),
            scope.count,
            self.numbers[scheme.task],
            self.terms(scheme.arguments, scope),
            constraints,
            [(self.numbers[subtask.task], self.terms(subtask.arguments, scope)) for subtask in scheme.subtasks],
            scheme.ordering,
        )

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
