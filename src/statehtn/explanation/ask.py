"""Why there is no plan, or why it is not that plan."""

from __future__ import annotations

from collections.abc import Iterable

from statehtn.errors import UsageError
from statehtn.expected import items
from statehtn.explanation.explanation import NoPlan, why_no_plan
from statehtn.explanation.given_plan import WhyNot, why_not
from statehtn.limits import Limits
from statehtn.model import Plan, Problem, Step
from statehtn.model.expect import expect_problem
from statehtn.policies.settings import PolicySettings
from statehtn.risk import AttitudeName, ObjectiveLike, Success
from statehtn.settings import Settings, objective_of

NO_FAILURE_COST = "a failure cost is what a policy pays that fails, and a given plan is none; leave it out"


def why(
    problem: Problem,
    plan: Plan | Iterable[str | Step] | None = None,
    *,
    objective: ObjectiveLike | Success | None = None,
    attitude: AttitudeName | None = None,
    alpha: float | None = None,
    failure_cost: float | None = None,
    time_limit: float | None = None,
    memory_limit: float | None = None,
) -> NoPlan | WhyNot:
    """Say why a problem has no plan; or what a given plan violates, or costs more than the best.

    Args:
        problem: a problem, such as `read_hddl` returns.
        plan: a plan of it, or a list of actions such as `["(drive a b)"]`; None to ask why there is no plan.
        objective: with a plan: what plans are compared by, such as "cvar 0.95"; where actions have several outcomes:
            what policies are compared by; the expected cost if none is given.
        attitude: averse, neutral or seeking, instead of an objective.
        alpha: how much such an agent cares, per unit of cost.
        failure_cost: what failing costs a policy, as for `policy`; where actions have several outcomes.
        time_limit: seconds.
        memory_limit: resident memory of the whole process in MB (10^6 bytes).

    Returns:
        `NoPlan`, or `WhyNot` for a given plan; both print what they have to say. A limit is a status of them.

    Raises:
        UsageError: an argument is out of its range, or an objective is given where it does not matter.
        InputError: a cost is not defined, or an action of the list is none.
        UnsupportedError: a precondition falls into too many cases.
    """
    expect_problem(problem)
    limits = Limits.starting_now(time_limit, memory_limit)
    if plan is None:
        given = objective, attitude, alpha, failure_cost
        is_given = any(each is not None for each in given)
        return why_no_plan(problem, limits, PolicySettings.of(*given) if is_given else None)
    if failure_cost is not None:
        raise UsageError(NO_FAILURE_COST)
    settings = Settings.of(objective_of(objective, attitude, alpha))
    return why_not(problem, plan if isinstance(plan, Plan) else items(plan, "the actions"), settings, limits)
