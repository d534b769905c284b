"""Search for the best policy by an objective, in the compiled core."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from statehtn.core.grounding import Grounding
from statehtn.core.label_run import PRECISION
from statehtn.core.policy_bounded import bounded_disutility
from statehtn.core.policy_cut import CutPolicies
from statehtn.core.policy_disutility import DISUTILITIES, exact_grid
from statehtn.core.policy_failure import check_failure_size
from statehtn.core.policy_hopeless import hopeless
from statehtn.core.policy_outcome import PolicyOutcome
from statehtn.core.policy_prices import PricedPolicies, SuccessPolicies, most_success
from statehtn.core.policy_problem import PolicyProblem
from statehtn.core.policy_run import PolicyRun, Watch
from statehtn.core.policy_spending import SpendingPolicies
from statehtn.core.progress import SearchProgress
from statehtn.core.switches import PolicySwitches
from statehtn.errors import UnsupportedError, UsageError
from statehtn.limits import SECONDS_TO_READ, Limits, watched
from statehtn.model.policy_graph import FlatPolicy
from statehtn.model.status import Status
from statehtn.risk import CallableUtility, Exponential, Exponentials, Neutral, OneSwitch, Success
from statehtn.risk.policy_objectives import PolicyObjective, check_failure_cost, check_has_policies

HEURISTIC = "lmcut"
"""The heuristic that is taken where none is named."""


def search_policy(
    grounding: Grounding,
    objective: PolicyObjective,
    *,
    failure_cost: float | None = None,
    adaptive: bool = False,
    precision: float = PRECISION,
    heuristic: str = HEURISTIC,
    limits: Limits = Limits(),
    progress: Callable[[SearchProgress], None] | None = None,
    value_of: Callable[[FlatPolicy], float] | None = None,
    switches: PolicySwitches = PolicySwitches(),
) -> PolicyOutcome:
    """Search for the policy of least value.

    Args:
        grounding: the ground problem and its cost laws; methods are not parted (`split_methods=False`).
        objective: what is minimised; `Success` is maximised.
        failure_cost: what the agent pays if it gives up, on top of what it has spent; infinite for deadlines and
            quantiles only. None: only policies that are done with probability 1 count.
        adaptive: whether the problem may have no action with several outcomes.
        precision: how much of its value, or of 1 if that is more, a policy that is called optimal may be worse than the
            best.
        heuristic: the name of an admissible heuristic in `HEURISTICS`.
        limits: when to stop; Ctrl-C stops, too.
        progress: called about every 50 ms on the calling thread.
        value_of: what a policy is worth by the objective, worked out from its runs; one-switch agents and sums of
            exponentials need it.
        switches: refinements that may be left out.

    Raises:
        UnsupportedError: the objective or the problem has no policies; the message says why.
        UsageError: the failure cost is out of its range, or too large beside the costs.
        InputError: a cost has no finite price for this agent; the message names the action.
        LimitReached: a limit was reached before the search began.
    """
    check_that_it_has_policies(grounding, objective, failure_cost, adaptive)
    if not grounding.handle.solvable:
        return hopeless(objective, failure_cost)
    if failure_cost is not None and not isinstance(objective, Success):
        check_failure_size(grounding, objective, failure_cost)
    problem = PolicyProblem(grounding, heuristic, limits, switches)
    run = _run_of(problem, objective, failure_cost, precision, progress, limits, value_of)
    outcome = run.outcome(limits)
    if outcome.graph is not None or outcome.status is not Status.UNSOLVABLE or outcome.reason is not None:
        return outcome
    if run.is_undecided:
        reason = (
            f"whether any policy has a finite value by '{objective}' is too close to call: the spectral radius of a "
            "loop is 1 to within 1e-9. A slightly smaller alpha tells"
        )
        return replace(outcome, status=Status.GAVE_UP, reason=reason)
    return _with_reason(problem, outcome, objective, limits)


def check_that_it_has_policies(
    grounding: Grounding, objective: PolicyObjective, failure_cost: float | None, adaptive: bool
) -> None:
    """Raise an error if there is no best policy to look for.

    Raises:
        UnsupportedError: the objective or the problem has no policies; the message says why.
        UsageError: the failure cost is out of its range.
    """
    check_has_policies(objective)
    known = Success | Neutral | Exponential | OneSwitch | Exponentials | CallableUtility
    if not isinstance(objective, known) and type(objective) not in DISUTILITIES:
        raise UnsupportedError(
            f"no policy can be found by '{objective}': nothing is known of what an objective of one's own makes of "
            "several outcomes, each with decisions to come; a utility that is a Python function of the total cost has "
            "policies"
        )
    if grounding.has_scenarios:
        raise UnsupportedError(
            "costs of this problem depend on hidden facts, so that seeing a cost tells about others: there are no "
            "policies for that (it is planning under partial observation); plan without, and plan again from where the "
            "agent is"
        )
    if not grounding.handle.has_outcomes and not adaptive:
        raise UsageError("each action has one outcome, so that a plan is the best policy; --adaptive looks for one"
                         " that depends on what was spent")  # fmt: skip
    if failure_cost is not None:
        check_failure_cost(failure_cost, objective)


def _run_of(
    problem: PolicyProblem,
    objective: PolicyObjective,
    failure_cost: float | None,
    precision: float,
    progress: Watch,
    limits: Limits,
    value_of: Callable[[FlatPolicy], float] | None,
) -> PolicyRun:
    match objective:
        case Success():
            return SuccessPolicies(problem, precision, progress)
        case Neutral() | Exponential():
            return PricedPolicies(problem, objective, failure_cost, precision, progress)
    grid = exact_grid(problem, objective, failure_cost, limits)
    how = failure_cost, precision, progress, grid
    match objective:
        case OneSwitch() | Exponentials():
            assert value_of is not None
            return CutPolicies(problem, objective, *how, value_of)
        case CallableUtility():
            disutility = bounded_disutility(objective, grid, failure_cost, limits)
        case _:
            with watched(limits):
                disutility = DISUTILITIES[type(objective)](objective, grid.grid.step)
    return SpendingPolicies(problem, objective, *how, disutility)


def _with_reason(
    problem: PolicyProblem, outcome: PolicyOutcome, objective: PolicyObjective, limits: Limits
) -> PolicyOutcome:
    """Return the outcome with the reason why no policy has a finite value."""
    success = most_success(problem, limits.with_grace(SECONDS_TO_READ))
    exponential = Exponential | OneSwitch | Exponentials
    if success is not None and success > 1 - 1e-9 and isinstance(objective, exponential):
        reason = (
            f"policies are done with probability 1, but none has a finite value by '{objective}', since long loops are"
            " not unlikely enough for this agent; with a smaller alpha there is one, and with a failure cost"
            " ('statehtn policy --failure-cost F')"
        )
    else:
        reason = (
            "no policy is done with probability 1; with a failure cost ('statehtn policy --failure-cost F') the agent"
            " may give up, and by the objective 'success' the policy is found that is most likely done"
        )
    return replace(outcome, reason=reason, most_success=success)
