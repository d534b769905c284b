"""Random problems full of choices between costs from 1e-12 to 1e15, for Hypothesis."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
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
    Problem,
    Signature,
    Subtask,
    TaskNetwork,
    TypeHierarchy,
)
from tests.strategies import between, pick

FACTS = ("p0", "p1", "p2")
PROBABILITIES = (Fraction(1, 2), Fraction(1, 10), Fraction(999, 1000), Fraction(1, 10**6), Fraction(1, 10**12))


@dataclass
class Costs:
    """Draws costs: of any size, or nearly equal to one that was drawn before."""

    draw: st.DrawFn
    known: list[Fraction] = field(default_factory=list)

    def cost(self) -> Number:
        if self.known and between(self.draw, 0, 4) > 2:
            near = 1 + Fraction(1, 10 ** pick(self.draw, range(1, 8)))
            self.known.append(pick(self.draw, self.known) * near)
        else:
            digits = Fraction(pick(self.draw, range(10, 100)), 10)
            self.known.append(digits * Fraction(10) ** pick(self.draw, range(-12, 15)))
        return Number(self.known[-1])

    def block(self, condition: Formula = TRUE) -> CostBlock:
        """A certain cost, one with two outcomes, or one that costs nothing with some probability."""
        outcomes = between(self.draw, 0, 3)
        if outcomes < 2:
            return CostBlock(((Number(Fraction(1)), self.cost()),), condition)
        p = pick(self.draw, PROBABILITIES)
        other = Number(Fraction(0)) if outcomes == 3 else self.cost()
        return CostBlock(((Number(p), self.cost()), (Number(1 - p), other)), condition)


@st.composite
def problems(draw: st.DrawFn) -> Problem:
    """A problem without parameters; its recursion always has a price."""
    costs = Costs(draw)
    actions = {f"a{i}": _action(draw, costs, f"a{i}") for i in range(between(draw, 4, 7))}
    tasks = {f"t{i}": Signature(f"t{i}", ()) for i in range(3)}
    methods: dict[str, Method] = {}
    for task in tasks:
        for i in range(between(draw, 2, 4)):
            names = [name for name in tasks if name > task]
            subtasks = [pick(draw, [*actions, *names]) for _ in range(pick(draw, (1, 1, 2, 2, 3)))]
            if i > 1 and draw(st.booleans()):
                subtasks = [pick(draw, list(actions)), pick(draw, list(tasks))]
            methods[f"{task}-{i}"] = Method(f"{task}-{i}", (), task, (), _network(draw, subtasks), _condition(draw, 0))
    network = _network(draw, [pick(draw, list(tasks)) for _ in range(between(draw, 1, 3))])
    predicates = {name: Signature(name, ()) for name in FACTS}
    domain = Domain("far-apart", TypeHierarchy({}), {}, predicates, {}, tasks, actions, methods)
    initial = frozenset((name,) for name in FACTS if draw(st.booleans()))
    return Problem("p", domain, {}, (), network, initial, {}, _condition(draw, 0))


def _action(draw: st.DrawFn, costs: Costs, name: str) -> Action:
    effects = [Effect(Atom(pick(draw, FACTS), ()), draw(st.booleans()), TRUE, ()) for _ in range(between(draw, 0, 2))]
    blocks = [costs.block()]
    if between(draw, 0, 3) == 3:
        blocks.append(costs.block(_condition(draw, 1)))
    return Action(name, (), _condition(draw, 0), tuple(effects), tuple(blocks))


def _condition(draw: st.DrawFn, least: int) -> Formula:
    literals: list[Formula] = []
    for _ in range(max(least, pick(draw, (0, 0, 0, 1)))):
        atom = Atom(pick(draw, FACTS), ())
        literals.append(atom if draw(st.booleans()) else Not(atom))
    return literals[0] if len(literals) == 1 else And(tuple(literals)) if literals else TRUE


def _network(draw: st.DrawFn, names: list[str]) -> TaskNetwork:
    subtasks = tuple(Subtask(f"s{i}", name, ()) for i, name in enumerate(names))
    pairs = [(i, j) for j in range(len(names)) for i in range(j)]
    is_ordered = pick(draw, (True, True, False))
    return TaskNetwork(subtasks, tuple(pairs) if is_ordered else tuple(pair for pair in pairs if draw(st.booleans())))


def agents() -> st.SearchStrategy[tuple[str, float | None]]:
    """Agents of every attitude, whose alphas go with costs of any size."""
    alphas = st.integers(-15, 13).map(lambda power: math.ldexp(0.9, round(power * math.log2(10))))
    return st.one_of(st.just(("neutral", None)), st.tuples(st.sampled_from(("averse", "seeking")), alphas))
