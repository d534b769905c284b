"""Why not that plan: what a given plan violates, or what it costs more than the best one, and where."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from statehtn.attitudes import Difference, differences_between
from statehtn.effort import Meter
from statehtn.errors import UnsupportedError
from statehtn.found_plan import FoundPlan, priced
from statehtn.limits import ENDINGS, Limits, status_of
from statehtn.model import Fact, Plan, Problem, Step
from statehtn.model.status import Status
from statehtn.pipeline import solve
from statehtn.result import Result
from statehtn.risk import Objective, SuccessUtility
from statehtn.session import Session
from statehtn.settings import Settings
from statehtn.verify import validate_run


@dataclass(frozen=True, slots=True)
class WhyNot:
    """What is wrong with a plan, or what it costs more than the best one.

    Args:
        objective: what plans are compared by.
        reasons: what the plan violates, each in one sentence; empty for a valid plan.
        given: the plan with its value; None if it is not valid.
        best: the run that has searched for the best plan; None where there was none.
        stopped: what ended the validation of the plan before it was done.
    """

    objective: Objective
    reasons: tuple[str, ...]
    given: FoundPlan | None = None
    best: Result | None = None
    stopped: Status | None = None

    @property
    def status(self) -> Status:
        """How the run ended: optimal where the answer is complete."""
        if self.stopped is not None:
            return self.stopped
        return Status.OPTIMAL if self.best is None else self.best.status

    @property
    def more(self) -> float | None:
        """How much more the plan costs than the best one that was found, in the unit of the objective's values."""
        if self.given is None or self.best is None or self.best.value is None:
            return None
        return self.given.value - self.best.value

    @property
    def differences(self) -> tuple[Difference, ...]:
        """Where the plan parts from the best one: the plan's own actions first."""
        if self.given is None or self.best is None:
            return ()
        return differences_between(self.given.steps, self.best.steps, self.objective)

    def to_dict(self) -> dict[str, Any]:
        """Return the object that `statehtn why --plan FILE --json` prints."""
        best = self.best
        return {
            "valid": None if self.stopped is not None else not self.reasons,
            "status": str(self.status),
            "reasons": list(self.reasons),
            "objective": str(self.objective),
            "value": None if self.given is None else self.given.value,
            "best_value": None if best is None else best.value,
            "more": self.more,
            "best_plan": None if best is None or best.plan is None else [str(step) for step in best.plan.steps],
            "differences": [difference.to_dict() for difference in self.differences],
        }

    def __str__(self) -> str:
        from statehtn.display.explanation import why_not_text

        return why_not_text(self)


def why_not(problem: Problem, plan: Plan | Sequence[str | Step], settings: Settings, limits: Limits) -> WhyNot:
    """Return what is wrong with a plan, or what it costs more than the best one.

    Raises:
        InputError: a cost of the plan is not defined, or an action is none.
        UnsupportedError: actions have several outcomes, and the objective is not `success-utility`.
    """
    objective, session = settings.objective, Session(problem)
    by = objective if isinstance(objective, SuccessUtility) else None
    if problem.domain.has_outcomes and by is None:
        raise UnsupportedError(
            "a plan of actions with several outcomes counts on one of each, and is valued by 'success-utility alpha=A' "
            f"alone, not by '{objective}'; what to do whatever comes, a policy can say: 'statehtn policy'"
        )
    seen: frozenset[Fact] | None = None
    try:
        if problem.domain.has_outcomes:
            seen = session.ground(limits, Meter(), counts_on_outcomes=True).seen_facts()
        validation = validate_run(problem, plan, limits, by, seen)
    except ENDINGS as ending:
        return WhyNot(objective, (), stopped=status_of(ending))
    if not validation.valid:
        return WhyNot(objective, validation.reasons, stopped=validation.stopped)
    decomposed = validation.plan or plan
    assert isinstance(decomposed, Plan)
    return WhyNot(objective, (), priced(validation.settled(decomposed), objective), solve(session, settings, limits))
