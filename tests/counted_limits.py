"""Limits that are reached at a certain look."""

from __future__ import annotations

from dataclasses import dataclass, field

from statehtn.limits import LimitReached, Limits
from statehtn.model.status import Status


@dataclass(frozen=True)
class CountedLimits(Limits):
    """Limits that are reached at a certain look."""

    last: int = 10**9
    looks: list[int] = field(default_factory=list)

    def check(self) -> None:
        self.looks.append(0)
        if len(self.looks) >= self.last:
            raise LimitReached(Status.TIME_LIMIT)
