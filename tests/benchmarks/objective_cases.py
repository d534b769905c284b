"""Problems for `tests.benchmarks.objectives`: competition problems with uncertain costs, and chains that grow."""

from __future__ import annotations

import random
from collections.abc import Iterable
from dataclasses import replace
from fractions import Fraction
from pathlib import Path

from statehtn import Problem, read_joint_samples
from statehtn.model import (
    TRUE,
    Action,
    Arithmetic,
    CostBlock,
    Domain,
    Method,
    Number,
    Signature,
    Subtask,
    TaskNetwork,
    TypeHierarchy,
)

HALF = Fraction(1, 2)
WAYS = 4  # to do a stage of a chain
STAGES = 12


def halved_or_more(problem: Problem) -> Problem:
    """The problem in which a cost c is c/2 or 3c/2, half each; where no action has a cost, c is 1."""
    actions = problem.domain.actions
    unit = CostBlock(((Number(Fraction(1)), Number(Fraction(1))),))
    has_costs = any(action.costs for action in actions.values())
    uncertain = {
        name: replace(action, costs=tuple(map(_uncertain, action.costs if has_costs else (unit,))))
        for name, action in actions.items()
    }
    return replace(problem, domain=replace(problem.domain, actions=uncertain))


def _uncertain(block: CostBlock) -> CostBlock:
    branches = tuple(
        (times(probability, HALF), times(cost, factor))
        for probability, cost in block.branches
        for factor in (HALF, 3 * HALF)
    )
    return replace(block, branches=branches)


def times(expression: object, factor: Fraction) -> object:
    return Arithmetic("*", (expression, Number(factor)))


def chain(step: Fraction = Fraction(1), stages: int = STAGES, ways: int = WAYS) -> Problem:
    """Stages one after the other, each to be done in one of several ways, which cost about 10.

    Costs are odd multiples of `step` and others, so that the grid has this step and no wider one.
    """
    drawn = random.Random(0)
    actions, methods, tasks = {}, {}, {}
    for stage in range(stages):
        tasks[f"stage{stage}"] = Signature(f"stage{stage}", ())
        for way in range(ways):
            name = f"way{stage}-{way}"
            actions[name] = Action(name, (), TRUE, (), (CostBlock(_lottery(drawn, step)),))
            methods[f"by-{name}"] = Method(f"by-{name}", (), f"stage{stage}", (), network_of([name]), TRUE)
    domain = Domain("chain", TypeHierarchy({}), {}, {}, {}, tasks, actions, methods)
    return Problem("p", domain, {}, (), network_of(list(tasks)), frozenset(), {}, TRUE)


def _lottery(drawn: random.Random, step: Fraction) -> tuple[tuple[Number, Number], ...]:
    """A usual cost, and a large one: the larger it is, the less there is of it and of the usual one."""
    late = drawn.randint(1, 6)
    usual, large = 10 - Fraction(drawn.randint(6, 10), 10) * late, 10 + Fraction(drawn.randint(6, 14), 10) * (7 - late)
    costs = (step * round(cost / step) for cost in (usual, large))
    p = Fraction(drawn.randint(3, 8), 10)
    return tuple((Number(q), Number(cost)) for q, cost in zip((p, 1 - p), costs, strict=True))


def network_of(names: Iterable[str]) -> TaskNetwork:
    subtasks = tuple(Subtask(f"s{i}", name, ()) for i, name in enumerate(names))
    return TaskNetwork(subtasks, tuple((i - 1, i) for i in range(1, len(subtasks))))


def on_days(problem: Problem, days: int, folder: Path) -> Problem:
    """The problem with costs that were observed on so many days: bad ones are bad for every second way of a stage."""
    drawn = random.Random(days)
    names = sorted(problem.domain.actions)
    file = folder / f"{days}.csv"
    lines = [",".join(names)]
    for _ in range(days):
        badness = drawn.random()
        costs = (10 + drawn.random() + (8 * badness if int(name[-1]) % 2 else 4) for name in names)
        lines.append(",".join(f"{cost:.2f}" for cost in costs))
    file.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return read_joint_samples(file).apply(problem)
