"""The parameters of the engine."""

from __future__ import annotations

import warnings
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any, cast

from unified_planning.exceptions import UPUsageError

from statehtn.core.searches import TAKES
from statehtn.interop.costs import CostParts
from statehtn.limits import Limits
from statehtn.risk import Attitude, AttitudeName, Keep, Objective, ObjectiveLike
from statehtn.settings import KeepLike, Settings, objective_of

NAME = "statehtn"
ADMISSIBLE = TAKES["state", "anytime"]
"""The heuristics that the engine takes: those with which it proves what it promises."""


@dataclass(frozen=True)
class Parameters:
    """For whom plans are made, and how; described at `StateHtnEngine`."""

    objective: Objective
    keep: tuple[Keep, ...]
    heuristic: str | None
    cost_distributions: Mapping[Any, CostParts] | None
    memory_limit: float | None

    @staticmethod
    def of(
        objective: ObjectiveLike | None,
        attitude: Attitude | str | None,
        alpha: float | str | None,
        keep: KeepLike | Iterable[KeepLike],
        heuristic: str | None,
        cost_distributions: Mapping[Any, CostParts] | None,
        memory_limit: float | str | None,
    ) -> Parameters:
        """Check the parameters; numbers may be written as strings, as UP's own commands do.

        Raises:
            UPUsageError: one is out of its range.
        """
        if heuristic not in (None, *ADMISSIBLE):
            raise UPUsageError(f"{NAME}: the heuristic is one of {', '.join(ADMISSIBLE)}, found '{heuristic}'")
        try:
            numbers = [None if number is None else float(number) for number in (alpha, memory_limit)]
            wanted = objective_of(objective, cast("AttitudeName | None", attitude), numbers[0])
            settings = Settings.of(wanted, heuristic=heuristic, keep=keep)
            Limits.starting_now(None, numbers[1])
        except ValueError as error:  # all errors of usage are
            raise UPUsageError(f"{NAME}: {error}") from None
        return Parameters(wanted, settings.keep, heuristic, cost_distributions, numbers[1])


def warn_of(unknown: Iterable[str], what: str) -> None:
    """Warn that arguments have no effect."""
    for name in unknown:
        warnings.warn(f"{NAME} ignores {what} '{name}'", UserWarning, stacklevel=4)
