"""Random small problems, for Hypothesis: everything of the language at a size that can be solved exhaustively.

Problems are lifted, over one to three objects of one or two types. Recursion costs something nearly always (a method
that leads back has an action that does), so that an optimum is found, but it need not end.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cache
from typing import TypeVar

from hypothesis import strategies as st

from statehtn.core.grounding import GroundingSwitches
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
    Or,
    Parameter,
    Problem,
    Signature,
    Subtask,
    TaskNetwork,
    TypeHierarchy,
)
from statehtn.risk import Utility, utility_for

Draw = st.DrawFn
T = TypeVar("T")
COSTS = tuple(map(Fraction, ("1", "2", "3", "0.5", "2.5", "10", "0")))
TENTHS = tuple(Fraction(i, 10) for i in range(1, 10))
FUNCTION = "price"
ORDERS = ("total", "partial", "none")


@dataclass(frozen=True)
class Names:
    """What formulas and networks are made of."""

    types: tuple[str, ...]
    predicates: dict[str, Signature]
    objects: dict[str, str]

    def parameters(self, draw: Draw, most: int, prefix: str) -> tuple[Parameter, ...]:
        count = between(draw, 0, most)
        return tuple(Parameter(f"?{prefix}{i}", (pick(draw, self.types),)) for i in range(count))

    def term(self, draw: Draw, kind: str, scope: tuple[Parameter, ...]) -> str:
        """A variable or an object for a parameter of this type; mostly one that fits, rarely one that may not."""
        fitting = [parameter.name for parameter in scope if parameter.types[0] == kind or kind == "thing"]
        fitting += [name for name, its in self.objects.items() if its == kind or kind == "thing"] if not fitting else []
        others = [parameter.name for parameter in scope] or list(self.objects)
        return pick(draw, fitting or others)

    def atom(self, draw: Draw, scope: tuple[Parameter, ...]) -> Atom:
        predicate = pick(draw, list(self.predicates.values()))
        return Atom(predicate.name, tuple(self.term(draw, p.types[0], scope) for p in predicate.parameters))

    def literal(self, draw: Draw, scope: tuple[Parameter, ...]) -> Formula:
        atom = self.atom(draw, scope)
        return Not(atom) if chance(draw, 0.3) else atom

    def condition(self, draw: Draw, scope: tuple[Parameter, ...]) -> Formula:
        """A literal, or now and then something else that HDDL allows."""
        kind = pick(draw, ("literal",) * 6 + ("or", "and", "not and", "exists", "forall", "equals", "not equals"))
        if kind in ("exists", "forall"):
            bound = (Parameter("?q", (pick(draw, self.types),)),)
            body = self.literal(draw, scope + bound)
            return Exists(bound, body) if kind == "exists" else Forall(bound, body)
        if kind.endswith("equals") and len(scope) > 1:
            equal = Equals(scope[0].name, scope[1].name)
            return equal if kind == "equals" else Not(equal)
        if kind in ("or", "and", "not and"):
            pair = (self.literal(draw, scope), self.literal(draw, scope))
            return Or(pair) if kind == "or" else And(pair) if kind == "and" else Not(And(pair))
        return self.literal(draw, scope)

    def precondition(self, draw: Draw, scope: tuple[Parameter, ...], weights: tuple[int, ...]) -> Formula:
        count = pick(draw, weights)
        conditions = tuple(self.condition(draw, scope) for _ in range(count))
        return TRUE if not conditions else conditions[0] if len(conditions) == 1 else And(conditions)


whole_numbers = cache(st.integers)


def between(draw: Draw, least: int, most: int) -> int:
    """A whole number; the least is the simplest. Making a strategy takes longer than drawing: each is made once."""
    return draw(whole_numbers(least, most))


def pick(draw: Draw, values: Sequence[T]) -> T:
    """One of the values; the first is the simplest."""
    return values[draw(whole_numbers(0, len(values) - 1))]


def chance(draw: Draw, probability: float) -> bool:
    """True with about this probability; false is the simpler choice."""
    return draw(whole_numbers(0, 99)) >= 100 - round(100 * probability)


@st.composite
def problems(draw: Draw, orders: tuple[str, ...] = ORDERS) -> Problem:
    """A problem; `orders` are the kinds of task networks in it."""
    two_types = chance(draw, 0.5)
    types = ("thing", "place") if two_types else ("thing",)
    parents = {"thing": ("object",), "place": ("thing",)} if two_types else {"thing": ("object",)}
    objects = {f"o{i}": pick(draw, types) for i in range(between(draw, 1, 3))}
    arities = draw(st.lists(st.sampled_from((0, 0, 1, 1, 2)), min_size=3, max_size=4))
    predicates = {}
    for i, arity in enumerate(arities):
        parameters = tuple(Parameter(f"?x{j}", (pick(draw, types),)) for j in range(arity))
        predicates[f"p{i}"] = Signature(f"p{i}", parameters)
    names = Names(types, predicates, objects)
    functions = {FUNCTION: Signature(FUNCTION, (Parameter("?x0", ("thing",)),))}

    costly = not chance(draw, 0.1)
    actions = {f"a{i}": action(draw, names, f"a{i}", costly) for i in range(between(draw, 2, 5))}
    count = between(draw, 2, 4)
    tasks = {f"t{i}": Signature(f"t{i}", names.parameters(draw, 1, "y")) for i in range(count)}
    methods: dict[str, Method] = {}
    for task in tasks.values():
        for i in range(between(draw, 1, 3)):
            name = f"{task.name}-m{i}"
            if i > 0 and "none" in orders and chance(draw, 0.2):  # the same tasks in another order
                before = methods[f"{task.name}-m{i - 1}"]
                network = replace(before.network, ordering=ordering(draw, len(before.network.subtasks), orders))
                methods[name] = replace(before, name=name, network=network)
            else:
                methods[name] = method(draw, names, name, task, actions, tasks, orders)

    parameters = names.parameters(draw, 1, "i") if chance(draw, 0.2) else ()
    network = task_network(draw, names, parameters, actions, tasks, between(draw, 1, 3), orders)
    facts = [(p.name, *arguments) for p in predicates.values() for arguments in ground(p, objects, parents)]
    initial = frozenset(fact for fact in facts if chance(draw, 0.6))
    values = {(FUNCTION, name): pick(draw, COSTS) for name in objects}
    goal = names.precondition(draw, (), (0, 0, 0, 0, 1))
    domain = Domain("random", TypeHierarchy(parents), {}, predicates, functions, tasks, actions, methods)
    return Problem("p", domain, objects, parameters, network, initial, values, goal)


def ground(predicate: Signature, objects: dict[str, str], parents: dict[str, tuple[str, ...]]) -> list[tuple[str, ...]]:
    found: list[tuple[str, ...]] = [()]
    for parameter in predicate.parameters:
        fitting = [name for name, kind in objects.items() if parameter.types[0] in (kind, *parents[kind])]
        found = [(*arguments, name) for arguments in found for name in fitting]
    return found


def action(draw: Draw, names: Names, name: str, costly: bool) -> Action:
    parameters = names.parameters(draw, 2, "x")
    precondition = names.precondition(draw, parameters, (0, 0, 0, 1, 1, 2))
    effects = [effect(draw, names, parameters) for _ in range(between(draw, 1, 3))]
    if chance(draw, 0.2):  # adding wins over deleting
        condition = names.condition(draw, parameters) if chance(draw, 0.5) else TRUE
        opposite = replace(effects[0], positive=not effects[0].positive)
        effects.append(opposite if opposite.parameters else replace(opposite, condition=condition))
    costs: list[CostBlock] = []
    if costly and not chance(draw, 0.15):
        costs.append(CostBlock(branches(draw, parameters)))
        for _ in range(pick(draw, (0, 0, 0, 1, 1, 2, 3))):
            bound = (Parameter("?w", (pick(draw, names.types),)),) if chance(draw, 0.2) else ()
            condition = cost_condition(draw, names, parameters + bound, effects, costs)
            costs.append(CostBlock(branches(draw, parameters + bound), condition, bound))
    return Action(name, parameters, precondition, tuple(effects), tuple(costs))


def cost_condition(
    draw: Draw, names: Names, scope: tuple[Parameter, ...], effects: list[Effect], costs: list[CostBlock]
) -> Formula:
    """Any condition, or one that has to do with other ones of the action or with what it changes."""
    others = [block.condition for block in costs if block.condition != TRUE and not block.parameters]
    changed: list[Formula] = [effect.atom for effect in effects if not effect.parameters]
    match pick(draw, ("any", "any", "several", "overlapping", "else", "changed")):
        case "overlapping" if others:
            return And((pick(draw, others), names.condition(draw, scope)))
        case "else" if others:
            return Not(pick(draw, others))
        case "changed" if changed:
            atom = pick(draw, changed)
            return Not(atom) if chance(draw, 0.5) else atom
        case "several":
            return names.precondition(draw, scope, (2, 3))
    return names.condition(draw, scope)


def effect(draw: Draw, names: Names, parameters: tuple[Parameter, ...]) -> Effect:
    bound = (Parameter("?u", (pick(draw, names.types),)),) if chance(draw, 0.1) else ()
    scope = bound + parameters
    condition = names.condition(draw, scope) if chance(draw, 0.25) else TRUE
    return Effect(names.atom(draw, scope), not chance(draw, 0.35), condition, bound)


def branches(draw: Draw, parameters: tuple[Parameter, ...]) -> tuple[tuple[Expression, Expression], ...]:
    """A certain cost, or one of two or three; what is missing to probability 1 costs nothing."""
    first, second, third = (cost(draw, parameters) for _ in range(3))
    p = pick(draw, TENTHS)
    match pick(draw, ("certain", "two", "two", "three", "rest")):
        case "certain":
            return ((Number(Fraction(1)), first),)
        case "two":
            return ((Number(p), first), (Number(1 - p), second))
        case "three":
            return ((Number(p / 2), first), (Number(p / 2), second), (Number(1 - p), third))
    return ((Number(p), first),)


def cost(draw: Draw, parameters: tuple[Parameter, ...]) -> Expression:
    number = Number(pick(draw, COSTS))
    if parameters and chance(draw, 0.2):
        term = FunctionTerm(FUNCTION, (pick(draw, parameters).name,))
        return term if chance(draw, 0.5) else Arithmetic(pick(draw, "+*"), (term, number))
    return number


def method(
    draw: Draw,
    names: Names,
    name: str,
    task: Signature,
    actions: dict[str, Action],
    tasks: dict[str, Signature],
    orders: tuple[str, ...],
) -> Method:
    parameters = task.parameters + names.parameters(draw, pick(draw, (0, 0, 0, 1, 1, 3)), "z")
    precondition = names.precondition(draw, parameters, (0, 0, 0, 0, 1, 1, 2))
    later = {other: signature for other, signature in tasks.items() if other > task.name}
    paying = [action for action in actions.values() if is_costly(action, actions)]
    size = pick(draw, (0, 1, 1, 2, 2, 3))
    if size > 1 and chance(draw, 0.4) and (paying or chance(draw, 0.05)):
        back = [signature for signature in tasks.values() if signature.name <= task.name]
        candidates: tuple[Sequence[Action | Signature], ...] = (paying, back) if paying else (back,)
        network = task_network(draw, names, parameters, actions, tasks, size, orders, candidates)
    else:
        network = task_network(draw, names, parameters, actions, later, size, orders)
    return Method(name, parameters, task.name, tuple(p.name for p in task.parameters), network, precondition)


def is_costly(action: Action, actions: dict[str, Action]) -> bool:
    """Tell whether the action surely costs something."""
    if not any(other.costs for other in actions.values()):
        return True
    return any(
        block.condition == TRUE and any(isinstance(cost, Number) and cost.value > 0 for _, cost in block.branches)
        for block in action.costs
    )


def task_network(
    draw: Draw,
    names: Names,
    scope: tuple[Parameter, ...],
    actions: dict[str, Action],
    tasks: dict[str, Signature],
    size: int,
    orders: tuple[str, ...],
    candidates: tuple[Sequence[Action | Signature], ...] = (),
) -> TaskNetwork:
    """A network of so many subtasks; `candidates` are what the first ones are drawn from."""
    subtasks: list[Subtask] = []
    for i in range(size):
        if i < len(candidates):
            chosen = pick(draw, candidates[i])
        elif subtasks and chance(draw, 0.1):  # twice the same
            subtasks.append(Subtask(f"s{i}", subtasks[-1].task, subtasks[-1].arguments))
            continue
        else:
            compound = bool(tasks) and chance(draw, 0.5)
            named: Sequence[Action | Signature] = list(tasks.values() if compound else actions.values())
            chosen = pick(draw, named)
        arguments = tuple(names.term(draw, parameter.types[0], scope) for parameter in chosen.parameters)
        subtasks.append(Subtask(f"s{i}", chosen.name, arguments))
    return TaskNetwork(tuple(subtasks), ordering(draw, size, orders))


def ordering(draw: Draw, size: int, orders: tuple[str, ...]) -> tuple[tuple[int, int], ...]:
    pairs = [(i, j) for j in range(size) for i in range(j)]
    match pick(draw, orders):
        case "total":
            return tuple((j, i) for i, j in pairs) if chance(draw, 0.15) else tuple(pairs)
        case "partial":
            return tuple(pair for pair in pairs if draw(st.booleans()))
    return ()


def grounding_switches() -> st.SearchStrategy[GroundingSwitches]:
    """All combinations of the refinements of grounding."""
    return st.builds(GroundingSwitches, *[st.booleans()] * 4)


def utilities() -> st.SearchStrategy[Utility]:
    """Agents of every attitude, from nearly neutral to extreme."""
    return st.one_of(
        st.just(utility_for("neutral")),
        st.builds(utility_for, st.sampled_from(("averse", "seeking")), st.sampled_from((0.1, 0.9, 0.001, 0.5, 3.0))),
    )
