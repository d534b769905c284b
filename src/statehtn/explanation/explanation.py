"""Why a problem has no plan."""

from __future__ import annotations

import time
from dataclasses import dataclass, replace
from typing import Any

from statehtn.errors import UsageError
from statehtn.explanation.additions import smallest_additions
from statehtn.explanation.chance import NoPolicy, why_no_policy
from statehtn.explanation.deepest import Exploration, explore
from statehtn.explanation.reason import Addition, Reason
from statehtn.explanation.reasons import Reasoner
from statehtn.explanation.relaxation import relaxations
from statehtn.limits import ENDINGS, Limits, status_of
from statehtn.model import Problem
from statehtn.model.plan import Plan
from statehtn.model.status import Status
from statehtn.pipeline import any_plan
from statehtn.policies.policy import Policy
from statehtn.risk import Neutral
from statehtn.risk.policy_objectives import PolicyObjective
from statehtn.session import Session

SECONDS_TO_TRY = 10.0
"""For additions, and for looking at nodes: both are better for more time, and never done."""
SECONDS_FOR_A_LINE = 2.0
"""For the reason that `statehtn plan` adds to its result."""


@dataclass(frozen=True, slots=True)
class NoPlan:
    """Why a problem has no plan, or that it has one.

    Args:
        status: unsolvable; solved, if it has a plan; else what ended the search for that. Where there is a reason or an
            exploration, too: what ended the search for more.
        reason: why tasks cannot be accomplished even if nothing is ever deleted; None if they can be.
        additions: sets of facts and objects, each of which would make that possible; of none of them a member can be
            left out.
        exploration: where the search gets stuck, where only the order or what is deleted stands in the way.
        plan: a plan, where there is one.
        chance: why there is no policy, where actions have several outcomes.
        policy: a policy that is done with probability 1, and has a finite value, where there is one.
    """

    status: Status
    reason: Reason | None = None
    additions: tuple[tuple[Addition, ...], ...] = ()
    exploration: Exploration | None = None
    plan: Plan | None = None
    chance: NoPolicy | None = None
    policy: Policy | None = None

    def to_dict(self) -> dict[str, Any]:
        """Return the object that `statehtn why --json` prints."""
        explored = self.exploration
        return {
            "status": str(self.status),
            "reason": None if self.reason is None else self.reason.to_dict(),
            "additions": [[str(each) for each in additions] for additions in self.additions],
            "stuck": [] if explored is None else [deadlock.to_dict() for deadlock in explored.deadlocks],
            "nodes": None if explored is None else explored.nodes,
            "plan": None if self.plan is None else [str(step) for step in self.plan.steps],
            "chance": None if self.chance is None else self.chance.to_dict(),
            "policy": self.policy is not None,
        }

    def __str__(self) -> str:
        from statehtn.display.explanation import no_plan_text

        return no_plan_text(self)


def why_no_plan(problem: Problem, limits: Limits, objective: PolicyObjective | None = None) -> NoPlan:
    """Return why a problem has no plan; or no policy, where actions have several outcomes.

    Args:
        problem: the problem.
        limits: of all that.
        objective: what policies are compared by; None for the expected cost.

    Raises:
        UsageError: an objective is given, and actions have one outcome each: whether there is a plan does not depend on
            it.
        UnsupportedError: a precondition falls into too many cases, or there are no policies by the objective.
        InputError: the cost of a reachable action is no distribution.
    """
    if objective is not None and not problem.domain.has_outcomes:
        raise UsageError("an objective matters to a given plan alone; whether there is a plan does not depend on it")
    try:
        reason = relaxed_reason(problem, limits)
        if reason is not None:
            return _with_additions(problem, reason, limits)
        if problem.domain.has_outcomes:
            found_out = _by_chance(problem, objective or Neutral(), limits)
            if found_out is not None:
                return found_out
        else:
            result = any_plan(problem, limits)
            if result.status is not Status.UNSOLVABLE:
                return NoPlan(result.status, plan=result.plan)
        explored = explore(problem, _at_most(limits, SECONDS_TO_TRY))
        return NoPlan(explored.stopped or Status.UNSOLVABLE, exploration=explored)
    except ENDINGS as ending:
        return NoPlan(status_of(ending))


def _with_additions(problem: Problem, reason: Reason, limits: Limits) -> NoPlan:
    """Return a reason with what would help; without, where Ctrl-C comes first."""
    try:
        found = smallest_additions(problem, reason, _at_most(limits, SECONDS_TO_TRY))
    except ENDINGS as ending:
        return NoPlan(status_of(ending), reason)
    return NoPlan(Status.UNSOLVABLE, reason, tuple(found))


def _by_chance(problem: Problem, objective: PolicyObjective, limits: Limits) -> NoPlan | None:
    """Return why there is no policy, or that there is one; None where not even the best outcomes would help."""
    answer = why_no_policy(Session(problem), objective, limits)
    if isinstance(answer, NoPolicy):
        return NoPlan(Status.UNSOLVABLE, chance=answer)
    if isinstance(answer, Policy):
        return NoPlan(Status.SOLVED, policy=answer)
    return None if answer is Status.UNSOLVABLE else NoPlan(answer)


def chance_soon(problem: Problem, objective: PolicyObjective, limits: Limits) -> NoPolicy | None:
    """Return why there is no policy, as far as that is found within a few seconds; None where it is not.

    Raises:
        LimitReached: a limit was reached.
    """
    answer = why_no_policy(Session(problem), objective, _at_most(limits, SECONDS_FOR_A_LINE))
    return answer if isinstance(answer, NoPolicy) else None


def relaxed_reason(problem: Problem, limits: Limits) -> Reason | None:
    """Return why tasks cannot be accomplished even if nothing is ever deleted; None if they can be.

    Raises:
        LimitReached: a limit was reached.
        UnsupportedError: a precondition falls into too many cases.
    """
    levels = relaxations(problem, limits)
    return None if levels[-1].is_solvable else Reasoner(levels, limits).root()


def reason_soon(problem: Problem, limits: Limits) -> Reason | None:
    """Return what `relaxed_reason` does, within a few seconds.

    Raises:
        LimitReached: a limit was reached, or that was not enough.
    """
    return relaxed_reason(problem, _at_most(limits, SECONDS_FOR_A_LINE))


def _at_most(limits: Limits, seconds: float) -> Limits:
    """Return limits that leave at most so many seconds."""
    until = time.monotonic() + seconds
    return replace(limits, deadline=until if limits.deadline is None else min(until, limits.deadline))
