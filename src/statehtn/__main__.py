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
    there yet to be shown or kept, and an exception could get lost in the machinery of imports. Once the command line
    has come to its end, a signal changes nothing any more.
    """
    signals = [getattr(signal, name) for name in ("SIGINT", "SIGHUP", "SIGTERM") if hasattr(signal, name)]
    usual = (signal.SIG_DFL, signal.default_int_handler)  # what is ignored (`nohup`) stays so
    caught = [number for number in signals if signal.getsignal(number) in usual]
    for number in caught:
        signal.signal(number, _end)
    from statehtn.cli import main as run

    for number in caught:
        signal.signal(number, _nothing)  # until `run` has handlers of its own, and when it takes them away
    code = run(is_process=True)
    for number in caught:
        signal.signal(number, signal.SIG_IGN)  # also while the interpreter ends
    return code


def _end(*_: object) -> None:
    with suppress(OSError):  # standard error may be closed
        os.write(2, b"interrupted\n")
    os._exit(INTERRUPTED)


def _nothing(*_: object) -> None:
    pass


if __name__ == "__main__":
    sys.exit(main())
