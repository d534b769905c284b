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
from tests.strategies import ORDERS, Draw, branches, chance, ground, ordering, problems

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
    for _ in range(draw(st.sampled_from((1, 1, 2, 3)))):
        drawn = draw(chances_of(facts))
        if count * len(drawn.outcomes) <= most_scenarios:
            chances.append(drawn)
            count *= len(drawn.outcomes)
    actions = {name: draw(with_hidden_costs(action)) for name, action in domain.actions.items()}
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
    for _ in range(draw(st.sampled_from((1, 1, 2, 3)))):
        drawn = draw(chances_of(facts))
        if count * len(drawn.outcomes) <= most_scenarios:
            chances.append(drawn)
            count *= len(drawn.outcomes)
    actions = {name: draw(hidden_lottery(action, certain)) for name, action in problem.domain.actions.items()}
    predicates = {**problem.domain.predicates, **{name: Predicate(name) for (name,) in facts}}
    domain = replace(problem.domain, predicates=predicates, actions=actions)
    return replace(problem, domain=domain, chances=tuple(chances))


@st.composite
def hedging_problems(draw: Draw, orders: tuple[str, ...] = ORDERS, certain: bool = True) -> Problem:
    """Tasks in which actions can be chosen that are good in different scenarios, so that ways to a node are not alike.

    Args:
        certain: whether nothing is uncertain once the scenario is known.
    """
    names = [f"h{number}" for number in range(draw(st.integers(2, 4)))]
    weights = [draw(st.integers(1, 4)) for _ in names]
    outcomes = zip(names, weights, strict=True)
    drawn = Chance(tuple(Outcome(Fraction(weight, sum(weights)), frozenset({(name,)})) for name, weight in outcomes))
    actions: dict[str, Action] = {}
    methods: dict[str, Method] = {}
    tasks = {f"t{i}": Predicate(f"t{i}") for i in range(draw(st.integers(2, 3)))}
    for task in tasks:
        for number in range(draw(st.integers(2, 3))):
            name = f"{task}-a{number}"
            costs = [CostBlock(draw(hedging_cost(certain)), Atom(hidden)) for hidden in names]
            actions[name] = Action(name, costs=tuple(costs))
            network = TaskNetwork((Subtask("s0", name),))
            methods[f"{name}-m"] = Method(f"{name}-m", (), task, (), network)
    network = TaskNetwork(
        tuple(Subtask(f"s{i}", name) for i, name in enumerate(tasks)), draw(ordering(len(tasks), orders))
    )
    predicates = {name: Predicate(name) for name in names}
    domain = Domain("hedges", TypeHierarchy({}), {}, predicates, {}, tasks, actions, methods)
    return Problem("p", domain, network=network, chances=(drawn,))


@st.composite
def hedging_cost(draw: Draw, certain: bool) -> tuple[tuple[Expression, Expression], ...]:
    first, second = (Number(Fraction(draw(st.integers(0, 9)))) for _ in range(2))
    if certain or draw(st.booleans()):
        return ((ONE, first),)
    return ((Number(Fraction(1, 4)), first), (Number(Fraction(3, 4)), second))


@st.composite
def hidden_lottery(draw: Draw, action: Action, certain: bool) -> Action:
    """The action with costs that depend on one hidden fact, or two, instead of chance, or in addition."""
    first, *others = action.costs
    hidden = Atom(draw(st.sampled_from(("h0", "h2", "h3", "h4"))))
    costs = list(others)
    if certain or chance(draw, 0.5):
        low, high = draw(st.tuples(st.sampled_from(LEAST), st.sampled_from(LEAST)))
        costs.append(CostBlock(((ONE, Number(low)),), hidden))
        costs.append(CostBlock(((ONE, Number(high + draw(st.sampled_from(LEAST)))),), Not(hidden)))
    else:
        costs.append(first)
    if chance(draw, 0.5):
        other = Atom(draw(st.sampled_from(("h0", "h2", "h3", "h4"))))
        more = ((ONE, Number(draw(st.sampled_from(LEAST)))),) if certain else draw(branches(()))
        costs.append(CostBlock(more, other))
    if certain:
        costs = [replace(block, branches=block.branches[:1]) for block in costs]
        costs = [replace(block, branches=((ONE, block.branches[0][1]),)) for block in costs]
    return replace(action, costs=tuple(costs))


@st.composite
def chances_of(draw: Draw, facts: list[tuple[str, ...]]) -> Chance:
    """One thing that is decided by chance, with two or three outcomes."""
    outcomes = draw(st.sets(st.frozensets(st.sampled_from(facts), max_size=3), min_size=2, max_size=3))
    first, *rest = sorted(outcomes, key=sorted)
    weight = draw(st.sampled_from(EIGHTHS)) / len(rest)
    found = [Outcome(1 - weight * len(rest), first), *(Outcome(weight, outcome) for outcome in rest)]
    return Chance(tuple(found))


@st.composite
def with_hidden_costs(draw: Draw, action: Action) -> Action:
    """The action with hidden facts in the conditions of some of its costs, and with costs of hidden facts alone."""
    costs = []
    for block in action.costs:
        hidden = block.condition != TRUE and chance(draw, 0.4)
        condition = And((block.condition, draw(hidden_literal(action)))) if hidden else block.condition
        costs.append(replace(block, condition=condition))
    more = draw(st.sampled_from((0, 1, 1, 2)))
    costs += [CostBlock(draw(branches(action.parameters)), draw(hidden_literal(action))) for _ in range(more)]
    return replace(action, costs=tuple(costs))


@st.composite
def hidden_literal(draw: Draw, action: Action) -> Formula:
    variables = [parameter.name for parameter in action.parameters]
    atoms = [Atom("h0"), Atom("h2"), *(Atom("h1", (name,)) for name in variables)]
    atom = draw(st.sampled_from(atoms))
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
