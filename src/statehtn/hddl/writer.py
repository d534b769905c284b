"""Writes problems as HDDL; reading the text again gives an equal problem."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from fractions import Fraction

from statehtn.errors import UnsupportedError
from statehtn.hddl.cost_reader import TOTAL_COST
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
    OutcomeBlock,
    Parameter,
    Problem,
    Signature,
    TaskNetwork,
    TypeHierarchy,
)
from statehtn.model.chance import Chance
from statehtn.model.expect import expect_problem

REQUIREMENTS = (
    "hierarchy",
    "typing",
    "equality",
    "negative-preconditions",
    "disjunctive-preconditions",
    "universal-preconditions",
    "existential-preconditions",
    "conditional-effects",
    "method-preconditions",
)


def write_hddl(problem: Problem) -> tuple[str, str]:
    """Return the texts of the domain and of the problem.

    Names must be such as HDDL can write (`statehtn.hddl.spelling.is_name`), and those of one kind differ by more than
    case, as the names that the reader and the builder give.

    Raises:
        UnsupportedError: a cost is a Python callable, which has no HDDL form.
    """
    return "\n".join(_domain(expect_problem(problem).domain)) + "\n", "\n".join(_problem(problem)) + "\n"


def _domain(domain: Domain) -> Iterator[str]:
    costs = [] if domain.has_unit_costs else ["action-costs"]
    if domain.has_outcomes or not domain.has_unit_costs:
        costs.append("probabilistic-effects")
    yield f"(define (domain {domain.name})"
    yield f"  (:requirements {' '.join(f':{word}' for word in (*REQUIREMENTS, *costs))})"
    yield from _section("types", _types(domain.types))
    yield from _section("constants", _objects(domain.constants))
    yield from _section("predicates", map(_signature, domain.predicates.values()))
    functions = [f"{_signature(signature)} - number" for signature in domain.functions.values()]
    if not domain.has_unit_costs:
        functions.append(f"({TOTAL_COST}) - number")
    yield from _section("functions", functions)
    for task in domain.tasks.values():
        yield f"  (:task {task.name} :parameters ({_parameters(task.parameters)}))"
    for method in domain.methods.values():
        yield from _method(method)
    for action in domain.actions.values():
        yield from _action(action)
    yield ")"


def _problem(problem: Problem) -> Iterator[str]:
    yield f"(define (problem {problem.name})"
    yield f"  (:domain {problem.domain.name})"
    yield from _section("objects", _objects(problem.objects))
    yield "  (:htn"
    yield f"    :parameters ({_parameters(problem.parameters)})"
    yield from _network(problem.network)
    yield "  )"
    yield "  (:init"
    yield from (f"    ({' '.join(fact)})" for fact in sorted(problem.initial_state))
    yield from (f"    {_chance(chance)}" for chance in problem.chances)
    yield from (f"    (= ({' '.join(key)}) {_number(value)})" for key, value in problem.function_values.items())
    yield "  )"
    if problem.goal != TRUE:
        yield f"  (:goal {formula_text(problem.goal)})"
    if not problem.domain.has_unit_costs:
        yield f"  (:metric minimize ({TOTAL_COST}))"
    yield ")"


def _chance(chance: Chance) -> str:
    branches = []
    for outcome in chance.outcomes:
        facts = (f"({' '.join(fact)})" for fact in sorted(outcome.facts))
        branches.append(f"{_number(outcome.probability)} ({' '.join(('and', *facts))})")
    return f"(probabilistic {' '.join(branches)})"


def _section(name: str, lines: Iterable[str]) -> Iterator[str]:
    """Yield a section of one line for each item; nothing if there are none."""
    body = [f"    {line}" for line in lines]
    if body:
        yield f"  (:{name}"
        yield from body
        yield "  )"


def _types(hierarchy: TypeHierarchy) -> Iterator[str]:
    """Yield one line for each supertype; types without one come last, where no '-' follows that would take them in."""
    yield from (f"{name} - {above}" for name, parents in hierarchy.parents.items() for above in parents)
    yield from (name for name, parents in hierarchy.parents.items() if not parents)


def _objects(objects: Mapping[str, str]) -> Iterator[str]:
    yield from (f"{name} - {kind}" for name, kind in objects.items())


def _signature(signature: Signature) -> str:
    return f"({' '.join((signature.name, *map(str, signature.parameters)))})"


def _parameters(parameters: Iterable[Parameter]) -> str:
    return " ".join(map(str, parameters))


def _action(action: Action) -> Iterator[str]:
    costs = [_cost_block(block, action) for given in action.costs for block in given.by_conditions]
    effects = [*map(_effect, action.effects), *costs, *(_outcome_block(block, action) for block in action.outcomes)]
    yield f"  (:action {action.name}"
    yield f"    :parameters ({_parameters(action.parameters)})"
    yield f"    :precondition {formula_text(action.precondition)}"
    if effects:
        yield "    :effect (and"
        yield from (f"      {effect}" for effect in effects)
        yield "    )"
    yield "  )"


def _effect(effect: Effect) -> str:
    literal = str(effect.atom) if effect.positive else f"(not {effect.atom})"
    return _conditional(literal, effect.condition, effect.parameters)


def _cost_block(block: CostBlock, action: Action) -> str:
    if block.external is not None:
        raise UnsupportedError(
            f"the cost of action '{action.name}' is a Python callable and cannot be written as HDDL; "
            f"statehtn.tabulate_costs(problem) gives an equivalent problem with numbers"
        )
    block = block.listed
    if block.law is not None:
        raise UnsupportedError(
            f"the cost of action '{action.name}' is {block.law}, which HDDL cannot state; give the action a list of "
            f"outcomes instead, such as law.discretised(20)"
        )
    match block.branches:
        case ((Number(probability), cost),) if probability == 1:
            text = _increase(cost)
        case branches:
            text = f"(probabilistic {' '.join(f'{expression_text(p)} {_increase(cost)}' for p, cost in branches)})"
    return _conditional(text, block.condition, block.parameters)


def _outcome_block(block: OutcomeBlock, action: Action) -> str:
    branches = []
    for outcome in block.outcomes:
        costs = (_cost_block(part, action) for given in outcome.costs for part in given.by_conditions)
        effects = (*map(_effect, outcome.effects), *costs)
        branches.append(f"{expression_text(outcome.probability)} ({' '.join(('and', *effects))})")
    return _conditional(f"(probabilistic {' '.join(branches)})", block.condition, block.parameters)


def _increase(cost: Expression) -> str:
    return f"(increase ({TOTAL_COST}) {expression_text(cost)})"


def _conditional(text: str, condition: Formula, parameters: tuple[Parameter, ...]) -> str:
    if condition != TRUE:
        text = f"(when {formula_text(condition)} {text})"
    return f"(forall ({_parameters(parameters)}) {text})" if parameters else text


def _method(method: Method) -> Iterator[str]:
    yield f"  (:method {method.name}"
    yield f"    :parameters ({_parameters(method.parameters)})"
    yield f"    :task ({' '.join((method.task, *method.arguments))})"
    if method.precondition != TRUE:
        yield f"    :precondition {formula_text(method.precondition)}"
    yield from _network(method.network)
    yield "  )"


def _network(network: TaskNetwork) -> Iterator[str]:
    """Yield the keywords of a network."""
    if not network.subtasks:
        yield "    :subtasks ()"
    else:
        yield from _ordered(network)
    if network.constraints != TRUE:
        yield f"    :constraints {formula_text(network.constraints)}"


def _ordered(network: TaskNetwork) -> Iterator[str]:
    """Yield subtasks and their order; a chain is written by the order in which they stand."""
    subtasks = network.subtasks
    is_chain = network.ordering == tuple((i, i + 1) for i in range(len(subtasks) - 1))
    yield "    :ordered-subtasks (and" if is_chain else "    :subtasks (and"
    yield from (f"      ({subtask.label} ({' '.join((subtask.task, *subtask.arguments))}))" for subtask in subtasks)
    yield "    )"
    if network.ordering and not is_chain:
        yield "    :ordering (and"
        yield from (f"      (< {subtasks[before].label} {subtasks[after].label})" for before, after in network.ordering)
        yield "    )"


def formula_text(formula: Formula) -> str:
    """Return a formula as HDDL."""
    match formula:
        case Atom():
            return str(formula)
        case Equals(left, right):
            return f"(= {left} {right})"
        case OfType(term, types):
            return f"(sortof {Parameter(term, types)})"
        case Not(operand):
            return f"(not {formula_text(operand)})"
        case And(operands):
            return f"(and{''.join(f' {formula_text(operand)}' for operand in operands)})"
        case Or(operands):
            return f"(or{''.join(f' {formula_text(operand)}' for operand in operands)})"
        case Exists(parameters, body):
            return f"(exists ({_parameters(parameters)}) {formula_text(body)})"
        case Forall(parameters, body):
            return f"(forall ({_parameters(parameters)}) {formula_text(body)})"


def expression_text(expression: Expression) -> str:
    """Return a cost expression as HDDL."""
    match expression:
        case Number(value):
            return _number(value)
        case FunctionTerm(function, arguments):
            return f"({' '.join((function, *arguments))})"
        case Arithmetic(operator, operands):
            return f"({' '.join((operator, *map(expression_text, operands)))})"


def _number(value: Fraction) -> str:
    """Return an exact decimal; a fraction such as 1/3 where there is none."""
    places, rest = 0, value.denominator
    for factor in (2, 5):
        count = 0
        while rest % factor == 0:
            rest //= factor
            count += 1
        places = max(places, count)
    if rest != 1:
        return f"{value.numerator}/{value.denominator}"
    digits = str(abs(value.numerator) * 10**places // value.denominator).rjust(places + 1, "0")
    sign = "-" if value < 0 else ""
    return f"{sign}{digits[: len(digits) - places]}.{digits[len(digits) - places :]}" if places else sign + digits
