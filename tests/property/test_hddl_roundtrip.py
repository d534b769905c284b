"""Writing a problem and reading it again gives an equal problem, for random problems with all features."""

from __future__ import annotations

import warnings
from dataclasses import dataclass
from fractions import Fraction

from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from statehtn.hddl import read_hddl_text, write_hddl
from statehtn.model import (
    TRUE,
    Action,
    And,
    Arithmetic,
    Atom,
    CostBlock,
    Domain,
    Effect,
    Equals,
    Exists,
    Expression,
    Forall,
    Formula,
    FunctionTerm,
    Method,
    Not,
    Number,
    OfType,
    Or,
    Outcome,
    OutcomeBlock,
    Parameter,
    Problem,
    Signature,
    Subtask,
    TaskNetwork,
    TypeHierarchy,
)
from statehtn.model.cost.expressions import constant_value
from tests.strategies import between, pick

KINDS = ("t0", "t1", "t2", "t3")
CONSTANTS = ("c0", "t1")  # some have the name of a type, a predicate or a task
OBJECTS = ("o0", "p0", "task0")
TYPES = st.lists(st.sampled_from(KINDS), min_size=1, max_size=2, unique=True)
PARAMETER_TYPES = st.lists(st.sampled_from((*KINDS, "object")), min_size=1, max_size=2, unique=True)
LABELS = ("s0", "task0", "t0", "x|y")
NUMBERS = st.one_of(
    st.integers(0, 10**6).map(Fraction),
    st.decimals(0, 1000, places=4).map(Fraction),
    st.floats(0, 1e9, allow_nan=False).map(Fraction),
    st.fractions(0, 100, max_denominator=30),
)


@dataclass(frozen=True)
class Names:
    """What may be used at some place of a problem."""

    types: TypeHierarchy
    objects: dict[str, str]
    predicates: dict[str, Signature]
    functions: dict[str, Signature]
    tasks: dict[str, Signature]
    variables: tuple[Parameter, ...] = ()

    def inside(self, parameters: tuple[Parameter, ...]) -> Names:
        return Names(
            self.types, self.objects, self.predicates, self.functions, self.tasks, (*self.variables, *parameters)
        )

    def terms(self, types: tuple[str, ...]) -> list[str]:
        """List the variables and objects that an argument of these types allows."""
        variables = [variable.name for variable in self.variables if set(variable.types) & set(types)]
        return variables + [name for name, kind in self.objects.items() if self.types.is_subtype(kind, types)]


def parameters(draw: st.DrawFn, prefix: str, most: int = 3) -> tuple[Parameter, ...]:
    drawn = [draw(PARAMETER_TYPES) for _ in range(between(draw, 0, most))]
    return tuple(Parameter(f"?{prefix}{index}", tuple(types)) for index, types in enumerate(drawn))


def signatures(draw: st.DrawFn, prefix: str, most: int = 3) -> dict[str, Signature]:
    drawn = [parameters(draw, "x", 2) for _ in range(between(draw, 1, most))]
    return {f"{prefix}{index}": Signature(f"{prefix}{index}", found) for index, found in enumerate(drawn)}


def arguments(draw: st.DrawFn, names: Names, declared: dict[str, Signature]) -> tuple[str, ...] | None:
    """Draw a name and arguments that it allows; None where there are none."""
    signature = pick(draw, list(declared.values()))
    choices = [names.terms(parameter.types) for parameter in signature.parameters]
    return (signature.name, *(pick(draw, terms) for terms in choices)) if all(choices) else None


