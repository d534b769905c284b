"""The validator's own evaluation of formulas; each is compiled once, and evaluated under many bindings and states."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass

from statehtn.model.formula import (
    And,
    Atom,
    Equals,
    Exists,
    Forall,
    Formula,
    Not,
    OfType,
    Or,
    free_variables,
    predicates,
)
from statehtn.model.problem import Fact
from statehtn.model.types import Parameter
from statehtn.semantics.formulas import Bindings, conjuncts, is_timeless, text
from statehtn.semantics.history import History, State
from statehtn.semantics.world import World, substitute

Test = Callable[[Bindings, State], bool]
"""Tells whether a formula is true in a state; the bindings cover its free variables."""


def compiled(formula: Formula, world: World) -> Test:
    """Return the test of a formula."""
    match formula:
        case Atom(predicate, terms):
            return lambda bindings, state: state.holds((predicate, *substitute(terms, bindings)))
        case Equals(left, right):
            return lambda bindings, _: bindings.get(left, left) == bindings.get(right, right)
        case OfType(term, types):
            return lambda bindings, _: world.is_of_type(bindings.get(term, term), types)
        case Not(operand):
            test = compiled(operand, world)
            return lambda bindings, state: not test(bindings, state)
        case And(operands):
            tests = [compiled(operand, world) for operand in operands]
            return lambda bindings, state: all(test(bindings, state) for test in tests)
        case Or(operands):
            tests = [compiled(operand, world) for operand in operands]
            return lambda bindings, state: any(test(bindings, state) for test in tests)
        case Exists(parameters, body):
            example = Condition(body, world)
            return lambda bindings, state: example.is_satisfiable(parameters, bindings, state)
        case Forall(parameters, body):
            exception = Condition(Not(body), world)
            return lambda bindings, state: not exception.is_satisfiable(parameters, bindings, state)


NOWHERE = History(frozenset()).at(0)
"""A state for formulas that do not ask for one."""


@dataclass(frozen=True, slots=True)
class _Part:
    """A conjunct: its free variables, and its test."""

    formula: Formula
    variables: frozenset[str]
    test: Test


class Condition:
    """A formula, compiled as a conjunction: under given bindings, or with variables that are to be bound.

    Args:
        formula: the formula.
        world: the objects and their types.
    """

    def __init__(self, formula: Formula, world: World) -> None:
        self.formula = formula
        self._world = world
        self._parts = [
            _Part(part, frozenset(free_variables(part)), compiled(part, world)) for part in conjuncts(formula)
        ]

    def ground(self, bindings: Bindings) -> GroundCondition:
        """Return the condition under bindings that cover its free variables."""
        positive: list[Fact] = []
        negative: list[Fact] = []
        others: list[_Part] = []
        for part in self._parts:
            match part.formula:
                case Atom(predicate, terms):
                    positive.append((predicate, *substitute(terms, bindings)))
                case Not(Atom(predicate, terms)):
                    negative.append((predicate, *substitute(terms, bindings)))
                case formula if not (is_timeless(formula) and part.test(bindings, NOWHERE)):
                    others.append(part)
        return GroundCondition(self, bindings, frozenset(positive), frozenset(negative), tuple(others))

    def why_false(self, bindings: Bindings, state: State) -> str:
        """Name the parts that are false in a state; the bindings cover the free variables."""
        false = [part.formula for part in self._parts if not part.test(bindings, state)]
        return ", ".join(f"{text(formula, bindings)} is false" for formula in false)

    def is_satisfiable(self, parameters: Iterable[Parameter], bindings: Bindings, state: State) -> bool:
        """Tell whether the parameters can be bound to objects of their types so that the formula is true."""
        asked: list[Parameter] = []
        for parameter in parameters:
            if any(parameter.name in part.variables for part in self._parts):
                asked.append(parameter)
            elif not self._world.objects(parameter.types):
                return False
        return next(self.solutions(asked, bindings, state), None) is not None

    def solutions(self, parameters: Iterable[Parameter], bindings: Bindings, state: State) -> Iterator[Bindings]:
        """Yield, each once, the extensions of the bindings by the parameters under which the formula is true."""
        unbound = {parameter.name: parameter for parameter in parameters}
        outer = {name: value for name, value in bindings.items() if name not in unbound}
        return self._search(self._parts, unbound, outer, state)

    def _search(
        self, parts: list[_Part], unbound: dict[str, Parameter], bindings: Bindings, state: State
    ) -> Iterator[Bindings]:
        self._world.work()
        still_open: list[_Part] = []
        for part in parts:
            if not part.variables.isdisjoint(unbound):
                still_open.append(part)
            elif not part.test(bindings, state):
                return
        if not still_open:
            domains = [self._world.objects(parameter.types) for parameter in unbound.values()]
            for objects in itertools.product(*domains):
                self._world.work()
                yield {**bindings, **dict(zip(unbound, objects, strict=True))}
            return
        for extension in self._candidates(still_open, unbound, bindings, state):
            rest = {name: parameter for name, parameter in unbound.items() if name not in extension}
            yield from self._search(still_open, rest, {**bindings, **extension}, state)

    def _candidates(
        self, parts: list[_Part], unbound: dict[str, Parameter], bindings: Bindings, state: State
    ) -> Iterator[dict[str, str]]:
        """Yield ways to bind some variables: as facts of the most selective atom, or one variable to any object."""
        choices: list[tuple[list[Fact], Atom]] = []
        for part in parts:
            if isinstance(atom := part.formula, Atom):
                known = [
                    (position, bindings.get(term, term))
                    for position, term in enumerate(atom.arguments, 1)
                    if term not in unbound
                ]
                choices.append((state.candidates(atom.predicate, known), atom))
        if choices:
            facts, atom = min(choices, key=lambda choice: len(choice[0]))
            yield from self._matches(facts, atom, unbound, bindings, state)
            return
        name = min(parts[0].variables & unbound.keys())
        for value in self._world.objects(unbound[name].types):
            yield {name: value}

    def _matches(
        self, facts: Iterable[Fact], atom: Atom, unbound: Mapping[str, Parameter], bindings: Bindings, state: State
    ) -> Iterator[dict[str, str]]:
        for fact in facts:
            self._world.work()
            known = dict(bindings)
            if state.holds(fact) and self._world.unify(atom.arguments, fact[1:], known):
                extension = {name: known[name] for name in atom.arguments if name in unbound}
                if all(self._world.is_of_type(value, unbound[name].types) for name, value in extension.items()):
                    yield extension


@dataclass(frozen=True, slots=True)
class GroundCondition:
    """A condition under bindings: the facts that must be true and false, and what is no literal."""

    condition: Condition
    bindings: Bindings
    positive: frozenset[Fact]
    negative: frozenset[Fact]
    others: tuple[_Part, ...]

    def holds(self, state: State) -> bool:
        """Tell whether it is true in a state."""
        return (
            all(map(state.holds, self.positive))
            and not any(map(state.holds, self.negative))
            and all(part.test(self.bindings, state) for part in self.others)
        )

    def holds_now(self, history: History) -> bool:
        """Tell whether it is true in the last state of a history so far."""
        if not (self.positive <= history.now and self.negative.isdisjoint(history.now)):
            return False
        return not self.others or self.holds(history.at(history.end))

    def first_time(self, history: History, after: int, until: int) -> int | None:
        """Return the first time of `after <= time <= until` at which it is true."""
        changing = [name for part in self.others if not is_timeless(part.formula) for name in predicates(part.formula)]
        literals = [*((fact, True) for fact in self.positive), *((fact, False) for fact in self.negative)]
        time = after
        while time <= until:
            begin = time
            for fact, wanted in literals:
                found = history.first_time(fact, wanted, time)
                if found is None:
                    return None
                time = found
            if time > begin:
                continue
            if all(part.test(self.bindings, history.at(time)) for part in self.others):
                return time
            time = next(history.change_times(changing, time, until), until + 1)
        return None

    def why_false(self, state: State) -> str:
        """Name its parts that are false in a state."""
        return self.condition.why_false(self.bindings, state)
