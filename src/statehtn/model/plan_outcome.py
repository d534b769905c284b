"""What a plan counts on: the outcome of a step whose action may have several."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from typing import Any

from statehtn.model.formula import Fact


@dataclass(frozen=True, slots=True)
class PlanOutcome:
    """The outcome of a step that a plan counts on.

    Args:
        probability: of it, in the state in which the step is executed; 1 where nothing else may come.
        added: facts that are true after it.
        deleted: facts that are false after it.
    """

    probability: Fraction
    added: frozenset[Fact] = frozenset()
    deleted: frozenset[Fact] = frozenset()

    def to_dict(self) -> dict[str, Any]:
        """Return it as JSON has it."""
        added, deleted = (sorted(f"({' '.join(fact)})" for fact in facts) for facts in (self.added, self.deleted))
        return {"probability": float(self.probability), "added": added, "deleted": deleted}
