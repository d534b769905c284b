"""Random small problems whose actions are lotteries of nearly the same mean, for Hypothesis, and objectives for them.

Which plan is best hangs on the shape of the whole law here. Often it is none that is best for the mean or for any
exponential utility.
"""

from __future__ import annotations

import itertools
from fractions import Fraction

from hypothesis import strategies as st

from statehtn.model import (
    TRUE,
    Action,
    Atom,
    CostBlock,
    Domain,
    Effect,
    Formula,
    Method,
    Not,
    Number,
    Problem,
    Signature,
    Subtask,
    TaskNetwork,
    TypeHierarchy,
)
from tests.strategies import ORDERS, Draw, chance, ordering, pick

Lottery = tuple[tuple[str, str], ...]
"""Probabilities and costs; the rest costs nothing."""
LOTTERIES: tuple[Lottery, ...] = (
    (("1", "4"),),
    (("1", "4.5"),),
    (("1", "5"),),
    (("0.8", "3.5"), ("0.2", "12")),  # often cheap, and then much too dear: what keeps a budget, or a quantile
    (("0.9", "4"), ("0.1", "15")),
    (("0.95", "4"), ("0.05", "20")),
    (("0.7", "3"), ("0.3", "10")),
    (("0.3", "0.5"), ("0.7", "7")),  # seldom very cheap: what gamblers like
    (("0.1", "0"), ("0.9", "5.5")),
    (("0.5", "1"), ("0.5", "8.5")),
    (("0.2", "1"), ("0.6", "4"), ("0.2", "8")),
    (("0.25", "2"), ("0.5", "4.5"), ("0.25", "8")),
    (("0.5", "3"), ("0.5", "6")),
    (("0.6", "2"), ("0.4", "9")),
)
SMALL: tuple[Lottery, ...] = (
    (("1", "0.5"),),
    (("1", "1"),),
    (("0.9", "0.5"), ("0.1", "2")),
    (("0.25", "3"),),
    (("0.5", "1"),),
    (("0.1", "5"),),
)
FACTS = ("p0", "p1", "p2")


@st.composite
def lottery_problems(draw: Draw, orders: tuple[str, ...] = ORDERS) -> Problem:
    """A problem; `orders` are the kinds of task networks in it."""
    lotteries = draw(st.lists(st.sampled_from(LOTTERIES), min_size=5, max_size=7, unique=True))
    actions = {f"a{i}": action(draw, f"a{i}", branches) for i, branches in enumerate(lotteries)}
    tasks = {f"t{i}": Signature(f"t{i}", ()) for i in range(pick(draw, (2, 2, 3, 1)))}
    methods = {}
    for task in tasks:
        firsts = draw(st.permutations(list(actions)))[: pick(draw, (3, 3, 2, 4))]
        for i, first in enumerate(firsts):
            name = f"{task}-m{i}"
            precondition = literal(draw) if i > 0 and chance(draw, 0.1) else TRUE
            network = subtasks(draw, task, first, list(actions), list(tasks), orders, i > 0)
            methods[name] = Method(name, (), task, (), network, precondition)
    chosen = [*tasks, *draw(st.lists(st.sampled_from(list(tasks)), max_size=3 - len(tasks)))]
    initial = frozenset((fact,) for fact in FACTS if chance(draw, 0.5))
    predicates = {fact: Signature(fact, ()) for fact in FACTS}
    domain = Domain("lotteries", TypeHierarchy({}), {}, predicates, {}, tasks, actions, methods)
    return Problem("p", domain, {}, (), network_of(chosen, ordering(draw, len(chosen), orders)), initial, {}, TRUE)


def action(draw: Draw, name: str, branches: Lottery) -> Action:
    costs = [CostBlock(complete(branches))]
    if chance(draw, 0.25):
        costs.append(CostBlock(complete(pick(draw, SMALL)), literal(draw)))
    effects = [Effect(Atom(pick(draw, FACTS), ()), draw(st.booleans()), TRUE, ())]
    precondition = literal(draw) if chance(draw, 0.1) else TRUE
    return Action(name, (), precondition, tuple(effects) if chance(draw, 0.6) else (), tuple(costs))


def complete(lottery: Lottery) -> tuple[tuple[Number, Number], ...]:
    branches = [(Fraction(p), Fraction(cost)) for p, cost in lottery]
    rest = 1 - sum(p for p, _ in branches)
    branches += [(rest, Fraction(0))] if rest else []
    return tuple((Number(p), Number(cost)) for p, cost in branches)


