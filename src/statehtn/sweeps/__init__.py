"""Objectives and questions that are answered by many runs of the search, each for another attitude to risk.

`solutions` and `solve` are those of `statehtn.pipeline`, and know the objectives that are swept.
"""

from __future__ import annotations

from collections.abc import Iterator

from statehtn import pipeline
from statehtn.compatible import is_swept
from statehtn.core.search import last_of
from statehtn.limits import Limits
from statehtn.result import Result
from statehtn.session import ProgressCallback, Session
from statehtn.settings import Settings


def solutions(
    session: Session,
    settings: Settings,
    limits: Limits,
    progress: ProgressCallback | None = None,
    every_plan: bool = False,
) -> Iterator[Result]:
    """Search for a plan; yield better and better ones, if `every_plan`, and last how the run ended."""
    if is_swept(settings.objective, settings.keep) and settings.search != "greedy":
        from statehtn.sweeps.evar import EvarSweep  # most runs need none

        results = EvarSweep(session, settings, limits, progress).results()
    else:
        results = pipeline.solutions(session, settings, limits, progress, every_plan)
    if every_plan:
        yield from results
    else:
        yield last_of(results)


def solve(session: Session, settings: Settings, limits: Limits, progress: ProgressCallback | None = None) -> Result:
    """Search for a plan; return how the run ended."""
    return last_of(solutions(session, settings, limits, progress))
