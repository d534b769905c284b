"""What commands that search say where there is no plan, or no policy."""

from __future__ import annotations

from contextlib import suppress

from statehtn.cli.streams import emit, emit_lines
from statehtn.limits import LimitReached, Limits
from statehtn.model import Problem
from statehtn.risk import Neutral
from statehtn.risk.policy_objectives import PolicyObjective


def say_why(problem: Problem, limits: Limits, objective: PolicyObjective | None = None) -> None:
    """Say in three lines why there is no plan, or no policy by an objective, as far as that is found soon."""
    from statehtn.display.explanation import no_policy_line, reason_lines
    from statehtn.explanation.explanation import chance_soon, reason_soon  # only for problems without a plan

    with suppress(LimitReached, KeyboardInterrupt):
        reason = reason_soon(problem, limits)
        chance = None if objective is None or reason is not None else chance_soon(problem, objective, limits)
        emit_lines(["", *(reason_lines(reason) if chance is None else [no_policy_line(chance)])])
    also = "" if objective is None or isinstance(objective, Neutral) else " and objective"
    emit(f"'statehtn why' with the same files{also} says more")
