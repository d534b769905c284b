"""What a method or an action asks of its variables, and the bindings that give it, on a level of the relaxation."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import count

from statehtn.explanation.relation import EMPTY, Relation
from statehtn.explanation.relaxation import Relaxation
from statehtn.limits import Limits
from statehtn.model import And, Atom, Equals, Exists, Forall, Formula, Not, OfType, Or, Parameter, Subtask
from statehtn.model.formula import free_variables, is_variable

Binding = dict[str, str]
Domains = Mapping[str, tuple[str, ...]]
"""The objects that each variable may stand for."""
CHECK_EVERY = 1024


@dataclass(frozen=True, slots=True)
class Part:
    """One thing that is asked: a fact, a task that can be accomplished, or a condition that is only tested.

    Args:
        formula: an atom, or another formula; None for a task.
        task: a subtask; None for a formula.
    """

    formula: Formula | None = None
    task: Subtask | None = None

    @property
    def terms(self) -> tuple[str, ...]:
        """The arguments, where the part has a relation."""
        if self.task is not None:
            return self.task.arguments
        return self.formula.arguments if isinstance(self.formula, Atom) else ()

    @property
    def is_relational(self) -> bool:
        """Whether the bindings that give it are the rows of a relation."""
        return self.task is not None or isinstance(self.formula, Atom)

    @property
    def variables(self) -> frozenset[str]:
        """The variables that it mentions."""
        if self.is_relational:
            return frozenset(filter(is_variable, self.terms))
        assert self.formula is not None
        return frozenset(free_variables(self.formula))

    def relation(self, level: Relaxation) -> Relation:
        """Return the rows that give it on a level."""
        if self.task is not None:
            return level.able.get(self.task.task, EMPTY)
        assert isinstance(self.formula, Atom)
        return level.true.get(self.formula.predicate, EMPTY)


def parts_of(formula: Formula, parameters: dict[str, tuple[str, ...]]) -> Iterator[Part]:
    """Yield the parts of a conjunction; variables of `exists` become parameters, under names of their own."""
    match formula:
        case And(operands):
            for operand in operands:
                yield from parts_of(operand, parameters)
        case Not(Not(operand)):
            yield from parts_of(operand, parameters)
        case Not(Or(operands)):
            for operand in operands:
                yield from parts_of(Not(operand), parameters)
        case Exists(bound, body):
            names = {}
            for parameter in bound:
                new = (f"{parameter.name}{suffix}" for suffix in ("", *(f"_{number}" for number in range(1, 99))))
                names[parameter.name] = next(name for name in new if name not in parameters)
                parameters[names[parameter.name]] = parameter.types
            yield from parts_of(renamed(body, names), parameters)
        case _:
            yield Part(formula)


def renamed(formula: Formula, names: Mapping[str, str]) -> Formula:
    """Return a formula with other terms in the place of some of its free variables."""
    match formula:
        case Atom(predicate, terms):
            return Atom(predicate, tuple(names.get(term, term) for term in terms))
        case Equals(left, right):
            return Equals(names.get(left, left), names.get(right, right))
        case OfType(term, types):
            return OfType(names.get(term, term), types)
        case Not(operand):
            return Not(renamed(operand, names))
        case And(operands):
            return And(tuple(renamed(operand, names) for operand in operands))
        case Or(operands):
            return Or(tuple(renamed(operand, names) for operand in operands))
        case Exists(parameters, body):
            return Exists(parameters, renamed(body, _outside(names, parameters)))
        case Forall(parameters, body):
            return Forall(parameters, renamed(body, _outside(names, parameters)))


def _outside(names: Mapping[str, str], parameters: Sequence[Parameter]) -> dict[str, str]:
    bound = {parameter.name for parameter in parameters}
    return {name: term for name, term in names.items() if name not in bound}


def possible(formula: Formula, level: Relaxation, binding: Mapping[str, str], positive: bool = True) -> bool:
    """Tell whether a formula, or its negation, can hold at some time, its facts taken one by one."""
    problem = level.problem
    match formula:
        case Atom(predicate, terms):
            row = tuple(binding.get(term, term) for term in terms)
            return row in level.true.get(predicate, EMPTY) if positive else level.can_be_false((predicate, *row))
        case Equals(left, right):
            return (binding.get(left, left) == binding.get(right, right)) == positive
        case OfType(term, types):
            kind = problem.all_objects[binding.get(term, term)]
            return problem.domain.types.is_subtype(kind, types) == positive
        case Not(operand):
            return possible(operand, level, binding, not positive)
        case And(operands) | Or(operands):
            each = (possible(operand, level, binding, positive) for operand in operands)
            return all(each) if isinstance(formula, And) == positive else any(each)
        case Exists(parameters, body) | Forall(parameters, body):
            bindings = _all_bindings(parameters, level, binding)
            each = (possible(body, level, inner, positive) for inner in bindings)
            return any(each) if isinstance(formula, Exists) == positive else all(each)


def _all_bindings(parameters: Sequence[Parameter], level: Relaxation, binding: Mapping[str, str]) -> Iterator[Binding]:
    if not parameters:
        yield dict(binding)
        return
    for name in level.problem.objects_of(parameters[0].types):
        yield from _all_bindings(parameters[1:], level, {**binding, parameters[0].name: name})


@dataclass(frozen=True)
class Query:
    """Variables with their objects, and what is asked of them on a level."""

    domains: Domains
    parts: tuple[Part, ...]
    level: Relaxation
    limits: Limits = Limits()

    def has_answer(self, parts: Sequence[Part] | None = None) -> bool:
        """Tell whether some binding gives all the parts, or these of them."""
        return next(self.answers(parts), None) is not None

    def answers(self, parts: Sequence[Part] | None = None) -> Iterator[Binding]:
        """Yield bindings of the variables of all the parts, or of these, that give them."""
        chosen = list(self.parts if parts is None else parts)
        if any(not objects for objects in self.domains.values()):
            return
        start = {name: objects[0] for name, objects in self.domains.items() if len(objects) == 1}
        allowed = {name: frozenset(objects) for name, objects in self.domains.items()}
        steps = count(1)

        def extended(binding: Binding, left: list[Part]) -> Iterator[Binding]:
            if not next(steps) % CHECK_EVERY:
                self.limits.check()
            tests = [part for part in left if not part.is_relational and part.variables <= binding.keys()]
            for test in tests:
                assert test.formula is not None
                if not possible(test.formula, self.level, binding):
                    return
            left = [part for part in left if part not in tests]
            relational = [part for part in left if part.is_relational]
            if not left:
                if not _contradict(chosen, binding):
                    yield binding
            elif relational:
                rows, part = min(((self._rows(part, binding), part) for part in relational), key=lambda it: len(it[0]))
                rest = [other for other in left if other is not part]
                for row in rows:
                    wider = _matched(part.terms, row, binding, allowed)
                    if wider is not None:
                        yield from extended(wider, rest)
            else:
                free = {name for part in left for name in part.variables - binding.keys()}
                name = min(free, key=lambda name: (len(allowed[name]), name))
                for value in self.domains[name]:
                    yield from extended({**binding, name: value}, left)

        yield from extended(start, chosen)

    def _rows(self, part: Part, binding: Binding) -> Sequence[tuple[str, ...]]:
        known = tuple(position for position, term in enumerate(part.terms) if not is_variable(term) or term in binding)
        values = tuple(binding.get(part.terms[position], part.terms[position]) for position in known)
        return part.relation(self.level).matching(known, values)

    def cores(self) -> list[tuple[Part, ...]]:
        """Return why there is no answer: every part that has none alone, or else a smallest set that has none together.

        Every variable has objects.
        """
        alone: list[tuple[Part, ...]] = [(part,) for part in self.parts if not self.has_answer([part])]
        if alone:
            return alone
        core = list(self.parts)
        for part in reversed(self.parts):
            rest = [other for other in core if other is not part]
            if not self.has_answer(rest):
                core = rest
        return [tuple(core)]


def _contradict(parts: Sequence[Part], binding: Binding) -> bool:
    """Tell whether one of the parts is the negation of another one under a binding."""
    atoms = {_ground(part.formula, binding) for part in parts if isinstance(part.formula, Atom)}
    denied = (part.formula.operand for part in parts if isinstance(part.formula, Not))
    return any(_ground(operand, binding) in atoms for operand in denied if isinstance(operand, Atom))


def _ground(atom: Atom, binding: Binding) -> tuple[str, ...]:
    return (atom.predicate, *(binding.get(term, term) for term in atom.arguments))


def _matched(
    terms: Sequence[str], row: Sequence[str], binding: Binding, allowed: Mapping[str, frozenset[str]]
) -> Binding | None:
    """Return the binding under which terms are a row; None if there is none."""
    wider = dict(binding)
    for term, value in zip(terms, row, strict=True):
        if not is_variable(term):
            if term != value:
                return None
        elif wider.setdefault(term, value) != value or value not in allowed[term]:
            return None
    return wider