def formulas(draw: st.DrawFn, names: Names, depth: int = 3, constraint: bool = False) -> Formula:
    everything = [variable.name for variable in names.variables] + list(names.objects)
    form = pick(draw, ("atom", "equals", "type", "not", "and", "or", "exists", "forall")[: 8 if depth else 3])
    if constraint and form in ("atom", "exists", "forall"):
        form = "equals"
    match form:
        case "atom":
            found = arguments(draw, names, names.predicates)
            return Atom(found[0], found[1:]) if found else TRUE
        case "equals" | "type" if not everything:
            return TRUE
        case "equals":
            return Equals(pick(draw, everything), pick(draw, everything))
        case "type":
            types = draw(TYPES)
            return OfType(pick(draw, everything), tuple(types))
        case "not":
            return Not(formulas(draw, names, depth - 1, constraint))
        case "and" | "or":
            operands = tuple(formulas(draw, names, depth - 1, constraint) for _ in range(between(draw, 0, 3)))
            return And(operands) if form == "and" else Or(operands)
    bound = parameters(draw, f"q{depth}")
    body = formulas(draw, names.inside(bound), depth - 1)
    return Exists(bound, body) if form == "exists" else Forall(bound, body)


def expressions(draw: st.DrawFn, names: Names, depth: int = 2) -> Expression:
    form = pick(draw, ("number", "number", "function", "+", "-", "*")[: 6 if depth else 3])
    if form == "number":
        return Number(draw(NUMBERS))
    if form == "function":
        found = arguments(draw, names, names.functions)
        return FunctionTerm(found[0], found[1:]) if found else Number(Fraction(1))
    return Arithmetic(form, tuple(expressions(draw, names, depth - 1) for _ in range(between(draw, 1, 3))))


def costs(draw: st.DrawFn, names: Names) -> Expression:
    """Draw an expression that is not a negative constant."""
    cost = expressions(draw, names)
    return Number(Fraction(0)) if (constant_value(cost) or 0) < 0 else cost


def probabilities_of_branches(draw: st.DrawFn, names: Names) -> list[Expression]:
    weights = [between(draw, 1, 9) for _ in range(between(draw, 1, 3))]
    probabilities: list[Expression] = [Number(Fraction(weight, sum(weights))) for weight in weights]
    if draw(st.booleans()) and (found := arguments(draw, names, names.functions)):
        probabilities = [FunctionTerm(found[0], found[1:]), *probabilities[1:]]
    return probabilities


def cost_blocks(draw: st.DrawFn, names: Names) -> CostBlock:
    bound = parameters(draw, "b", 1)
    inner = names.inside(bound)
    condition = formulas(draw, inner, 1) if draw(st.booleans()) else TRUE
    probabilities = probabilities_of_branches(draw, inner)
    return CostBlock(tuple((probability, costs(draw, inner)) for probability in probabilities), condition, bound)


def effects(draw: st.DrawFn, names: Names) -> list[Effect]:
    bound = parameters(draw, "e", 1)
    found = arguments(draw, names.inside(bound), names.predicates)
    if not found:
        return []
    condition = formulas(draw, names.inside(bound), 1) if draw(st.booleans()) else TRUE
    return [Effect(Atom(found[0], found[1:]), draw(st.booleans()), condition, bound)]


def outcome_blocks(draw: st.DrawFn, names: Names) -> list[OutcomeBlock]:
    """Draw a block of outcomes; nothing where none of them would change a fact."""
    bound = parameters(draw, "k", 1)
    inner = names.inside(bound)
    condition = formulas(draw, inner, 1) if draw(st.booleans()) else TRUE
    outcomes = []
    for probability in probabilities_of_branches(draw, inner):
        changes = [effect for _ in range(between(draw, 0, 2)) for effect in effects(draw, inner)]
        blocks = tuple(cost_blocks(draw, inner) for _ in range(between(draw, 0, 1)))
        outcomes.append(Outcome(probability, tuple(changes), blocks))
    changed = any(outcome.effects for outcome in outcomes)
    return [OutcomeBlock(tuple(outcomes), condition, bound)] if changed else []


