"""Random small problems in which costs hang together, and what their plans cost, worked out by brute force."""

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
    CostDistribution,
    Domain,
    Expression,
    Formula,
    Method,
    Not,
    Number,
    Parameter,
    Plan,
    Problem,
    Subtask,
    TaskNetwork,
    TypeHierarchy,
)
from statehtn.model import Signature as Predicate
from statehtn.model.chance import Chance, Outcome
from tests.lotteries import lottery_problems
from tests.naive_semantics import Semantics
from tests.strategies import ORDERS, Draw, between, branches, chance, ground, ordering, pick, problems

HIDDEN = {"h0": Predicate("h0"), "h1": Predicate("h1", (Parameter("?x0", ("thing",)),)), "h2": Predicate("h2")}
ONE = Number(Fraction(1))
LEAST = tuple(map(Fraction, ("1", "4", "2.5", "5", "0.5", "9")))
EIGHTHS = tuple(Fraction(i, 8) for i in range(1, 8))


@st.composite
def correlated_problems(draw: Draw, orders: tuple[str, ...] = ORDERS, most_scenarios: int = 16) -> Problem:
    """A problem of `strategies.problems` with costs that read hidden facts, in at most so many scenarios."""
    problem = draw(problems(orders))
    domain = problem.domain
    parents = {name: tuple(above) for name, above in domain.types.parents.items()}
    facts = [(p.name, *args) for p in HIDDEN.values() for args in ground(p, dict(problem.objects), parents)]
    chances: list[Chance] = []
    count = 1
    for _ in range(pick(draw, (1, 1, 2, 3))):
        drawn = chances_of(draw, facts)
        if count * len(drawn.outcomes) <= most_scenarios:
            chances.append(drawn)
            count *= len(drawn.outcomes)
    actions = {name: with_hidden_costs(draw, action) for name, action in domain.actions.items()}
    predicates = {**domain.predicates, **HIDDEN}
    return replace(problem, domain=replace(domain, predicates=predicates, actions=actions), chances=tuple(chances))


@st.composite
def correlated_lotteries(
    draw: Draw, orders: tuple[str, ...] = ORDERS, certain: bool = False, most_scenarios: int = 16
) -> Problem:
    """A problem whose actions are lotteries, some of which depend on what is hidden, in at most so many scenarios.

    Args:
        certain: whether nothing is uncertain once the scenario is known.
    """
    problem = draw(lottery_problems(orders))
    facts = [("h0",), ("h2",), ("h3",), ("h4",)]
    chances: list[Chance] = []
    count = 1
    for _ in range(pick(draw, (1, 1, 2, 3))):
        drawn = chances_of(draw, facts)
        if count * len(drawn.outcomes) <= most_scenarios:
            chances.append(drawn)
            count *= len(drawn.outcomes)
    actions = {name: hidden_lottery(draw, action, certain) for name, action in problem.domain.actions.items()}
    predicates = {**problem.domain.predicates, **{name: Predicate(name) for (name,) in facts}}
    domain = replace(problem.domain, predicates=predicates, actions=actions)
    return replace(problem, domain=domain, chances=tuple(chances))


@st.composite
def hedging_problems(draw: Draw, orders: tuple[str, ...] = ORDERS, certain: bool = True) -> Problem:
    """Tasks in which actions can be chosen that are good in different scenarios, so that ways to a node are not alike.

    Args:
        certain: whether nothing is uncertain once the scenario is known.
    """
    names = [f"h{number}" for number in range(between(draw, 2, 4))]
    weights = [between(draw, 1, 4) for _ in names]
    outcomes = zip(names, weights, strict=True)
    drawn = Chance(tuple(Outcome(Fraction(weight, sum(weights)), frozenset({(name,)})) for name, weight in outcomes))
    actions: dict[str, Action] = {}
    methods: dict[str, Method] = {}
    tasks = {f"t{i}": Predicate(f"t{i}") for i in range(between(draw, 2, 3))}
    for task in tasks:
        for number in range(between(draw, 2, 3)):
            name = f"{task}-a{number}"
            costs = [CostBlock(hedging_cost(draw, certain), Atom(hidden)) for hidden in names]
            actions[name] = Action(name, costs=tuple(costs))
            network = TaskNetwork((Subtask("s0", name),))
            methods[f"{name}-m"] = Method(f"{name}-m", (), task, (), network)
    network = TaskNetwork(
        tuple(Subtask(f"s{i}", name) for i, name in enumerate(tasks)), ordering(draw, len(tasks), orders)
    )
    predicates = {name: Predicate(name) for name in names}
    domain = Domain("hedges", TypeHierarchy({}), {}, predicates, {}, tasks, actions, methods)
    return Problem("p", domain, network=network, chances=(drawn,))


