"""What a plan costs in the metric of unified-planning, exactly."""

from __future__ import annotations

from fractions import Fraction

from statehtn.model import Plan, Problem
from statehtn.model.cost.expressions import evaluate


def metric_value(problem: Problem, plan: Plan) -> int | Fraction:
    """Return the sum of the costs of a plan's actions, which are certain: positive, in the metric's unit.

    Args:
        problem: a problem that was read from UP without cost distributions.
    """
    domain = problem.domain
    if domain.has_unit_costs:
        return len(plan.steps)
    total = Fraction(0)
    for step in plan.steps:
        action = domain.actions[step.action]
        bindings = dict(zip((parameter.name for parameter in action.parameters), step.arguments, strict=True))
        for block in action.costs:
            total += sum(evaluate(cost, bindings, problem.function_values) for _, cost in block.branches)
    return int(total) if total.denominator == 1 else total