def literal(draw: Draw) -> Formula:
    atom = Atom(pick(draw, FACTS), ())
    return Not(atom) if draw(st.booleans()) else atom


def subtasks(
    draw: Draw, task: str, first: str, actions: list[str], tasks: list[str], orders: tuple[str, ...], recurs: bool
) -> TaskNetwork:
    """An action, or two; or an action and a later task, or now and then the same task again, if it may recur."""
    chosen = [first]
    later = [other for other in tasks if other > task]
    if recurs and chance(draw, 0.06):
        chosen.append(task)
    elif later and chance(draw, 0.3):
        chosen.append(pick(draw, later))
    elif chance(draw, 0.3):
        chosen.append(pick(draw, actions))
    return network_of(chosen, ordering(draw, len(chosen), orders))


def network_of(names: list[str], order: tuple[tuple[int, int], ...]) -> TaskNetwork:
    return TaskNetwork(tuple(Subtask(f"s{i}", name, ()) for i, name in enumerate(names)), order)


LEVELS = ("0.5", "0.75", "0.9", "0.95", "0.99", "0.3")
BUDGETS = tuple(map(str, (5, 7, 8, 9, 10, 11, 12, 13.5, 15, 18)))
ALPHAS = ("0.1", "0.5", "0.9", "0.01", "2")
WEIGHTS = ("0.1", "0.5", "1", "3", "0", "20")


def texts(*parts: str | tuple[str, ...]) -> st.SearchStrategy[str]:
    """Texts of parts: a fixed one, or one of several."""
    return st.tuples(*(st.just(part) if isinstance(part, str) else st.sampled_from(part) for part in parts)).map(
        "".join
    )


@st.composite
def piecewise(draw: Draw) -> str:
    """A utility of three to five points, convex, concave or neither."""
    costs = sorted(draw(st.sets(st.sampled_from(BUDGETS), min_size=3, max_size=5)), key=float)
    falls = [pick(draw, (0, 1, 2, 3, 8)) for _ in costs]
    if draw(st.booleans()):
        falls.sort()
    worth = [Fraction(10)]
    for (before, cost), fall in zip(itertools.pairwise(costs), falls, strict=False):
        worth.append(worth[-1] - fall * (Fraction(cost) - Fraction(before)))
    return "piecewise " + " ".join(f"{cost}:{float(u):g}" for cost, u in zip(costs, worth, strict=True))


@st.composite
def exponentials(draw: Draw) -> str:
    """Some linear part or none, and one or two exponentials of either sign."""
    alphas = draw(st.lists(st.sampled_from(("0.1", "0.5", "1", "-0.1", "-0.5")), min_size=1, max_size=2, unique=True))
    linear = pick(draw, (" linear=0", " linear=1", " linear=0.2"))
    return "exponentials" + linear + "".join(f" {a}:{pick(draw, ('1', '0.1', '0.01'))}" for a in alphas)


ADDITIVE = st.one_of(
    st.just("neutral"),
    texts(("averse ", "seeking ", "success-utility alpha="), ALPHAS),
    texts("mean-variance ", ("0", "0.05", "0.2", "1")),
)
FINITE = {
    "one-switch": texts("one-switch alpha=", ALPHAS, " tradeoff=", WEIGHTS[:4], " wealth=", ("0", "5", "10", "20")),
    "exponentials": exponentials(),
    "mean-deviation": texts("mean-deviation ", WEIGHTS),
}
LAWS = {
    "deadline": texts("deadline ", BUDGETS),
    "overrun": texts("overrun ", BUDGETS),
    "piecewise": piecewise(),
    "quantile": texts("quantile ", LEVELS),
    "cvar": texts("cvar ", LEVELS),
    "mean-cvar": texts("mean-cvar ", LEVELS, " ", ("0", "0.25", "0.5", "1")),
}
SWEPT = {"evar": texts("evar ", LEVELS)}
FAMILIES: dict[str, st.SearchStrategy[str]] = {"additive": ADDITIVE, **FINITE, **LAWS, **SWEPT}
"""Objectives in text form, by family."""


def budgets() -> st.SearchStrategy[tuple[tuple[Fraction, Fraction], ...]]:
    """One or two budgets, each with a probability of keeping it."""
    budget = st.tuples(st.sampled_from(BUDGETS), st.sampled_from(("0.5", "0.8", "0.9", "0.95", "1", "0.25")))
    return st.lists(
        budget.map(lambda pair: (Fraction(pair[0]), Fraction(pair[1]))), min_size=1, max_size=2, unique=True
    ).map(tuple)
