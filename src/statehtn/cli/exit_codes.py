"""Exit codes of the command line; `docs/exit-codes.md` describes them."""

from __future__ import annotations

from enum import IntEnum

from statehtn.model.status import Status


class ExitCode(IntEnum):
    """What the process tells its caller."""

    SUCCESS = 0
    INVALID_PLAN = 1
    FINDINGS = 1  # of `check`, which has no plan
    USAGE = 2
    UNSOLVABLE = 10
    GAVE_UP = 12
    TIME_LIMIT = 20
    MEMORY_LIMIT = 21
    INPUT_ERROR = 30
    UNSUPPORTED = 31
    CLUSTER_ERROR = 69
    INTERNAL_ERROR = 70
    OUTPUT_ERROR = 74
    INTERRUPTED = 130


EXIT_CODES: dict[Status, ExitCode] = {
    Status.OPTIMAL: ExitCode.SUCCESS,
    Status.SOLVED: ExitCode.SUCCESS,
    Status.UNSOLVABLE: ExitCode.UNSOLVABLE,
    Status.GAVE_UP: ExitCode.GAVE_UP,
    Status.TIME_LIMIT: ExitCode.TIME_LIMIT,
    Status.MEMORY_LIMIT: ExitCode.MEMORY_LIMIT,
    Status.INTERRUPTED: ExitCode.INTERRUPTED,
}
"""The exit code of `statehtn plan` for every status of a result."""
