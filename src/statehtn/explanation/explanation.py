"""Why a problem has no plan."""

from __future__ import annotations

import time
from dataclasses import dataclass, replace
from typing import Any

from statehtn.errors import UsageError
from statehtn.explanation.additions import smallest_additions
from statehtn.explanation.chance import NoPolicy, reasons_of_chance, what_is_lost, why_no_policy
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
from statehtn.policies.result import PolicyResult
from statehtn.policies.settings import PolicySettings
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
        chance: why there is no policy, where actions have several outcomes; by `success`, where there always is one,
            why it is not done for certain.
        policies: what the search for a policy has found, where actions have several outcomes and there is one, or
            where it is not known whether there is.
    """

    status: Status
    reason: Reason | None = None
    additions: tuple[tuple[Addition, ...], ...] = ()
    exploration: Exploration | None = None
    plan: Plan | None = None
    chance: NoPolicy | None = None
    policies: PolicyResult | None = None

    @property
    def policy(self) -> Policy | None:
        """A policy by the objective, where there is one."""
        return None if self.policies is None else self.policies.policy

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
            "policy": None if self.policies is None else _policy_entry(self.policies),
        }

    def __str__(self) -> str:
        from statehtn.display.explanation import no_plan_text

        return no_plan_text(self)


def _policy_entry(found: PolicyResult) -> dict[str, Any] | None:
    """Return the entry `policy` of the JSON object; None where there is no policy."""
    keys = ("objective", "failure_cost", "value", "value_unit", "success_probability", "expected_cost")
    if found.policy is None:
        return None
    whole = found.to_dict()
    return {key: whole[key] for key in keys} | {"nodes": len(found.policy)}


def why_no_plan(problem: Problem, limits: Limits, settings: PolicySettings | None = None) -> NoPlan:
    """Return why a problem has no plan; or no policy, where actions have several outcomes.

    Args:
        problem: the problem.
        limits: of all that.
        settings: what policies are compared by, and what failing costs; None for the expected cost.

    Raises:
        UsageError: settings are given, and actions have one outcome each: whether there is a plan does not depend on
            them.
        UnsupportedError: a precondition falls into too many cases, or there are no policies by the objective.
        InputError: the cost of a reachable action is no distribution.
    """
    if settings is not None and not problem.domain.has_outcomes:
        raise UsageError(
            "an objective matters to a given plan alone, and a failure cost to policies; whether there is a plan does "
            "not depend on them"
        )
    try:
        reason = relaxed_reason(problem, limits)
        if reason is not None:
            return _with_additions(problem, reason, limits)
        if problem.domain.has_outcomes:
            found_out = _by_chance(problem, settings or PolicySettings.of(), limits)
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


def _by_chance(problem: Problem, settings: PolicySettings, limits: Limits) -> NoPlan | None:
    """Return why there is no policy, or that there is one; None where not even the best outcomes would help."""
    answer = why_no_policy(Session(problem), settings, limits)
    if isinstance(answer, NoPolicy):
        return None if answer.is_proven and not answer.most_success else NoPlan(Status.UNSOLVABLE, chance=answer)
    return NoPlan(Status.SOLVED if answer else answer.status, policies=answer, chance=what_is_lost(answer))


def chance_soon(session: Session, settings: PolicySettings, limits: Limits) -> NoPolicy | None:
    """Return why there is no policy, as far as that is found within a few seconds; None where it is not.

    Args:
        session: a problem that has no policy.
        settings: what there is none by.
        limits: they hold.

    Raises:
        LimitReached: a limit was reached.
    """
    answer = reasons_of_chance(session, settings, _at_most(limits, SECONDS_FOR_A_LINE))
    return answer if isinstance(answer, NoPolicy) and answer.most_success else None


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
