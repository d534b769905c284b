"""Another cost for an action of a problem that is there."""

from __future__ import annotations

from statehtn.build.builder import ProblemBuilder
from statehtn.build.parts import CostPart
from statehtn.model import Problem
from statehtn.model.formula import Combinable


def with_cost(problem: Problem, action: str, *costs: CostPart, when: Combinable | str | None = None) -> Problem:
    """Return a problem in which an action has another cost; the problem that is given stays as it is.

    The four kinds of cost functions of the paper (its section on cost-variable operators) are
    - constant: a number, or a `CostDistribution`;
    - state-dependent: either of them with `when`;
    - external: a Python callable that gets the names of the action's objects and returns a number or a distribution. It
      is called once for each tuple of objects that is met; its answers are kept;
    - hybrid: a callable with `when`.

    Where a domain states no cost at all, every action costs 1; as soon as one has a cost, those without are free.

    Args:
        action: the name of an action of the problem's domain, in any case.
        costs: one or more parts, independent and added up: at least 0, in the domain's unit.
        when: a formula over the action's parameters, or its HDDL text, such as `(icy ?to)`: the costs are due where it
            holds. They replace what was due under exactly this condition; other parts stay. Without it they replace the
            whole cost of the action.

    Raises:
        UsageError: the action, a name in the condition or a cost is wrong. Wrong answers of a callable show when a plan
            is asked for: an `InputError` then names the action and its arguments.
    """
    builder = ProblemBuilder.of(problem)
    builder.set_cost(action, *costs, when=when)
    return builder.build()
