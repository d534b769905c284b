"""Grounding in the plainest way: all instances of everything, then what cannot be is struck out until nothing changes.

The oracle of the compiled grounder, with which it shares no code. A literal that was true once stays so: an action can
be executed once its precondition is true under some choice of truth values that are all reached, one for each fact.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterator
from dataclasses import dataclass

from statehtn.model import (
    TRUE,
    Action,
    And,
    Atom,
    Effect,
    Exists,
    Fact,
    Forall,
    Formula,
    Method,
    Not,
    Or,
    Problem,
    TaskNetwork,
)
from tests.naive_semantics import Bindings, Semantics

GroundTask = tuple[str, ...]  # a task's name and arguments
Literal = tuple[Fact, bool]
INITIAL: GroundTask = ("initial network",)


@dataclass(frozen=True)
class Decompositions:
    """A method's instances that decompose the same task into the same subtasks."""

    method: str
    task: GroundTask
    subtasks: tuple[GroundTask, ...]


@dataclass(frozen=True)
class NaiveGrounding:
    """What is left; all empty if the initial network cannot be accomplished."""

    actions: frozenset[GroundTask]
    tasks: frozenset[GroundTask]
    methods: frozenset[Decompositions]


class NaiveGrounder:
    """Grounds one problem.

    Args:
        problem: a small one.
        joint: whether an effect needs truth values that make the precondition and its own condition true at once, or
            different ones will do. A grounder may do either, or anything between.
    """

    def __init__(self, problem: Problem, joint: bool) -> None:
        self.problem = problem
        self.joint = joint
        self.semantics = Semantics(problem)
        self.reached: set[Literal] = set()
        self.actions: dict[GroundTask, Bindings] = {
            (name, *bindings.values()): bindings
            for name, action in problem.domain.actions.items()
            for bindings in self.semantics.all_bindings(action.parameters)
        }
        self.methods: dict[Decompositions, list[tuple[Formula, Bindings]]] = {}
        for method in problem.domain.methods.values():
            for bindings in self.semantics.all_bindings(method.parameters):
                self.add_method(method, bindings)
        network = Method(INITIAL[0], problem.parameters, INITIAL[0], (), problem.network, problem.goal)
        for bindings in self.semantics.all_bindings(problem.parameters):
            self.add_method(network, bindings)

    def add_method(self, method: Method, bindings: Bindings) -> None:
        domain = self.problem.domain

        def ground(name: str, terms: tuple[str, ...]) -> GroundTask | None:
            arguments = tuple(bindings.get(term, term) for term in terms)
            signature = domain.tasks.get(name) or domain.actions.get(name)
            return None if signature and self.semantics.bind(signature, arguments) is None else (name, *arguments)

        network: TaskNetwork = method.network
        task = ground(method.task, method.arguments)
        subtasks = [ground(subtask.task, subtask.arguments) for subtask in network.subtasks]
        if task and None not in subtasks and self.semantics.holds(network.constraints, bindings, frozenset()):
            key = Decompositions(method.name, task, tuple(subtask for subtask in subtasks if subtask))
            self.methods.setdefault(key, []).append((method.precondition, bindings))

    def run(self) -> NaiveGrounding:
        while True:
            before = len(self.actions), len(self.methods)
            self.reach_literals()
            self.methods = {
                key: conditions
                for key, conditions in self.methods.items()
                if any(self.is_satisfiable(formula, bindings) for formula, bindings in conditions)
            }
            self.keep_finite()
            needed = self.keep_needed()
            if (len(self.actions), len(self.methods)) == before:
                tasks = needed - self.actions.keys() - {INITIAL}
                methods = frozenset(key for key in self.methods if key.task != INITIAL)
                return NaiveGrounding(frozenset(self.actions), frozenset(tasks), methods)

    def reach_literals(self) -> None:
        """Find all literals that the present actions can make true, and drop the actions that cannot be executed."""
        everything = [fact for predicate in self.problem.domain.predicates for fact in self.facts(predicate)]
        initial = self.problem.initial_state
        self.reached = {(fact, fact in initial) for fact in {*everything, *initial}}
        while True:
            before = len(self.reached)
            executable = {
                key: bindings
                for key, bindings in self.actions.items()
                if self.is_satisfiable(self.problem.domain.actions[key[0]].precondition, bindings)
            }
            for key, bindings in executable.items():
                self.reached |= set(self.changes(key[0], bindings))
            if len(self.reached) == before:
                self.actions = executable
                return

    def facts(self, predicate: str) -> Iterator[Fact]:
        """All atoms of a predicate over any objects, whatever its types."""
        count = len(self.problem.domain.predicates[predicate].parameters)
        for arguments in itertools.product(self.problem.all_objects, repeat=count):
            yield (predicate, *arguments)

    def changes(self, name: str, bindings: Bindings) -> Iterator[Literal]:
        action = self.problem.domain.actions[name]
        always = {self.atom(effect.atom, bindings) for effect in action.effects if effect.positive and is_plain(effect)}
        for effect in action.effects:
            for more in self.semantics.all_bindings(effect.parameters):
                inner = {**bindings, **more}
                fact = self.atom(effect.atom, inner)
                if not effect.positive and fact in always:
                    continue
                happens = [(effect.condition, inner)]
                if self.joint:
                    happens.append((action.precondition, bindings))
                    happens += [] if effect.positive else self.keeping(action, fact, bindings)
                if self.is_satisfiable_at_once(happens):
                    yield fact, effect.positive

    def keeping(self, action: Action, fact: Fact, bindings: Bindings) -> Iterator[tuple[Formula, Bindings]]:
        """Yield the conditions on which no effect of the action adds a fact."""
        for effect in action.effects:
            for more in self.semantics.all_bindings(effect.parameters):
                inner = {**bindings, **more}
                if effect.positive and self.atom(effect.atom, inner) == fact:
                    yield Not(effect.condition), inner

    def atom(self, atom: Atom, bindings: Bindings) -> Fact:
        return (atom.predicate, *(bindings.get(term, term) for term in atom.arguments))

    def is_satisfiable(self, formula: Formula, bindings: Bindings) -> bool:
        return self.is_satisfiable_at_once([(formula, bindings)])

    def is_satisfiable_at_once(self, formulas: list[tuple[Formula, Bindings]]) -> bool:
        """Tell whether reached truth values, one for each fact, make all formulas true."""
        facts = sorted({fact for formula, bindings in formulas for fact in self.atoms(formula, bindings)})
        values = [[value for value in (False, True) if (fact, value) in self.reached] for fact in facts]
        states = (frozenset(itertools.compress(facts, chosen)) for chosen in itertools.product(*values))
        return any(all(self.semantics.holds(*formula, state) for formula in formulas) for state in states)

    def atoms(self, formula: Formula, bindings: Bindings) -> Iterator[Fact]:
        match formula:
            case Atom():
                yield self.atom(formula, bindings)
            case Not(operand):
                yield from self.atoms(operand, bindings)
            case And(operands) | Or(operands):
                for operand in operands:
                    yield from self.atoms(operand, bindings)
            case Exists(parameters, body) | Forall(parameters, body):
                for more in self.semantics.all_bindings(parameters):
                    yield from self.atoms(body, {**bindings, **more})

    def keep_finite(self) -> None:
        """Drop methods with a subtask that has no finite decomposition."""
        finite: set[GroundTask] = set(self.actions)
        while True:
            new = {key.task for key in self.methods if finite.issuperset(key.subtasks)} - finite
            if not new:
                break
            finite |= new
        self.methods = {key: value for key, value in self.methods.items() if finite.issuperset(key.subtasks)}

    def keep_needed(self) -> set[GroundTask]:
        needed: set[GroundTask] = {INITIAL}
        if not any(key.task == INITIAL for key in self.methods):
            needed.clear()
        while True:
            new = {subtask for key in self.methods if key.task in needed for subtask in key.subtasks} - needed
            if not new:
                break
            needed |= new
        self.methods = {key: value for key, value in self.methods.items() if key.task in needed}
        self.actions = {key: value for key, value in self.actions.items() if key in needed}
        return needed


def is_plain(effect: Effect) -> bool:
    """Tell whether an effect happens once, whatever the state."""
    return effect.condition == TRUE and not effect.parameters
