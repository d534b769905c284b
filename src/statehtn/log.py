"""What the library tells about its work, under the name `statehtn` of `logging`; silent until somebody listens."""

import logging
import warnings

log = logging.getLogger("statehtn")
log.addHandler(logging.NullHandler())


def warn(warning: Warning, stacklevel: int = 1) -> None:
    """Issue a warning, as if it came from the caller so many frames up, and log it."""
    log.warning("%s", warning)
    warnings.warn(warning, stacklevel=stacklevel + 1)
