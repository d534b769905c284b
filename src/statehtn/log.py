"""What the library tells about its work, under the name `statehtn` of `logging`; silent until somebody listens."""

import logging
import sys
import warnings
from types import FrameType

log = logging.getLogger("statehtn")
log.addHandler(logging.NullHandler())


def warn_caller(warning: Warning) -> None:
    """Issue a warning, as if it came from the line that called this package, and log it."""
    frame: FrameType | None = sys._getframe()
    level = caller = 1
    while frame is not None:
        level += 1
        if _is_own(frame):  # functions of other modules may be between two of its own
            caller = level
        frame = frame.f_back
    warn(warning, caller)


def _is_own(frame: FrameType) -> bool:
    return str(frame.f_globals.get("__name__", "")).partition(".")[0] == __name__.partition(".")[0]


def warn(warning: Warning, stacklevel: int = 1) -> None:
    """Issue a warning, as if it came from the caller so many frames up, and log it."""
    log.warning("%s", warning)
    warnings.warn(warning, stacklevel=stacklevel + 1)
