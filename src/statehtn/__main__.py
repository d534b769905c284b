"""Run the command line, with signals caught while it is loaded: `python -m statehtn`, and the script `statehtn`."""

from __future__ import annotations

import os
import signal
import sys
from contextlib import suppress

INTERRUPTED = 130
"""That of `statehtn.cli.exit_codes`, which is not loaded yet when it is needed here."""


def main() -> int:
    """Run the command line and return its exit code.

    To load it takes a good part of a second. A signal meanwhile ends the process at once, with one line: nothing is
    there yet to be shown or kept, and an exception could get lost in the machinery of imports.
    """
    signals = [getattr(signal, name) for name in ("SIGINT", "SIGHUP", "SIGTERM") if hasattr(signal, name)]
    usual = (signal.SIG_DFL, signal.default_int_handler)  # what is ignored (`nohup`) stays so
    previous = {number: signal.signal(number, _end) for number in signals if signal.getsignal(number) in usual}
    from statehtn.cli import main as run

    for number, handler in previous.items():
        signal.signal(number, handler)
    return run()


def _end(*_: object) -> None:
    with suppress(OSError):  # standard error may be closed
        os.write(2, b"interrupted\n")
    os._exit(INTERRUPTED)


if __name__ == "__main__":
    sys.exit(main())
