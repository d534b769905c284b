"""The costs of actions, which UP holds in a metric, and their distributions, which it cannot hold."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from fractions import Fraction
from typing import Any

from statehtn.build import Chance, CostPart, ProblemBuilder
from statehtn.errors import UnsupportedError, UsageError
from statehtn.interop.names import Names, vocabulary_of
from statehtn.model import Action, Arithmetic, CostBlock, Expression, Number, Problem
from statehtn.model.cost.blocks import exact
from statehtn.model.cost.ground_cost import is_unconditional

CostParts = CostPart | Iterable[CostPart]
"""The cost of an action: one part, or several independent ones that add up."""

ONE = Fraction(1)


def cost_distributions(problem: Problem) -> dict[str, tuple[CostPart, ...]]:
    """Return the uncertain costs of a problem, which its unified-planning (UP) form leaves out.

    The keys are UP's names of the actions. `from_unified_planning(to_unified_planning(problem),
    cost_distributions(problem))` is `problem` again, and the engine takes them as its parameter `cost_distributions`.

    Raises:
        UnsupportedError: a cost depends on the state.
    """
    names = vocabulary_of(problem).tasks
    return {
        names.theirs(name): tuple(map(_part, action.costs))
        for name, action in problem.domain.actions.items()
        if not all(map(_is_certain, _stateless(action)))
    }


def with_distributions(problem: Problem, distributions: Mapping[Any, CostParts], names: Names) -> Problem:
    """Return the problem with other costs for some actions.

    Args:
        distributions: by UP's action or its name.
        names: those of the tasks.

    Raises:
        UsageError: an action is unknown, or a cost is none.
    """
    if not isinstance(distributions, Mapping):
        raise UsageError(f"cost_distributions is a mapping from names of actions to costs, found {distributions!r}")
    builder = ProblemBuilder.of(problem)
    for action, parts in distributions.items():
        theirs: str = action if isinstance(action, str) else getattr(action, "name", repr(action))
        name = names.ours(theirs) if names.knows(theirs) else theirs
        builder.set_cost(name, *(parts if isinstance(parts, tuple | list) else (parts,)))
    return builder.build()


def expected_cost(action: Action) -> Expression | None:
    """Return the expression of an action's expected cost; None where it states none.

    Raises:
        UnsupportedError: a cost depends on the state, or is a Python callable.
    """
    terms: list[Expression] = []
    for block in _stateless(action):
        if block.external is not None:
            raise UnsupportedError(
                f"the cost of action '{action.name}' is a Python callable, which a UP metric cannot hold; "
                f"statehtn.tabulate_costs(problem) turns it into numbers"
            )
        if block.law is not None:
            terms.append(Number(exact(block.law.mean)))
        for probability, cost in block.branches:
            match probability, cost:
                case Number(value), _ if value == ONE:
                    terms.append(cost)
                case Number(p), Number(c):
                    terms.append(Number(p * c))
                case _:
                    terms.append(Arithmetic("*", (probability, cost)))
    if not terms:
        return None
    if all(isinstance(term, Number) for term in terms):
        return Number(sum((term.value for term in terms if isinstance(term, Number)), Fraction(0)))
    return terms[0] if len(terms) == 1 else Arithmetic("+", tuple(terms))


def _stateless(action: Action) -> tuple[CostBlock, ...]:
    for block in action.costs:
        if not is_unconditional(block):
            raise UnsupportedError(
                f"the cost of action '{action.name}' depends on the state, which a metric of UP cannot express"
            )
    return action.costs


def _is_certain(block: CostBlock) -> bool:
    return (
        block.law is None
        and block.external is None
        and len(block.branches) == 1
        and block.branches[0][0] == Number(ONE)
    )


def _part(block: CostBlock) -> CostPart:
    if block.external is not None:
        return block.external
    if block.law is not None:
        return block.law
    return block.branches[0][1] if _is_certain(block) else Chance(block.branches)
