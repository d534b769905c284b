"""What commands that search say where there is no plan, or no policy."""

from __future__ import annotations

from contextlib import suppress
from typing import TYPE_CHECKING

from statehtn.cli.streams import emit, emit_lines
from statehtn.limits import LimitReached, Limits
from statehtn.model import Problem
from statehtn.risk import Neutral
from statehtn.session import Session

if TYPE_CHECKING:
    from statehtn.policies.settings import PolicySettings


def say_why(problem: Problem, limits: Limits, settings: PolicySettings | None = None) -> None:
    """Say in three lines why there is no plan, or no policy by some settings, as far as that is found soon."""
    from statehtn.display.explanation import reason_lines
    from statehtn.display.no_policy import no_policy_line
    from statehtn.explanation.explanation import chance_soon, reason_soon  # only for problems without a plan

    with suppress(LimitReached, KeyboardInterrupt):
        reason = reason_soon(problem, limits)
        chance = None if settings is None or reason is not None else chance_soon(Session(problem), settings, limits)
        emit_lines(["", *(reason_lines(reason) if chance is None else [no_policy_line(chance)])])
    has_options = settings is not None and not (
        isinstance(settings.objective, Neutral) and settings.failure_cost is None
    )
    emit(f"'statehtn why' with the same files{' and options' if has_options else ''} says more")
