"""A line on stderr that says how far the search has come, where stderr is a terminal."""

from __future__ import annotations

import sys
import time
from types import TracebackType

from statehtn.cli.streams import show_progress
from statehtn.core.progress import Progress, SearchProgress, TopProgress
from statehtn.session import ProgressCallback

SECONDS_BETWEEN_LINES = 0.1


class ProgressLine:
    """One line that is written over and over, and removed in the end. `callback` is None where nobody would see it."""

    def __init__(self, *, silent: bool = False) -> None:
        self.visible = not silent and sys.stderr.isatty()
        self.callback: ProgressCallback | None = self.show if self.visible else None
        self.last = 0.0

    def __enter__(self) -> ProgressLine:
        self._write("reading and grounding ...")
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._write("")

    def show(self, progress: Progress) -> None:
        """Describe the search as it is now."""
        parts = []
        if progress.lower_bound is not None:
            parts.append(f"no plan is below {progress.lower_bound:.6g}")
        if progress.best is not None:
            parts.append(f"best plan so far {progress.best:.6g}")
        self._describe(progress, parts)

    def show_policy(self, progress: SearchProgress) -> None:
        """Describe a search for a policy as it is now."""
        bound = progress.lower_bound
        self._describe(progress, [] if bound is None else [f"no policy is below {bound:.6g}"])

    def show_top(self, progress: TopProgress) -> None:
        """Describe a search for several plans as it is now."""
        parts = [f"{progress.found:,} plan{'' if progress.found == 1 else 's'} found", f"{progress.proven:,} proven"]
        if progress.lower_bound is not None:
            parts.append(f"no other is below {progress.lower_bound:.6g}")
        self._describe(progress, parts)

    def _describe(self, progress: SearchProgress, parts: list[str]) -> None:
        now = time.monotonic()
        if now - self.last < SECONDS_BETWEEN_LINES:
            return
        self.last = now
        effort = [f"{progress.seconds:.1f} s", f"{progress.expanded:,} expanded", f"{progress.generated:,} generated"]
        self._write(", ".join(effort + parts))

    def _write(self, text: str) -> None:
        if self.visible:
            show_progress(text)
