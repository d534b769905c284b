"""Run the command line as a process that ends with the one that started it, however that one ends.

Standard input must be a pipe whose other end only the parent has: it is at its end when the parent is gone.
Portable, and without a moment in which the child does not watch yet.
"""

from __future__ import annotations

import os
import runpy
import threading
from contextlib import suppress


def _end_with_parent() -> None:
    """Wait for the parent's end, then end this process at once, whatever it is doing."""
    with suppress(OSError):
        while os.read(0, 1):
            pass
    os._exit(1)


if __name__ == "__main__":
    threading.Thread(target=_end_with_parent, daemon=True).start()
    runpy.run_module("statehtn", run_name="__main__", alter_sys=True)
