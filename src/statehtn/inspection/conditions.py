"""Conditions that contradict themselves: they hold in no state, whatever the problem; and effects that do."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from itertools import combinations

from statehtn.hddl.source_map import ANYTHING, Pattern
from statehtn.inspection.finding import Finding, Level
from statehtn.inspection.subject import Subject, whole_condition
from statehtn.model import Action, And, Atom, Equals, Exists, Formula, Method, Not, OfType, Or, TypeHierarchy
from statehtn.model.formula import TRUE, is_variable
from statehtn.model.types import ROOT_TYPE

Types = Mapping[str, frozenset[str]]
"""The types, the ones below included, that a term can be of."""
MOST_CASES = 200
"""Combinations of the alternatives of a disjunction that are looked at; beyond, nothing is claimed."""


def check_conditions(subject: Subject) -> Iterator[Finding]:
    """Yield preconditions and goals that never hold, and effects that add and delete the same fact."""
    for kind, schema in subject.schemas:
        types = _types_of_terms(subject, schema)
        why = contradiction(whole_condition(schema), types, subject.domain.types)
        if why is not None:
            yield _contradiction(subject, kind, schema, why)
        if isinstance(schema, Action):
            yield from _effects(subject, schema)
    if subject.problem is not None:
        constants = {name: _below(subject.domain.types, (kind,)) for name, kind in subject.problem.all_objects.items()}
        why = contradiction(subject.problem.goal, constants, subject.domain.types)
        if why is not None:
            place = subject.places.in_section(":goal", *why[1])
            message = f"the goal never holds: {why[0]}"
            yield Finding(Level.ERROR, place, message, "leave out one of them", "contradiction")


def _contradiction(
    subject: Subject, kind: str, schema: Action | Method, why: tuple[str, tuple[Pattern, ...]]
) -> Finding:
    reason, pattern = why
    what = "precondition" if isinstance(schema, Action) or schema.precondition != TRUE else "list of constraints"
    place = subject.places.inside("method" if kind == "method" else "task", schema.name, (":precondition",), *pattern)
    message = f"the {what} of {kind} '{schema.name}' never holds: {reason}"
    return Finding(
        Level.WARNING, place, message, "leave out one of them, or correct it", "contradiction", (kind, schema.name)
    )


def _types_of_terms(subject: Subject, schema: Action | Method) -> Types:
    hierarchy = subject.domain.types
    found = {parameter.name: _below(hierarchy, parameter.types) for parameter in schema.parameters}
    found.update((name, _below(hierarchy, (kind,))) for name, kind in subject.domain.constants.items())
    return found


def _below(hierarchy: TypeHierarchy, types: tuple[str, ...]) -> frozenset[str]:
    return frozenset({ROOT_TYPE, *hierarchy.parents}) if ROOT_TYPE in types else hierarchy.subtypes(types)


def contradiction(formula: Formula, types: Types, hierarchy: TypeHierarchy) -> tuple[str, tuple[Pattern, ...]] | None:
    """Return why a formula holds in no state, and where to look for it; None if that is not plain.

    Sound, not complete: each alternative of its disjunctions has a literal and its negation, demands that terms which
    cannot be equal are equal, or that equal ones differ. What is under `forall`, or negated and not a literal, is left
    out.
    """
    first = None
    for number, literals in enumerate(_cases(formula)):
        if number == MOST_CASES:
            return None
        why = _conflict(literals, types, hierarchy)
        if why is None:
            return None
        first = first or why
    return first or ("it is a disjunction of nothing", ())


def _cases(formula: Formula, positive: bool = True) -> Iterator[list[Formula]]:
    """Yield the alternatives of a formula, each as literals that hold together in it."""
    match formula, positive:
        case (Not(operand), _):
            yield from _cases(operand, not positive)
        case (And(operands), True) | (Or(operands), False):
            yield from _products(operands, positive)
        case (Or(operands), True) | (And(operands), False):
            for operand in operands:
                yield from _cases(operand, positive)
        case (Exists(parameters, body), True):
            names = {parameter.name for parameter in parameters}
            for case in _cases(body):  # a literal on a variable of its own says nothing of one outside
                yield [literal for literal in case if names.isdisjoint(_terms(literal))]
        case (Atom() | Equals() | OfType(), _):
            yield [formula if positive else Not(formula)]
        case _:
            yield []


def _products(operands: tuple[Formula, ...], positive: bool) -> Iterator[list[Formula]]:
    """Yield the literals of one alternative of each operand."""
    if not operands:
        yield []
        return
    for rest in _products(operands[:-1], positive):
        for last in _cases(operands[-1], positive):
            yield rest + last


def _terms(literal: Formula) -> tuple[str, ...]:
    match literal:
        case Not(operand):
            return _terms(operand)
        case Atom(_, arguments):
            return arguments
        case Equals(left, right):
            return left, right
        case OfType(term, _):
            return (term,)
    return ()


def _conflict(
    literals: list[Formula], types: Types, hierarchy: TypeHierarchy
) -> tuple[str, tuple[Pattern, ...]] | None:
    """Return why literals do not hold together."""
    one: dict[str, str] = {}  # of the terms that are equal

    def root(term: str) -> str:
        while term in one:
            term = one[term]
        return term

    for literal in literals:
        if isinstance(literal, Equals):
            left, right = root(literal.left), root(literal.right)
            if left == right:
                continue
            pattern = (("=", literal.left, literal.right),)
            if not is_variable(left) and not is_variable(right):
                return f"'{left}' and '{right}' are different objects", pattern
            if types[left].isdisjoint(types[right]):
                return f"no object can be both '{literal.left}' and '{literal.right}', by their types", pattern
            one[left if is_variable(left) else right] = right if is_variable(left) else left
    for literal in literals:
        match literal:
            case Not(Equals(left, right)) if root(left) == root(right):
                return f"{_different(left, right)}", (("=", left, right),)
            case OfType(term, kinds) if types[term].isdisjoint(_below(hierarchy, kinds)):
                return f"'{term}' is never of type {' or '.join(kinds)}", ()
            case Not(OfType(term, kinds)) if types[term] <= _below(hierarchy, kinds):
                return f"'{term}' is always of type {' or '.join(kinds)}", ()
    true = {(a.predicate, *map(root, a.arguments)): a for a in literals if isinstance(a, Atom)}
    for literal in literals:
        if isinstance(literal, Not) and isinstance(literal.operand, Atom):
            atom = literal.operand
            same = true.get((atom.predicate, *map(root, atom.arguments)))
            if same is not None:
                what = "is" if same == atom else f"(the same as {same}, as their terms are equal) is"
                return f"{atom} {what} to be true and false", (("not", ANYTHING), (atom.predicate, *atom.arguments))
    return None


def _different(left: str, right: str) -> str:
    return (
        f"'{left}' is to differ from itself" if left == right else f"'{left}' and '{right}' are to differ and be equal"
    )


def _effects(subject: Subject, action: Action) -> Iterator[Finding]:
    """Yield the facts that an action adds and deletes under the same condition."""
    for one, other in combinations(action.effects, 2):
        if one.positive != other.positive and (one.atom, one.condition, one.parameters) == (
            other.atom,
            other.condition,
            other.parameters,
        ):
            place = subject.places.inside("task", action.name, (":effect",), (one.atom.predicate, *one.atom.arguments))
            message = f"action '{action.name}' adds and deletes {one.atom}; adding wins"
            yield Finding(
                Level.WARNING, place, message, "leave out one of the two", "added-and-deleted", ("action", action.name)
            )
