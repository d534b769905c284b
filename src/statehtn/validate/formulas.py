"""The validator's own evaluation of formulas: truth under bindings, and bindings under which a formula is true."""

from __future__ import annotations

import itertools
from collections.abc import Iterable, Iterator, Mapping

from statehtn.model.formula import And, Atom, Equals, Exists, Forall, Formula, Not, OfType, Or, free_variables
from statehtn.model.types import Parameter
from statehtn.validate.world import State, World, substitute

Bindings = Mapping[str, str]


def holds(formula: Formula, bindings: Bindings, state: State, world: World) -> bool:
    """Tell whether a formula is true in a state; the bindings cover its free variables."""
    match formula:
        case Atom(predicate, terms):
            return state.holds((predicate, *substitute(terms, bindings)))
        case Equals(left, right):
            return bindings.get(left, left) == bindings.get(right, right)
        case OfType(term, types):
            return world.is_of_type(bindings.get(term, term), types)
        case Not(operand):
            return not holds(operand, bindings, state, world)
        case And(operands):
            return all(holds(operand, bindings, state, world) for operand in operands)
        case Or(operands):
            return any(holds(operand, bindings, state, world) for operand in operands)
        case Exists(parameters, body):
            return is_satisfiable(body, parameters, bindings, state, world)
        case Forall(parameters, body):
            return not is_satisfiable(Not(body), parameters, bindings, state, world)


def is_satisfiable(
    formula: Formula, parameters: Iterable[Parameter], bindings: Bindings, state: State, world: World
) -> bool:
    """Tell whether the parameters can be bound to objects of their types so that the formula is true."""
    return next(solutions(formula, parameters, bindings, state, world), None) is not None


def solutions(
    formula: Formula, parameters: Iterable[Parameter], bindings: Bindings, state: State, world: World
) -> Iterator[Bindings]:
    """Yield, each once, the extensions of the bindings by the parameters under which the formula is true."""
    unbound = {parameter.name: parameter for parameter in parameters}
    outer = {name: value for name, value in bindings.items() if name not in unbound}
    return _search(conjuncts(formula), unbound, outer, state, world)


def _search(
    formulas: list[Formula], unbound: dict[str, Parameter], bindings: Bindings, state: State, world: World
) -> Iterator[Bindings]:
    open_formulas: list[Formula] = []
    for formula in formulas:
        if any(name in unbound for name in free_variables(formula)):
            open_formulas.append(formula)
        elif not holds(formula, bindings, state, world):
            return
    if not open_formulas:
        domains = [world.objects(parameter.types) for parameter in unbound.values()]
        for objects in itertools.product(*domains):
            yield {**bindings, **dict(zip(unbound, objects, strict=True))}
        return
    for extension in _candidates(open_formulas, unbound, bindings, state, world):
        rest = {name: parameter for name, parameter in unbound.items() if name not in extension}
        yield from _search(open_formulas, rest, {**bindings, **extension}, state, world)


def _candidates(
    formulas: list[Formula], unbound: dict[str, Parameter], bindings: Bindings, state: State, world: World
) -> list[dict[str, str]]:
    """Return ways to bind some variables: as facts of the most selective atom, or one variable to any object."""
    atoms = [formula for formula in formulas if isinstance(formula, Atom)]
    if atoms:
        return min((_matches(atom, unbound, bindings, state, world) for atom in atoms), key=len)
    name = next(name for name in free_variables(formulas[0]) if name in unbound)
    return [{name: value} for value in world.objects(unbound[name].types)]


def _matches(
    atom: Atom, unbound: dict[str, Parameter], bindings: Bindings, state: State, world: World
) -> list[dict[str, str]]:
    found = []
    for _, *objects in state.facts_of(atom.predicate):
        known = dict(bindings)
        if world.unify(atom.arguments, tuple(objects), known):
            extension = {name: known[name] for name in atom.arguments if name in unbound}
            if all(world.is_of_type(value, unbound[name].types) for name, value in extension.items()):
                found.append(extension)
    return found


def conjuncts(formula: Formula) -> list[Formula]:
    """Return formulas whose conjunction is the formula; negations are moved inwards where that gives more of them."""
    match formula:
        case And(operands):
            return [part for operand in operands for part in conjuncts(operand)]
        case Not(Or(operands)):
            return [part for operand in operands for part in conjuncts(Not(operand))]
        case Not(Not(operand)):
            return conjuncts(operand)
    return [formula]


def predicates(formula: Formula) -> Iterator[str]:
    """Yield the predicates of a formula, with repetitions."""
    match formula:
        case Atom(predicate):
            yield predicate
        case Not(operand):
            yield from predicates(operand)
        case And(operands) | Or(operands):
            for operand in operands:
                yield from predicates(operand)
        case Exists(_, body) | Forall(_, body):
            yield from predicates(body)


def why_false(formula: Formula, bindings: Bindings, state: State, world: World) -> str:
    """Name the parts of a false conjunction that are false; the bindings cover its free variables."""
    false = [part for part in conjuncts(formula) if not holds(part, bindings, state, world)]
    return ", ".join(f"{text(part, bindings)} is false" for part in false)


def text(formula: Formula, bindings: Bindings) -> str:
    """Print a formula as in HDDL, its bound variables replaced by their objects."""
    match formula:
        case Atom(name, terms):
            return f"({' '.join((name, *substitute(terms, bindings)))})"
        case Equals(left, right):
            return f"(= {bindings.get(left, left)} {bindings.get(right, right)})"
        case OfType(term, types):
            return f"(sortof {bindings.get(term, term)} - {' or '.join(types)})"
        case Not(operand):
            return f"(not {text(operand, bindings)})"
        case And(operands) | Or(operands):
            word = "and" if isinstance(formula, And) else "or"
            return f"({' '.join([word, *(text(operand, bindings) for operand in operands)])})"
        case Exists(parameters, body) | Forall(parameters, body):
            word = "exists" if isinstance(formula, Exists) else "forall"
            names = {parameter.name for parameter in parameters}
            outer = {name: value for name, value in bindings.items() if name not in names}
            return f"({word} ({' '.join(map(str, parameters))}) {text(body, outer)})"
