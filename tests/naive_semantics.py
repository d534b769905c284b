"""What a lifted problem means, spelled out in the plainest way: formulas, effects, cost laws and method instances.

Nothing here is shared with the planner but the problem's own classes: this is the judge of the planner.
States are frozen sets of facts; a term that is no bound variable is an object.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from fractions import Fraction
from functools import cache

from statehtn.model import (
    TRUE,
    Action,
    And,
    Arithmetic,
    Atom,
    CostBlock,
    CostDistribution,
    Effect,
    Equals,
    Exists,
    Expression,
    Fact,
    Forall,
    Formula,
    FunctionTerm,
    Method,
    Not,
    Number,
    OfType,
    Or,
    Parameter,
    Problem,
    Signature,
)

Bindings = dict[str, str]
State = frozenset[Fact]
Law = dict[Fraction, Fraction]


class Semantics:
    """The meaning of one problem."""

    def __init__(self, problem: Problem) -> None:
        self.problem = problem
        self.domain = problem.domain
        changing = {effect.atom.predicate for action in self.domain.actions.values() for effect in action.all_effects}
        self.fixed = set(self.domain.predicates) - changing
        self.instances = cache(self._instances)
        self.law = cache(self._law)

    # --- formulas

    def holds(self, formula: Formula, bindings: Mapping[str, str], state: State) -> bool:
        match formula:
            case Atom(predicate, terms):
                return (predicate, *(bindings.get(term, term) for term in terms)) in state
            case Equals(left, right):
                return bindings.get(left, left) == bindings.get(right, right)
            case OfType(term, types):
                return self.is_of(bindings.get(term, term), types)
            case Not(operand):
                return not self.holds(operand, bindings, state)
            case And(operands):
                return all(self.holds(operand, bindings, state) for operand in operands)
            case Or(operands):
                return any(self.holds(operand, bindings, state) for operand in operands)
            case Exists(parameters, body):
                return any(self.holds(body, {**bindings, **more}, state) for more in self.all_bindings(parameters))
            case Forall(parameters, body):
                return all(self.holds(body, {**bindings, **more}, state) for more in self.all_bindings(parameters))
        raise TypeError(formula)

    def is_of(self, name: str, types: tuple[str, ...]) -> bool:
        return self.domain.types.is_subtype(self.problem.all_objects[name], types)

    def all_bindings(self, parameters: tuple[Parameter, ...]) -> Iterator[Bindings]:
        if not parameters:
            yield {}
            return
        first, *rest = parameters
        for name in self.problem.all_objects:
            if self.is_of(name, first.types):
                for bindings in self.all_bindings(tuple(rest)):
                    yield {first.name: name, **bindings}

    # --- actions

    def bind(self, task: Action | Signature, arguments: tuple[str, ...]) -> Bindings | None:
        """Bind the parameters of a task to the arguments; None if the types forbid it."""
        if all(self.is_of(name, parameter.types) for name, parameter in zip(arguments, task.parameters, strict=True)):
            return {parameter.name: name for parameter, name in zip(task.parameters, arguments, strict=True)}
        return None

    def execute(self, name: str, arguments: tuple[str, ...], state: State) -> State | None:
        """The state after an action; None if it cannot be executed."""
        action = self.domain.actions[name]
        bindings = self.bind(action, arguments)
        if bindings is None or not self.holds(action.precondition, bindings, state):
            return None
        added, deleted = self.changes(action.effects, bindings, state)
        return (state - deleted) | added

    def changes(self, effects: Iterable[Effect], bindings: Bindings, state: State) -> tuple[set[Fact], set[Fact]]:
        """What effects make true and what false."""
        added: set[Fact] = set()
        deleted: set[Fact] = set()
        for effect in effects:
            for more in self.all_bindings(effect.parameters):
                inner = {**bindings, **more}
                if self.holds(effect.condition, inner, state):
                    fact = (effect.atom.predicate, *(inner.get(term, term) for term in effect.atom.arguments))
                    (added if effect.positive else deleted).add(fact)
        return added, deleted

    def _law(self, name: str, arguments: tuple[str, ...], state: State | None) -> CostDistribution:
        """The law of the cost of an action that is executed in a state; without a state, of the part always due."""
        law = self.exact_law(name, arguments, state)
        return CostDistribution.of((float(probability), float(cost)) for cost, probability in law.items())

    def exact_law(self, name: str, arguments: tuple[str, ...], state: State | None) -> Law:
        """The same, with the probability of each cost as a fraction."""
        if not any(self.states_costs(action) for action in self.domain.actions.values()):
            return {Fraction(1): Fraction(1)}
        action = self.domain.actions[name]
        bindings = self.bind(action, arguments)
        assert bindings is not None
        return self.law_of(action.costs, arguments, bindings, state)

    def states_costs(self, action: Action) -> bool:
        return bool(action.costs) or any(one.costs for block in action.outcomes for one in block.outcomes)

    def law_of(
        self, blocks: Iterable[CostBlock], arguments: tuple[str, ...], bindings: Bindings, state: State | None
    ) -> Law:
        """The law of the sum of those blocks that are due."""
        law: Law = {Fraction(0): Fraction(1)}
        for block in blocks:
            for more in self.all_bindings(block.parameters):
                inner = {**bindings, **more}
                if block.condition == TRUE or (state is not None and self.holds(block.condition, inner, state)):
                    law = add(law, self.block_law(block, arguments, inner))
        return law

    def block_law(self, block: CostBlock, arguments: tuple[str, ...], bindings: Bindings) -> Law:
        if block.external is not None:
            answer = block.external(*arguments)
            outcomes = answer.outcomes if isinstance(answer, CostDistribution) else ((1.0, answer),)
            return {Fraction(repr(float(cost))): Fraction(repr(probability)) for probability, cost in outcomes}
        law: Law = {}
        for probability, cost in block.branches:
            value = self.value(cost, bindings)
            law[value] = law.get(value, Fraction(0)) + self.value(probability, bindings)
        law[Fraction(0)] = law.get(Fraction(0), Fraction(0)) + 1 - sum(law.values())
        return law

    def value(self, expression: Expression, bindings: Bindings) -> Fraction:
        match expression:
            case Number(value):
                return value
            case FunctionTerm(function, terms):
                return self.problem.function_values[function, *(bindings.get(term, term) for term in terms)]
            case Arithmetic(operator, operands):
                first, *rest = (self.value(operand, bindings) for operand in operands)
                if operator == "-" and not rest:
                    return -first
                for value in rest:
                    first = first + value if operator == "+" else first - value if operator == "-" else first * value
                return first
        raise TypeError(expression)

    # --- methods

    def _instances(self, task: str, arguments: tuple[str, ...]) -> list[tuple[Method, Bindings]]:
        """All ways to decompose a compound task, but for those that can be seen to fail by what never changes."""
        if self.bind(self.domain.tasks[task], arguments) is None:
            return []
        found = []
        for method in self.domain.methods.values():
            if method.task == task:
                bindings: Bindings | None = {}
                for term, name in zip(method.arguments, arguments, strict=True):
                    variable = term.startswith("?")
                    if bindings is not None and (bindings.setdefault(term, name) if variable else term) != name:
                        bindings = None
                if bindings is not None:
                    conditions = list(self.fixed_conditions(method))
                    found += [(method, complete) for complete in self.completions(method, bindings, conditions)]
        return found

    def completions(self, method: Method, bindings: Bindings, conditions: list[Formula]) -> Iterator[Bindings]:
        for condition in conditions:
            known = all(term in bindings for term in variables(condition))
            if known and not self.holds(condition, bindings, self.problem.initial_state):
                return
        for parameter in method.parameters:
            if parameter.name in bindings and not self.is_of(bindings[parameter.name], parameter.types):
                return
        for parameter in method.parameters:
            if parameter.name not in bindings:
                for more in self.all_bindings((parameter,)):
                    yield from self.completions(method, {**bindings, **more}, conditions)
                return
        if self.holds(method.network.constraints, bindings, self.problem.initial_state):
            yield bindings

    def fixed_conditions(self, method: Method) -> Iterator[Formula]:
        """Literals that the method needs and that no action changes: the initial state decides them."""
        yield from filter(self.is_fixed, conjuncts(method.network.constraints))
        yield from filter(self.is_fixed, conjuncts(method.precondition))
        for subtask in method.network.subtasks:
            action = self.domain.actions.get(subtask.task)
            if action is not None:
                terms = {p.name: term for p, term in zip(action.parameters, subtask.arguments, strict=True)}
                for literal in conjuncts(action.precondition):
                    if self.is_fixed(literal):
                        yield rename(literal, terms)

    def is_fixed(self, formula: Formula) -> bool:
        match formula:
            case Not(operand):
                return self.is_fixed(operand)
            case Atom(predicate, _):
                return predicate in self.fixed
        return isinstance(formula, Equals)


def add(left: Law, right: Law) -> Law:
    """The law of the sum of two independent costs."""
    law: Law = {}
    for cost, probability in left.items():
        for more, q in right.items():
            law[cost + more] = law.get(cost + more, Fraction(0)) + probability * q
    return law


def conjuncts(formula: Formula) -> Iterator[Formula]:
    if isinstance(formula, And):
        for operand in formula.operands:
            yield from conjuncts(operand)
    else:
        yield formula


def variables(literal: Formula) -> list[str]:
    match literal:
        case Not(operand):
            return variables(operand)
        case Atom(_, terms):
            return [term for term in terms if term.startswith("?")]
        case Equals(left, right):
            return [term for term in (left, right) if term.startswith("?")]
    raise TypeError(literal)


def rename(literal: Formula, terms: Mapping[str, str]) -> Formula:
    match literal:
        case Not(operand):
            return Not(rename(operand, terms))
        case Atom(predicate, arguments):
            return Atom(predicate, tuple(terms.get(term, term) for term in arguments))
        case Equals(left, right):
            return Equals(terms.get(left, left), terms.get(right, right))
    raise TypeError(literal)
