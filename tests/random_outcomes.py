"""Random small problems whose actions have several outcomes, for Hypothesis."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction

from hypothesis import strategies as st

from statehtn.model import (
    TRUE,
    Action,
    And,
    Atom,
    CostBlock,
    Domain,
    Effect,
    Formula,
    Method,
    Not,
    Number,
    Parameter,
    Problem,
    Signature,
    Subtask,
    TaskNetwork,
    TypeHierarchy,
)
from statehtn.model.outcome import Outcome, OutcomeBlock
from tests.strategies import ORDERS, TENTHS, Draw, Names, between, branches, chance, effect, ordering, pick, problems

ONE = Number(Fraction(1))
FACTS = ("p0", "p1", "p2", "p3")
CHANCES = tuple(
    tuple(map(Fraction, several.split()))
    for several in ("0.5 0.5", "0.9 0.1", "0.2 0.8", "0.25 0.25 0.5", "0.7 0.2", "0.6 0.3 0.1", "0.5")
)
"""Probabilities of the outcomes of a block; with the rest nothing happens."""
SMALL_COSTS = tuple(map(Fraction, ("1", "1", "2", "3", "0.5", "4", "0")))


@st.composite
def wide_problems(draw: Draw, orders: tuple[str, ...] = ORDERS) -> Problem:
    """A problem with everything of the language, some of whose actions have outcomes."""
    problem = draw(problems(orders))
    domain = problem.domain
    kinds = tuple(domain.types.parents)
    names = Names(kinds, dict(domain.predicates), dict(problem.objects))
    actions = {name: with_outcomes(draw, names, action) for name, action in domain.actions.items()}
    return replace(problem, domain=replace(domain, actions=actions))


def with_outcomes(draw: Draw, names: Names, action: Action) -> Action:
    """The action with no, one or two blocks of outcomes."""
    blocks = []
    for _ in range(pick(draw, (0, 1, 1, 2))):
        bound = (Parameter("?o", (pick(draw, names.types),)),) if chance(draw, 0.1) else ()
        scope = action.parameters + bound
        condition = names.condition(draw, scope) if chance(draw, 0.25) else TRUE
        outcomes = []
        for number, probability in enumerate(pick(draw, CHANCES)):
            least = 1 if number == 0 else 0
            effects = tuple(effect(draw, names, scope) for _ in range(between(draw, least, 2)))
            costs = (CostBlock(branches(draw, scope)),) if chance(draw, 0.4) else ()
            outcomes.append(Outcome(Number(probability), effects, costs))
        blocks.append(OutcomeBlock(tuple(outcomes), condition, bound))
    return replace(action, outcomes=tuple(blocks))


@st.composite
def chance_problems(draw: Draw, orders: tuple[str, ...] = ORDERS) -> Problem:
    """A problem without objects: actions that may fail, tasks that try again, wait for each other, or lead nowhere."""
    wanted = {f"t{i}": literal(draw) for i in range(between(draw, 1, 3))}
    facts = [atom_of(formula) for formula in wanted.values()]
    actions = {f"a{i}": chance_action(draw, f"a{i}", [one, one, *facts]) for i, one in enumerate(facts)}
    actions |= {f"b{i}": chance_action(draw, f"b{i}", facts) for i in range(pick(draw, (1, 1, 2)))}
    tasks = {task: Signature(task) for task in wanted}
    methods: dict[str, Method] = {}
    for task, formula in wanted.items():
        if not chance(draw, 0.2):  # what it is for is true already
            methods[f"{task}-done"] = Method(f"{task}-done", (), task, (), TaskNetwork(), formula)
        for number in range(pick(draw, (1, 2, 2, 3))):
            name = f"{task}-m{number}"
            if number == 0 and not chance(draw, 0.3):  # what may make it true, until it is
                methods[name] = Method(name, (), task, (), network_of([task.replace("t", "a"), task], ((0, 1),)))
                continue
            network = chance_network(draw, task, list(actions), list(tasks), orders)
            condition = literal(draw) if chance(draw, 0.25) else TRUE
            methods[name] = Method(name, (), task, (), network, condition)
    first = ["t0", *draw(st.lists(st.sampled_from([*tasks, *actions]), max_size=2 if "total" in orders else 1))]
    network = network_of(first, ordering(draw, len(first), orders))
    initial = {(fact,) for fact in FACTS if chance(draw, 0.4)}
    for effect_wanted in facts:
        fact = (effect_wanted.atom.predicate,)
        if not chance(draw, 0.15):
            initial = initial - {fact} if effect_wanted.positive else initial | {fact}
    goal = literal(draw) if chance(draw, 0.1) else TRUE
    predicates = {fact: Signature(fact) for fact in FACTS}
    domain = Domain("chances", TypeHierarchy({}), {}, predicates, {}, tasks, actions, methods)
    return Problem("p", domain, network=network, initial_state=frozenset(initial), goal=goal)


@st.composite
def locked_problems(draw: Draw) -> Problem:
    """A way of three actions, each of which needs what the one before makes, and keys that may be lost or found."""
    doors, keys = [f"p{i}" for i in range(4)], ["k0", "k1", "k2"]
    actions = {}
    for number in range(between(draw, 4, 6)):
        is_on_the_way = number < len(doors) - 1
        needed = [doors[number] if is_on_the_way else pick(draw, doors)]
        needed += [pick(draw, keys)] if chance(draw, 0.6) else []
        made = Effect(Atom(doors[number + 1])) if is_on_the_way else lost_or_found(draw, doors[:2], keys)
        outcomes = [Outcome(Number(Fraction("0.5")), (made,))]
        if chance(draw, 0.7):
            outcomes.append(Outcome(Number(Fraction("0.5")), (lost_or_found(draw, doors[:2], keys),)))
        costs = (CostBlock(cost_branches(draw)),)
        precondition = And(tuple(map(Atom, needed)))
        actions[f"a{number}"] = Action(f"a{number}", (), precondition, (), costs, (OutcomeBlock(tuple(outcomes)),))
    methods = {f"m-{name}": Method(f"m-{name}", (), "t", (), network_of([name, "t"], ((0, 1),))) for name in actions}
    methods["done"] = Method("done", (), "t", (), TaskNetwork(), Atom(doors[-1]))
    initial = frozenset((fact,) for fact in (doors[0], *keys) if fact == doors[0] or chance(draw, 0.7))
    predicates = {fact: Signature(fact) for fact in (*doors, *keys)}
    domain = Domain("locks", TypeHierarchy({}), {}, predicates, {}, {"t": Signature("t")}, actions, methods)
    return Problem("p", domain, network=network_of(["t"], ()), initial_state=initial)


def lost_or_found(draw: Draw, doors: list[str], keys: list[str]) -> Effect:
    return Effect(Atom(pick(draw, [*doors, *keys, *keys])), chance(draw, 0.3))


def atom_of(formula: Formula) -> Effect:
    """The effect that makes a literal true, or the first one of several."""
    first = formula.operands[0] if isinstance(formula, And) else formula
    atom = first.operand if isinstance(first, Not) else first
    assert isinstance(atom, Atom)
    return Effect(atom, not isinstance(first, Not))


def chance_action(draw: Draw, name: str, wanted: list[Effect]) -> Action:
    precondition = literal(draw) if chance(draw, 0.15) else TRUE
    costs = [CostBlock(cost_branches(draw))] if not chance(draw, 0.1) else []
    if chance(draw, 0.2):
        costs.append(CostBlock(cost_branches(draw), literal(draw)))
    blocks = [outcome_block(draw, wanted)] if not chance(draw, 0.2) else []
    if chance(draw, 0.1):
        blocks.append(outcome_block(draw, wanted))
    effects = (change(draw, wanted),) if chance(draw, 0.4) else ()
    return Action(name, (), precondition, effects, tuple(costs), tuple(blocks))


def outcome_block(draw: Draw, wanted: list[Effect]) -> OutcomeBlock:
    outcomes = []
    for number, probability in enumerate(pick(draw, CHANCES)):
        effects = tuple(change(draw, wanted) for _ in range(pick(draw, (0, 1, 1, 2) if number else (1, 1, 2))))
        costs = (CostBlock(cost_branches(draw)),) if chance(draw, 0.3) else ()
        outcomes.append(Outcome(Number(probability), effects, costs))
    return OutcomeBlock(tuple(outcomes), literal(draw) if chance(draw, 0.15) else TRUE)


def cost_branches(draw: Draw) -> tuple[tuple[Number, Number], ...]:
    first, second = (Number(pick(draw, SMALL_COSTS)) for _ in range(2))
    if chance(draw, 0.6):
        return ((ONE, first),)
    p = pick(draw, TENTHS)
    return ((Number(p), first), (Number(1 - p), second))


def change(draw: Draw, wanted: list[Effect]) -> Effect:
    """An effect that some task is for, or any."""
    if draw(st.booleans()):
        return pick(draw, wanted)
    condition = literal(draw) if chance(draw, 0.1) else TRUE
    return Effect(Atom(pick(draw, FACTS)), draw(st.booleans()), condition)


def literal(draw: Draw) -> Formula:
    atom = Atom(pick(draw, FACTS))
    one = Not(atom) if draw(st.booleans()) else atom
    return And((one, literal(draw))) if chance(draw, 0.1) else one


def chance_network(draw: Draw, task: str, actions: list[str], tasks: list[str], orders: tuple[str, ...]) -> TaskNetwork:
    """One task, or two; trying again comes after an action, or is free, in a network of its own."""
    later = [other for other in tasks if other > task]
    match pick(draw, ("again", "again", "again", "two", "two", "later", "action", "free")):
        case "again":
            own = task.replace("t", "a")  # what may make true what the task is for
            return network_of([pick(draw, [own, own, *actions]), task], ((0, 1),))
        case "free":
            return network_of([pick(draw, [other for other in tasks if other <= task])], ())
        case "two":
            chosen = [pick(draw, actions), pick(draw, [*later, *actions])]
            return network_of(chosen, ordering(draw, 2, orders))
        case "later" if later:
            return network_of([pick(draw, later)], ())
    return network_of([pick(draw, actions)], ())


def network_of(names: list[str], order: tuple[tuple[int, int], ...]) -> TaskNetwork:
    return TaskNetwork(tuple(Subtask(f"s{i}", name) for i, name in enumerate(names)), order)
