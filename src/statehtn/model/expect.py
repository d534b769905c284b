"""Arguments that must be problems, plans or laws: what else people hand over, and what to write instead."""

from __future__ import annotations

import os

from statehtn.errors import UsageError
from statehtn.expected import expect, shown
from statehtn.model.cost.law import CostLaw, is_of_scipy
from statehtn.model.plan import Plan
from statehtn.model.problem import Problem


def expect_problem(value: object) -> Problem:
    """Return an argument that is a problem.

    Raises:
        UsageError: it is none.
    """
    if isinstance(value, Problem):
        return value
    if isinstance(value, str | os.PathLike):
        write = "read it from its files: statehtn.read_hddl(domain, problem)"
    elif callable(getattr(value, "build", None)):
        write = "a builder returns its problem by build()"
    elif type(value).__module__.startswith("unified_planning."):
        write = "statehtn.from_unified_planning(problem) returns one"
    else:
        write = "statehtn.read_hddl(domain, problem) and ProblemBuilder.build() return one"
    raise UsageError(f"the problem must be a statehtn.Problem, found {shown(value)}; {write}")


def expect_plan(value: object) -> Plan:
    """Return an argument that is a plan.

    Raises:
        UsageError: it is none.
    """
    if isinstance(value, Plan):
        return value
    if isinstance(value, str | os.PathLike):
        write = "read it from its text: statehtn.read_plan(text, problem)"
    elif isinstance(getattr(value, "plan", None), Plan):
        write = "a result has it as result.plan"
    elif value is None or hasattr(value, "plan"):
        write = "the result has no plan; its status says why"
    else:
        write = "statehtn.plan(problem).plan and statehtn.read_plan(text, problem) return one"
    raise UsageError(f"the plan must be a statehtn.Plan, found {shown(value)}; {write}")


def expect_utility(value: object) -> None:
    """Check an argument that is an agent's utility.

    Raises:
        UsageError: it is none.
    """
    if not callable(getattr(value, "risk_cost", None)) or isinstance(value, type):
        raise UsageError(
            f"the utility must be that of an agent, found {shown(value)}; write statehtn.utility_for('averse', 0.5)"
        )


def expect_law(value: object) -> CostLaw:
    """Return an argument that is the law of a cost.

    Raises:
        UsageError: it is none.
    """
    call = "from_scipy" if is_of_scipy(value) else "certain" if isinstance(value, int | float) else "of"
    law: CostLaw = expect(value, CostLaw, "expected the law of a cost", f"write CostDistribution.{call}(...)")
    return law