def hedging_cost(draw: Draw, certain: bool) -> tuple[tuple[Expression, Expression], ...]:
    first, second = (Number(Fraction(between(draw, 0, 9))) for _ in range(2))
    if certain or draw(st.booleans()):
        return ((ONE, first),)
    return ((Number(Fraction(1, 4)), first), (Number(Fraction(3, 4)), second))


def hidden_lottery(draw: Draw, action: Action, certain: bool) -> Action:
    """The action with costs that depend on one hidden fact, or two, instead of chance, or in addition."""
    first, *others = action.costs
    hidden = Atom(pick(draw, ("h0", "h2", "h3", "h4")))
    costs = list(others)
    if certain or chance(draw, 0.5):
        low, high = draw(st.tuples(st.sampled_from(LEAST), st.sampled_from(LEAST)))
        costs.append(CostBlock(((ONE, Number(low)),), hidden))
        costs.append(CostBlock(((ONE, Number(high + pick(draw, LEAST))),), Not(hidden)))
    else:
        costs.append(first)
    if chance(draw, 0.5):
        other = Atom(pick(draw, ("h0", "h2", "h3", "h4")))
        more = ((ONE, Number(pick(draw, LEAST))),) if certain else branches(draw, ())
        costs.append(CostBlock(more, other))
    if certain:
        costs = [replace(block, branches=block.branches[:1]) for block in costs]
        costs = [replace(block, branches=((ONE, block.branches[0][1]),)) for block in costs]
    return replace(action, costs=tuple(costs))


def chances_of(draw: Draw, facts: list[tuple[str, ...]]) -> Chance:
    """One thing that is decided by chance, with two or three outcomes."""
    outcomes = draw(st.sets(st.frozensets(st.sampled_from(facts), max_size=3), min_size=2, max_size=3))
    first, *rest = sorted(outcomes, key=sorted)
    weight = pick(draw, EIGHTHS) / len(rest)
    found = [Outcome(1 - weight * len(rest), first), *(Outcome(weight, outcome) for outcome in rest)]
    return Chance(tuple(found))


def with_hidden_costs(draw: Draw, action: Action) -> Action:
    """The action with hidden facts in the conditions of some of its costs, and with costs of hidden facts alone."""
    costs = []
    for block in action.costs:
        hidden = block.condition != TRUE and chance(draw, 0.4)
        condition = And((block.condition, hidden_literal(draw, action))) if hidden else block.condition
        costs.append(replace(block, condition=condition))
    more = pick(draw, (0, 1, 1, 2))
    costs += [CostBlock(branches(draw, action.parameters), hidden_literal(draw, action)) for _ in range(more)]
    return replace(action, costs=tuple(costs))


def hidden_literal(draw: Draw, action: Action) -> Formula:
    variables = [parameter.name for parameter in action.parameters]
    atoms = [Atom("h0"), Atom("h2"), *(Atom("h1", (name,)) for name in variables)]
    atom = pick(draw, atoms)
    return Not(atom) if chance(draw, 0.3) else atom


def totals(problem: Problem, plan: Plan) -> list[tuple[float, CostDistribution]]:
    """The probability of each scenario, and the law of what the plan costs in it, by exact convolution."""
    semantics = Semantics(problem)
    found = []
    for scenario in problem.scenarios:
        state = problem.initial_state
        law = CostDistribution.certain(0)
        for step in plan.steps:
            law = law.convolve(semantics.law(step.action, step.arguments, state | scenario.facts))
            after = semantics.execute(step.action, step.arguments, state)
            assert after is not None
            state = after
        found.append((scenario.probability, law))
    return found


def mixture(laws: list[tuple[float, CostDistribution]]) -> CostDistribution:
    """The law over all scenarios."""
    return CostDistribution.of((weight * p, cost) for weight, law in laws for p, cost in law.outcomes)