def networks(draw: st.DrawFn, names: Names) -> TaskNetwork:
    found = [task for _ in range(between(draw, 0, 4)) if (task := arguments(draw, names, names.tasks))]
    subtasks = tuple(Subtask(label, task[0], task[1:]) for label, task in zip(LABELS, found, strict=False))
    pairs = [(i, j) for i in range(len(found)) for j in range(i + 1, len(found))]
    chain = [(i, i + 1) for i in range(len(found) - 1)]
    ordering = draw(st.one_of(st.just(chain), st.lists(st.sampled_from(pairs), unique=True))) if pairs else []
    constraints = formulas(draw, names, 2, constraint=True) if draw(st.booleans()) else TRUE
    return TaskNetwork(subtasks, tuple(ordering), constraints)


def domains(draw: st.DrawFn) -> tuple[Domain, Names]:
    above = [("object",), (), ("t0",), ("t0", "t1")]
    types = TypeHierarchy({kind: pick(draw, above[: index + 1]) for index, kind in enumerate(KINDS)})
    constants = dict(zip(CONSTANTS, [pick(draw, KINDS) for _ in range(between(draw, 0, 2))], strict=False))
    predicates, functions, compound = signatures(draw, "p"), signatures(draw, "f"), signatures(draw, "task")
    primitive = signatures(draw, "act", 2)
    names = Names(types, constants, predicates, functions, {**compound, **primitive})
    actions = {}
    for name, signature in primitive.items():
        inner = names.inside(signature.parameters)
        drawn = [effect for _ in range(between(draw, 0, 3)) for effect in effects(draw, inner)]
        blocks = tuple(cost_blocks(draw, inner) for _ in range(between(draw, 0, 2)))
        chosen = tuple(block for _ in range(between(draw, 0, 2)) for block in outcome_blocks(draw, inner))
        actions[name] = Action(name, signature.parameters, formulas(draw, inner), tuple(drawn), blocks, chosen)
    methods = {}
    for index in range(between(draw, 0, 2)):
        bound = parameters(draw, "m")
        inner = names.inside(bound)
        if head := arguments(draw, inner, compound):
            method = Method(f"m{index}", bound, head[0], head[1:], networks(draw, inner), formulas(draw, inner))
            methods[method.name] = method
    return Domain("d", types, constants, predicates, functions, compound, actions, methods), names


@st.composite
def problems(draw: st.DrawFn) -> Problem:
    domain, names = domains(draw)
    objects = dict(zip(OBJECTS, [pick(draw, KINDS) for _ in range(between(draw, 0, 3))], strict=False))
    ground = Names(names.types, {**names.objects, **objects}, names.predicates, names.functions, names.tasks)
    bound = parameters(draw, "h", 2)
    facts = frozenset(fact for _ in range(between(draw, 0, 5)) if (fact := arguments(draw, ground, ground.predicates)))
    keys = {key for _ in range(between(draw, 0, 4)) if (key := arguments(draw, ground, ground.functions))}
    values = {key: draw(NUMBERS) * pick(draw, (1, -1)) for key in sorted(keys)}
    network = networks(draw, ground.inside(bound))
    return Problem("p", domain, objects, bound, network, facts, values, formulas(draw, ground))


@settings(deadline=None, suppress_health_check=[HealthCheck.too_slow, HealthCheck.data_too_large])
@given(problems())
def test_reading_what_was_written_gives_the_same_problem(problem: Problem) -> None:
    domain, text = write_hddl(problem)
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        again = read_hddl_text(domain, text)
    told: tuple[str, ...] = ("leads to no plan", "there is no plan")
    if not problem_is_complete(problem):
        told += ("the rest it costs 0", "the rest nothing happens")
    assert [one for one in caught if not str(one.message).endswith(told)] == []
    assert again == problem
    assert write_hddl(again) == (domain, text)


def problem_is_complete(problem: Problem) -> bool:
    """Tell whether no block leaves some probability over, which would be a warning."""
    actions = problem.domain.actions.values()
    costs = [block for action in actions for block in action.all_costs]
    sums = [[constant_value(probability) for probability, _ in block.branches] for block in costs]
    sums += [[constant_value(one.probability) for one in block.outcomes] for a in actions for block in a.outcomes]
    return all(None in found or sum(value for value in found if value is not None) == 1 for found in sums)
